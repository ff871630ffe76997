// Contacts at roots that are chosen.
#pragma once

#include <array>
#include <cstddef>

#include "ccd/stress/generators/coordinates.hpp"

namespace ccd::stress::generators {

using matrix = std::array<position, 3>;  // rows

inline matrix product(const matrix& a, const matrix& b) {
    matrix c{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            for (std::size_t k = 0; k < 3; ++k) c[i][j] += a[i][k] * b[k][j];
        }
    }
    return c;
}

struct fraction {
    int numerator = 0, denominator = 1;
};

// Contacts at roots of the coplanarity function that are chosen, multiplicities included, exactly.
//
// The columns of M(t) = U T(t) V are the query's three differences. T is upper triangular, its
// diagonal vanishes at the chosen roots r0, r1 and r2, so det M has just those. At r0 the first
// unit vector is in T's kernel, and V = n A^-1 for A with first column (x, y, n) puts (x, y, n)
// into M's: that makes x and y, over n, the weights of the contact. All numbers are small and
// whole, so nothing rounds.
inline points chosen_roots(source& random, kind which, const std::array<fraction, 3>& roots) {
    const bool face = which == kind::vertex_face;
    const int n = random.between(1, 4);
    const int i = random.between(0, n);
    const int j = random.between(0, face ? n - i : n);
    // VF: p - f0 = (i (f1 - f0) + j (f2 - f0)) / n. EE: a0 + (i/n) a = b0 + (j/n) b.
    const double x = face ? -i : i;
    const double y = -j;
    const double w = face ? n : -n;
    const matrix v{{{0, 0, 1}, {w, 0, -x}, {0, w, -y}}};
    const matrix u{{{1, static_cast<double>(random.between(-1, 1)), 0},
                    {0, 1, static_cast<double>(random.between(-1, 1))},
                    {static_cast<double>(random.between(-1, 1)), 0, 1}}};
    std::array<matrix, 2> m;
    const std::array<double, 3> above{static_cast<double>(random.between(-2, 2)),
                                      static_cast<double>(random.between(-2, 2)),
                                      static_cast<double>(random.between(-2, 2))};
    const std::array<double, 3> slope{static_cast<double>(random.between(-2, 2)),
                                      static_cast<double>(random.between(-2, 2)),
                                      static_cast<double>(random.between(-2, 2))};
    for (std::size_t end = 0; end < 2; ++end) {
        const auto t = static_cast<double>(end);
        const auto vanishing = [t](const fraction& root) {
            return root.denominator * t - root.numerator;
        };
        const matrix upper{{{vanishing(roots[0]), above[0] + t * slope[0], above[1] + t * slope[1]},
                            {0, vanishing(roots[1]), above[2] + t * slope[2]},
                            {0, 0, vanishing(roots[2])}}};
        m[end] = product(product(u, upper), v);
    }
    ends base;
    for (auto& e : base) {
        for (double& c : e) c = random.between(-2, 2);
    }
    const auto offset = [&](std::size_t column, std::size_t end, std::size_t axis) {
        return base[end][axis] + m[end][axis][column];
    };
    return fill([&](std::size_t point, std::size_t end, std::size_t axis) {
        if (face) {
            if (point == 1) return base[end][axis];
            return offset(point == 0 ? 2 : point - 2, end, axis);
        }
        if (point == 0) return base[end][axis];
        if (point == 1) return offset(0, end, axis);
        const double b0 = offset(2, end, axis);
        return point == 2 ? b0 : b0 + m[end][axis][1];
    });
}

inline std::array<fraction, 3> root_triple(source& random, int multiplicity) {
    std::array<fraction, 3> r;
    for (fraction& root : r) {
        root.denominator = random.between(1, 8);
        root.numerator = random.between(0, root.denominator);
    }
    if (multiplicity > 1) r[1] = r[0];
    if (multiplicity > 2) r[2] = r[0];
    return r;
}

}  // namespace ccd::stress::generators
