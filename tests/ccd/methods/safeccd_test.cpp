// The components of SafeCCD: roots of quadratics (cubics: methods_test), and proximity of vertices
// and edges. Also its promise in single precision; property_test has the promise in double.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/gmp.hpp>
#include <ccd/methods/proximity.hpp>
#include <ccd/methods/safeccd.hpp>
#include <ccd/reference.hpp>
#include <cmath>
#include <cstdint>

#include "tests/support/query_families.hpp"

namespace {

using boost::multiprecision::mpq_rational;
using query_families::kind;
using query_families::points;
using query_families::source;

using scalar = errbound::tracked<double>;
using vector = std::array<double, 3>;

TEST(quadratic_roots, are_those_of_a_nearby_quadratic) {
    source random(1);
    for (int i = 0; i < 100000; ++i) {
        // Ordinary coefficients, nearly equal roots, and mixed sizes down to underflow.
        std::array<double, 3> c{random.symmetric(), random.symmetric(), random.symmetric()};
        if (i % 3 == 1) {
            const double r = random.symmetric();
            c = {c[2] * r * r, -2 * c[2] * r, c[2]};
        } else if (i % 3 == 2) {
            for (double& x : c) x = std::ldexp(x, random.between(-1070, 300));
        }
        const double m = std::max({std::abs(c[0]), std::abs(c[1]), std::abs(c[2])});
        if (c[1] * c[1] / m / m < 4 * (c[0] / m) * (c[2] / m) * (1 + 1e-12)) continue;  // complex
        const auto roots = errbound::roots::quadratic_roots(c[0], c[1], c[2]);
        for (const double t : {roots[0], roots[1]}) {
            if (!(std::abs(t) < 1e150)) continue;
            const mpq_rational x(t);
            const mpq_rational value =
                mpq_rational(c[0]) + mpq_rational(c[1]) * x + mpq_rational(c[2]) * x * x;
            const mpq_rational size = 1 + abs(x) + x * x;
            // The smallest change, equal for all coefficients, that makes t a root.
            EXPECT_LE(abs(value), size * m * 16 * mpq_rational(0x1p-52))
                << std::hexfloat << c[0] << ' ' << c[1] << ' ' << c[2] << " at " << t;
        }
    }
}

ccd::vector_form<scalar, 1> power_form(const vector& at0, const vector& change) {
    return {{{at0[0], change[0]}}, {{at0[1], change[1]}}, {{at0[2], change[2]}}};
}

vector random_vector(source& random, double size) {
    return {size * random.symmetric(), size * random.symmetric(), size * random.symmetric()};
}

// A vertex that is `distance` from a point of the edge at one time of the step.
struct encounter {
    vector e0, e_change, w0, w_change;

