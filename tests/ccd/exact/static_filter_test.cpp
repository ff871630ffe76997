// The bounds of the static filters compared with rationals. No computed control value, of the whole
// step or of a subinterval, is farther from the exact one than the filter's bound.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/gmp.hpp>
#include <ccd/methods/transform.hpp>
#include <cstddef>
#include <cstdint>
#include <errbound/multiprecision.hpp>
#include <random>
#include <string>

#include "ccd/exact/static_filter/whole_step.hpp"
#include "tests/support/query_families.hpp"

namespace {

using rational = boost::multiprecision::number<boost::multiprecision::gmp_rational,
                                               boost::multiprecision::et_off>;
namespace filter = ccd::static_filter;
using query_families::families;

template <int N>
double largest_error(const errbound::roots::control_values<double, N>& computed,
                     const errbound::roots::control_values<rational, N>& exact) {
    rational largest = 0;
    for (int i = 0; i <= N; ++i) {
        const rational error = abs(rational(rational(computed[i]) - exact[i]));
        largest = std::max(largest, error);
    }
    const double rounded = largest.convert_to<double>();
    return rational(rounded) < largest ? std::nextafter(rounded, HUGE_VAL) : rounded;
}

/// The largest ratio of error to bound over all queries.
struct usage {
    double y = 0, g = 0, y_parts = 0, g_parts = 0;
};

template <template <class> class Forms, template <class> class Query>
void compare(const Query<double>& query, std::mt19937_64& random, const std::string& name,
             usage& worst) {
    const Forms<double> computed(query);
    const Forms<rational> exact(transformed(query, [](double x) { return rational(x); }));
    const filter::difference_extents<double> extents(computed);
    if (!extents.usable) return;
    filter::whole_step<double, Forms> whole(computed, extents);
    const auto use = [&](double error, double bound, double& so_far, const char* what) {
        ASSERT_LE(error, bound) << what << ", " << name;
        if (bound > 0x1p-400) so_far = std::max(so_far, error / bound);
    };
    auto y = errbound::roots::control_values_of(exact.y());
    use(largest_error(whole.forms.y, y), extents.template error_of_y<Forms>(), worst.y, "Y");
    const auto exact_inside = exact.inside();
    std::array<errbound::roots::control_values<rational, 4>,
               std::tuple_size_v<decltype(exact.inside())>>
        g;
    for (std::size_t i = 0; i < g.size(); ++i) {
        g[i] = errbound::roots::control_values_of(exact_inside[i]);
        use(largest_error(whole.forms.g[i], g[i]), extents.template error_of_g<Forms>(), worst.g,
            "G");
    }
    for (std::size_t depth = 0; depth < filter::max_depth; ++depth) {
        const bool left = random() % 2 == 0;
        const auto half = [left](auto& form) {
            auto both = errbound::roots::halves(form);
            form = left ? both.first : both.second;
        };
        half(whole.forms.y), half(y);
        use(largest_error(whole.forms.y, y), whole.errors.y, worst.y_parts, "Y of a part");
        for (std::size_t i = 0; i < g.size(); ++i) {
            half(whole.forms.g[i]), half(g[i]);
            use(largest_error(whole.forms.g[i], g[i]), whole.errors.g, worst.g_parts,
                "G of a part");
        }
    }
}

template <template <class> class Forms, class Query>
void compare_all() {
    std::mt19937_64 random(5);
    usage worst;
    for (const auto& family : families)
        for (std::uint64_t i = 0; i < 60; ++i)
            compare<Forms>(query_families::as_query<Query>(
                               query_families::make(family, ccd::kind_of<Query>, 11, i)),
                           random, std::string(family.name) + ", index " + std::to_string(i),
                           worst);
    // The bounds are sound, and not so large that they are useless.
    for (const double used : {worst.y, worst.g, worst.y_parts, worst.g_parts}) {
        EXPECT_GT(used, 0.002);
        EXPECT_LE(used, 1);
    }
    std::printf("used up at most: Y %.3f, G %.3f; of parts: Y %.3f, G %.3f\n", worst.y, worst.g,
                worst.y_parts, worst.g_parts);
}

TEST(bounds, hold_for_vertex_face) {
    compare_all<ccd::linear_vertex_face_forms, ccd::vertex_face<double>>();
}

TEST(bounds, hold_for_edge_edge) {
    compare_all<ccd::linear_edge_edge_forms, ccd::edge_edge<double>>();
}

/// Any sequence of halvings, of values that are all as large as allowed, with random signs.
TEST(bounds, hold_for_halvings) {
    std::mt19937_64 random(3);
    double worst = 0;
    for (int trial = 0; trial < 20000; ++trial) {
        errbound::roots::control_values<double, 4> c;
        errbound::roots::control_values<rational, 4> exact;
        std::uniform_real_distribution<double> size(0.5, 1);
        for (int i = 0; i <= 4; ++i) {
            c[i] = random() % 4 == 0 ? -size(random) : size(random);
            exact[i] = c[i];
        }
        const double bound =
            filter::g_constants<ccd::linear_vertex_face_forms>.halvings * filter::size_of(c);
        for (std::size_t depth = 0; depth < filter::max_depth; ++depth) {
            const bool left = random() % 2 == 0;
            const auto halves = errbound::roots::halves(c);
            const auto exact_halves = errbound::roots::halves(exact);
            c = left ? halves.first : halves.second;
            exact = left ? exact_halves.first : exact_halves.second;
            const double error = largest_error(c, exact);
            ASSERT_LE(error, bound);
            worst = std::max(worst, error / bound);
        }
    }
    EXPECT_GT(worst, 0.005);
}

}  // namespace
