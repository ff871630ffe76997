#include <cmath>
#include <cstddef>
#include <errbound/polynomial.hpp>
#include <limits>
#include <string>
#include <vector>

#include "tests/everywhere/numbers.hpp"
#include "tests/everywhere/sections.hpp"

namespace everywhere {
namespace {

using ccd::lab::source;
using coefficients = std::vector<double>;

coefficients with_root(const coefficients& p, double root) {
    coefficients q(p.size() + 1);
    for (std::size_t i = 0; i < p.size(); ++i) {
        q[i + 1] += p[i];
        q[i] -= root * p[i];
    }
    return q;
}

/// Returns a polynomial with chosen roots, some multiple, exact or rounded, perhaps with a
/// coefficient moved to an adjacent number; or one with any coefficients.
coefficients any_polynomial(source& random) {
    const int degree = random.between(1, 9);
    coefficients p{1};
    const int way = random.between(0, 3);
    if (way == 0) {
        p.clear();
        for (int i = 0; i <= degree; ++i) p.push_back(any_number<double>(random, random.one_in(8)));
        return p;
    }
    double root = 0;
    for (int i = 0; i < degree; ++i) {
        if (i == 0 || !random.one_in(3))
            root = way == 1 ? random.between(-16, 16) / 8.0 : random.symmetric();
        p = with_root(p, root);
    }
    if (way == 3) {
        double& moved = p[static_cast<std::size_t>(random.between(0, degree))];
        moved = std::nextafter(moved, random.one_in(2) ? std::numeric_limits<double>::max()
                                                       : std::numeric_limits<double>::lowest());
    }
    return p;
}

void record_roots_on(recorder& to, const errbound::polynomial<double>& p, double a, double b) {
    to.add(errbound::count_roots(p, a, b));
    auto roots = errbound::isolate_roots(p, a, b);
    to.add(roots.everywhere());
    for (std::size_t k = 0; k < roots.size(); ++k) {
        to.add(roots[k].multiplicity);
        const auto [low, high] = roots.neighbouring_doubles(k);
        to.add(low);
        to.add(high);
    }
    const errbound::occurring_signs signs = errbound::sign_on(p, a, b);
    for (const bool s : {signs.negative, signs.zero, signs.positive}) to.add(s);
}

}  // namespace

void record_roots(recorder& to) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    source random(13);
    for (int i = 0; i < 700; ++i) {
        const errbound::polynomial p(any_polynomial(random));
        record_roots_on(to, p, 0, 1);
        record_roots_on(to, p, -infinity, infinity);
        to.end_item(std::to_string(i));
    }
}

}  // namespace everywhere