    encounter(source& random, double distance, double edge_size, double speed) {
        const double t = random.one_in(4) ? random.between(0, 1) : random.unit();
        const double s = random.one_in(4) ? random.between(0, 1) : random.unit();
        e0 = random_vector(random, edge_size), e_change = random_vector(random, edge_size);
        // Edges that shrink to a point or reverse at that time.
        if (random.one_in(8))
            for (std::size_t k = 0; k < 3; ++k) e0[k] = -t * e_change[k];
        vector offset = random_vector(random, 1);
        const double length = std::hypot(offset[0], offset[1], offset[2]);
        w_change = random_vector(random, speed);
        for (std::size_t k = 0; k < 3; ++k) {
            const double at_t = s * (e0[k] + t * e_change[k]) + distance * offset[k] / length;
            w0[k] = at_t - t * w_change[k];
        }
    }
    bool found(double reach) const {
        vector end0 = w0, end_change = w_change;
        for (std::size_t k = 0; k < 3; ++k) end0[k] -= e0[k], end_change[k] -= e_change[k];
        return ccd::safeccd::proximity(power_form(e0, e_change), power_form(w0, w_change),
                                       power_form(end0, end_change), reach, 0.0);
    }
};

TEST(proximity, is_never_overlooked) {
    source random(3);
    for (int i = 0; i < 300000; ++i) {
        const double edge_size = std::ldexp(1, -random.between(0, 30));
        const double speed = std::ldexp(1, -random.between(0, 40));
        const double distance = random.one_in(3) ? 0 : std::ldexp(1, -random.between(1, 50));
        const encounter e(random, distance, edge_size, speed);
        // The coordinates above are rounded by about 1e-16 for sizes up to 2.
        EXPECT_TRUE(e.found(distance * (1 + 1e-9) + 2e-15)) << i;
    }
}

TEST(proximity, is_denied_at_ten_times_the_reach) {
    source random(4);
    int found = 0;
    for (int i = 0; i < 10000; ++i) {
        const double reach = std::ldexp(1, -random.between(10, 20));
        // The vertex is farther than ten times the reach from a plane that contains the edge.
        encounter e(random, 0, 1, 1);
        e.e0[2] = e.e_change[2] = 0;
        e.w0[2] = 11 * reach, e.w_change[2] = 20 * reach * random.unit();
        found += e.found(reach);
    }
    EXPECT_EQ(found, 0);
}

// f = h − s·t² + c·t³ with an exact zero of f' at t = 0, where the computed f' has no sign change:
// s > 0 is lost to rounding in g·x − y. A vertex falls through a tilting triangle by less than this
// error.
TEST(safeccd, sees_a_dip_that_rounding_hides) {
    int collisions = 0;
    for (int k = 0; k <= 52; ++k) {
        for (int j = 26; j < 32; ++j) {
            const double g = 1 + std::ldexp(1, -j), a = std::ldexp(1, -k);
            const double x = g / 4, y = (1 + std::ldexp(1, 1 - j)) / 4;
            const double s = std::ldexp(1, -2 * j - 2), c = a * (x + g * y);
            const double h = std::exp2(std::floor(std::log2(4. / 27 * s * s * s / c / c)));
            const ccd::vertex_face<double> query{.v = {{0, 0, h}, {x, y, h}},
                                                 .f0 = {{0, 0, 0}, {0, 0, 0}},
                                                 .f1 = {{1, 0, 0}, {1, -a, g}},
                                                 .f2 = {{0, 1, 0}, {a, 1, -1}}};
            if (ccd::decide_reference(query).outcome != ccd::outcome::collides) continue;
            ++collisions;
            EXPECT_TRUE(may_collide(ccd::decide_safeccd<errbound::safe>(query))) << k << ' ' << j;
            EXPECT_TRUE(may_collide(ccd::decide_safeccd<errbound::tight>(query))) << k << ' ' << j;
        }
    }
    EXPECT_GT(collisions, 100);
}

// In single precision, with ε = 2^-23, on queries in single precision.
TEST(safeccd, loses_nothing_in_single_precision) {
    for (const auto& family : query_families::families) {
        int lost = 0;
        for (const kind which : ccd::stored_kinds) {
            for (std::uint64_t i = 0; i * family.thinning < 60; ++i) {
                const points p = query_families::detail::map(
                    query_families::make(family, which, 1, i), [](double x, auto...) {
                        return double{static_cast<float>(std::clamp(x, -3e38, 3e38))};
                    });
                const auto check = [&](const auto& query) {
                    const auto narrow =
                        transformed(query, [](double x) { return static_cast<float>(x); });
                    const ccd::outcome truth = ccd::decide_reference(query).outcome;
                    for (const ccd::verdict said : {ccd::decide_safeccd<errbound::safe>(narrow),
                                                    ccd::decide_safeccd<errbound::tight>(narrow)}) {
                        if (truth == ccd::outcome::uncertain)
                            EXPECT_EQ(said.outcome, truth);
                        else
                            lost +=
                                said.outcome != ccd::outcome::uncertain && said.outcome != truth;
                    }
                };
                query_families::visit_stored_query(which, p, check);
            }
        }
        EXPECT_EQ(lost, 0) << family.name;
    }
}

}  // namespace
