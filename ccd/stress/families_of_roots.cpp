// Families of queries with multiple roots.
#include <array>
#include <cmath>
#include <cstddef>

#include "ccd/stress/family_groups.hpp"
#include "ccd/stress/family_parts.hpp"
#include "ccd/stress/generators/contacts.hpp"

namespace ccd::stress {
namespace {

using namespace generators;

/// The coplanarity function is exactly r² + η (two roots, η = ±(separation/2)²) or r³ − s²·r
/// (three), for r = t − eighth/8.
///
/// The features span the directions B = (1, 0, r) and C = (0, 1, 0) or, for three, (r, 1, 0), so
/// that N = B × C is (−r, 0, 1) or (−r, r², 1); the vector P between them is (−r, 0, η) or
/// (0, r, −s²·r), and N·P is as said. At r = 0, P vanishes for η = 0: the place of the contact in
/// both features is chosen by their extent about it. Half the queries are in general position: the
/// numbers are then multiples of `unit`, and separations below 2^-24 become exactly multiple roots.
points of_roots(source& random, kind which, int roots, double separation) {
    const int eighth = random.between(1, 7);
    const bool general = random.one_in(2);
    const auto rounded = [general](double x) { return general ? unit * std::round(x / unit) : x; };
    // Contact inside, on the border, or beyond it by 2^-40.
    const auto weight = [&random] {
        const int pick = random.between(0, 5);
        return pick == 0 ? 0 : pick == 1 ? -0x1p-40 : random.between(1, 3) / 8.0;
    };
    const double x = weight(), y = weight();
    const double squared = separation * separation;
    const double eta = random.one_in(2) ? squared / 4 : -squared / 4;
    local_points p{};
    for (std::size_t end = 0; end < 2; ++end) {
        const double r = static_cast<double>(end) - eighth / 8.0;
        const double c = roots == 2 ? 0 : r;
        const position between =
            roots == 2 ? position{-r, 0, rounded(eta)} : position{0, r, rounded(-squared * r)};
        // b·B + c·C + from
        const auto at = [&](double along_b, double along_c, const position& from) {
            return position{from[0] + along_b + along_c * c, from[1] + along_c,
                            from[2] + along_b * r};
        };
        if (which == kind::vertex_face) {
            p[0][end] = between;
            p[1][end] = at(-x, -y, {});
            p[2][end] = at(1 - x, -y, {});
            p[3][end] = at(-x, 1 - y, {});
        } else {
            p[0][end] = at(-x, 0, {});
            p[1][end] = at(1 - x, 0, {});
            p[2][end] = at(0, -y, between);
            p[3][end] = at(0, 1 - y, between);
        }
    }
    return relabelled(random, which, placed(random, p, general ? 3 : 2));
}

}  // namespace

std::vector<family> families_of_roots() {
    return {
        {"double-root", "Coplanar twice, that far apart in time, or nearly so and never.",
         "log2 of the roots' separation (-inf: 0)", with_zero(range(-60, 0, 4)),
         [](source& random, kind which, double knob) {
             return of_roots(random, which, 2, power_of_two(knob));
         }},
        {"triple-root", "Coplanar three times, that far apart in time.",
         "log2 of the roots' separation (-inf: 0)", with_zero(range(-60, 0, 4)),
         [](source& random, kind which, double knob) {
             return of_roots(random, which, 3, power_of_two(knob));
         }},
    };
}

}  // namespace ccd::stress
