// The stages of `exact` and batches with every instruction set. A certain answer is never wrong,
// and all answers agree. property_test has single queries, and the stages in integers.
#include "ccd/exact/stages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <ccd/batch.hpp>
#include <ccd/exact.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/reference.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "ccd/batch/rounded_axes.hpp"
#include "ccd/exact/integers.hpp"
#include "ccd/exact/static_filter/separating_axes.hpp"
#include "ccd/exact/static_filter/whole_step.hpp"
#include "tests/support/query_families.hpp"
#include "tests/support/scaled.hpp"

namespace {

using query_families::families;

std::uint64_t queries_per_family() {
    return support::scaled(200u);
}

template <class Query>
struct test_set {
    std::vector<Query> queries;
    std::vector<ccd::outcome> truth;
    std::vector<std::string> names;
};

template <class Query>
test_set<Query> make_set() {
    test_set<Query> set;
    for (const auto& family : families)
        // Thinned twice, since each of these queries is decided many times.
        for (std::uint64_t i = 0; i * family.thinning * family.thinning < queries_per_family();
             ++i) {
            const auto query = query_families::as_query<Query>(
                query_families::make(family, ccd::kind_of<Query>, 7, i));
            set.queries.push_back(query);
            set.truth.push_back(ccd::decide_reference(query).outcome);
            set.names.push_back(std::string(family.name) + ", index " + std::to_string(i));
        }
    return set;
}

const test_set<ccd::vertex_face<double>>& vertex_face_set() {
    static const auto set = make_set<ccd::vertex_face<double>>();
    return set;
}
const test_set<ccd::edge_edge<double>>& edge_edge_set() {
    static const auto set = make_set<ccd::edge_edge<double>>();
    return set;
}

template <class Test>
void for_both_kinds(const Test& test) {
    test(vertex_face_set());
    test(edge_edge_set());
}

/// Expects `decide` to be right if it is certain; returns the number of certain answers.
template <class Query, class Decide>
std::size_t expect_never_wrong(const test_set<Query>& set, const Decide& decide) {
    std::size_t certain = 0, wrong = 0;
    for (std::size_t i = 0; i < set.queries.size(); ++i) {
        const ccd::outcome answer = decide(set.queries[i]);
        certain += answer != ccd::outcome::uncertain;
        if (answer == ccd::outcome::uncertain || answer == set.truth[i]) continue;
        if (++wrong <= 5) ADD_FAILURE() << set.names[i];
    }
    EXPECT_EQ(wrong, 0u);
    return certain;
}

/// Expects each test of the whole step to be right if it holds, and all of floating point.
template <template <class> class Forms, class Query>
void expect_float_stages_never_wrong(const test_set<Query>& set) {
    namespace filter = ccd::static_filter;
    const auto expect = [&](const auto& separates) {
        EXPECT_GT(expect_never_wrong(set,
                                     [&](const Query& query) {
                                         const Forms<double> forms(query);
                                         const filter::difference_extents<double> extents(forms);
                                         return extents.usable && separates(forms, extents)
                                                    ? ccd::outcome::separate
                                                    : ccd::outcome::uncertain;
                                     }),
                  0u);
    };
    expect([](const auto& forms, const auto& extents) {
        return filter::separated_by_axes<double>(forms, extents);
    });
    expect([](const auto& forms, const auto& extents) {
        const auto y = errbound::roots::control_values_of(forms.y());
        const double error = extents.template error_of_y<Forms>();
        return filter::above(y, error) || filter::below(y, error);
    });
    expect([](const auto& forms, const auto& extents) {
        return filter::whole_step<double, Forms>(forms, extents).outside();
    });
    const auto by_all = [](const Query& q) {
        return ccd::detail::decide_in_floating_point(q, nullptr).outcome;
    };
    EXPECT_GT(expect_never_wrong(set, by_all), 0u);
}

TEST(stages, floating_point_is_never_wrong_where_it_is_certain) {
    expect_float_stages_never_wrong<ccd::linear_vertex_face_forms>(vertex_face_set());
    expect_float_stages_never_wrong<ccd::linear_edge_edge_forms>(edge_edge_set());
}

TEST(reports, account_for_every_query) {
    for_both_kinds([](const auto& set) {
        const auto expect_all = [&](const ccd::stage_report& report, const auto& answers) {
            std::size_t decided = 0, collides = 0;
            for (const auto& entry : report.stages) {
                decided += entry.separate + entry.collides;
                collides += entry.collides;
                EXPECT_TRUE(entry.seconds > 0 || entry.entered == 0);
            }
            EXPECT_EQ(decided, set.queries.size());
            EXPECT_EQ(collides, std::ranges::count(answers, ccd::outcome::collides));
        };
        ccd::stage_report report;
        std::vector<ccd::outcome> answers;
        for (const auto& q : set.queries) answers.push_back(decide_exact(q, &report).outcome);
        expect_all(report, answers);
        for (const ccd::instruction_set isa : ccd::instruction_sets()) {
            const auto batch = ccd::decide_batch(set.queries, {.set = isa, .explain = true});
            expect_all(batch.stages, batch.answers);
        }
        for (const auto& entry : ccd::decide_batch(set.queries).stages.stages)
            EXPECT_EQ(entry.entered, 0) << "no report is wanted";
    });
}

/// Exploded steps have many such queries.
TEST(stages, features_that_a_coordinate_separates_need_no_unbounded_integers_at_any_scale) {
    const auto at_rest = [](double x, double y, double z) {
        return ccd::moving_point<double>{{x, y, z}, {x, y, z}};
    };
    ccd::vertex_face<double> query{at_rest(1e300, 1e-300, 3), at_rest(-1e300, 1, 2),
                                   at_rest(1e-300, 1e200, 2), at_rest(-1, -1e250, 2)};
    const auto entered_last = [&query] {
        ccd::stage_report report;
        const ccd::verdict answer = ccd::detail::decide_with_integers(query, &report);
        EXPECT_EQ(answer.outcome, ccd::outcome::separate);
        return report[ccd::stage::unbounded].entered;
    };
    EXPECT_EQ(entered_last(), 0);
    query.v.t1.x = -1e300;
    query.v.t1.z = 1;  // the vertex passes the face's plane, far from the face
    EXPECT_EQ(entered_last(), 1);
}

TEST(batch, every_length_up_to_several_packs) {
    const auto& set = edge_edge_set();
    for (const ccd::instruction_set isa : ccd::instruction_sets())
        for (std::size_t size = 0; size < 150; ++size) {
            const std::size_t first = 37 * size % (set.queries.size() - 150);
            std::vector<ccd::outcome> answers(size);
            ccd::decide_batch(std::span(set.queries).subspan(first, size), std::span(answers),
                              {.set = isa});
            for (std::size_t i = 0; i < size; ++i)
                ASSERT_EQ(answers[i], set.truth[first + i]) << set.names[first + i];
        }
}

// If a scene's extent is one or two ulps of its position, the rounded middle is one of its ends.
TEST(rounded_axes, a_scene_becomes_the_unit_box_however_small_it_is) {
    for (const int ulps : {0, 1, 2, 3, 5, 1000}) {
        const double low = 3.0, high = low + ulps * 0x1p-51;
        const ccd::detail::rounded_axes::frame frame({{low, low, low}, {high, low, high}});
        for (const double x : {low, high})
            EXPECT_LE(std::abs(frame(0, x)), 1.001f) << ulps << " ulps";
        EXPECT_EQ(frame(1, low), 0.0f);
    }
}

TEST(static_filter, constants_are_those_of_the_forms) {
    // A bound for Y by hand: each of its terms is a product of three differences, and so on.
    // Detects a change of the forms that makes the errors larger.
    using namespace ccd::static_filter;
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    EXPECT_LT(y_constants<ccd::linear_vertex_face_forms>.relative, 400 * epsilon);
    EXPECT_LT(g_constants<ccd::linear_vertex_face_forms>.relative, 10000 * epsilon);
    EXPECT_GT(y_constants<ccd::linear_vertex_face_forms>.relative, 3 * 36 * epsilon);
    EXPECT_LT(y_constants<ccd::linear_vertex_face_forms>.absolute, 1e-190);
    EXPECT_LT(g_constants<ccd::linear_edge_edge_forms>.absolute, 1e-130);
}

}  // namespace
