// First times and contacts of batches of every kind compared with single queries; the earliest of
// many.
#include <gtest/gtest.h>

#include <algorithm>
#include <ccd/contact.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "tests/ccd/batch/random_batches.hpp"
#include "tests/support/files.hpp"

namespace {

using ccd::first_time;
using ccd::outcome;
using random_batches::grid;
using random_batches::random_pairs;
using random_batches::vertices;

constexpr auto& refusal = test_files::message_of<std::invalid_argument>;

std::vector<double> thicknesses() {
    std::vector<double> all(vertices);
    for (std::size_t v = 0; v < all.size(); ++v) all[v] = 0.1 * static_cast<double>(v % 4);
    return all;
}

/// Results of single calls, without the earlier decision that batches make.
template <class Pair>
std::vector<first_time> one_by_one(const ccd::vertex_rows& rows, const std::vector<Pair>& pairs,
                                   const ccd::time_options& options) {
    std::vector<first_time> times;
    for (const Pair& p : pairs)
        times.push_back(time_within(query_of(rows, p), options.distances.of(p), options.t_max));
    return times;
}

/// The earliest by a search through all times.
ccd::earliest_time earliest_of(const std::vector<first_time>& times) {
    ccd::earliest_time found{{outcome::separate}, {}, {}};
    const auto order = [](const first_time& t) { return std::tuple(t.low, t.high); };
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (times[i].at_start()) found.at_start.push_back(i);
        if (times[i].outcome == outcome::collides && !times[i].at_start() &&
            (found.time.outcome != outcome::collides || order(times[i]) < order(found.time)))
            found.time = times[i];
    }
    for (std::size_t i = 0; i < times.size(); ++i)
        if (found.time.outcome == outcome::collides && times[i] == found.time)
            found.queries.push_back(i);
    return found;
}

/// The contacts whose time is not `separate`.
std::vector<ccd::timed_contact> contacts_of(const std::vector<first_time>& times) {
    std::vector<ccd::timed_contact> contacts;
    for (std::size_t i = 0; i < times.size(); ++i)
        if (times[i].outcome != outcome::separate) contacts.push_back({i, times[i]});
    return contacts;
}

void expect_same(const ccd::earliest_time& found, const ccd::earliest_time& expected) {
    EXPECT_EQ(found.time, expected.time);
    EXPECT_EQ(found.queries, expected.queries);
    EXPECT_EQ(found.at_start, expected.at_start);
}

template <class Pair>
class FirstTimes : public testing::Test {};
using pair_types = testing::Types<ccd::vertex_face_pair, ccd::edge_edge_pair, ccd::vertex_edge_pair,
                                  ccd::vertex_vertex_pair>;
TYPED_TEST_SUITE(FirstTimes, pair_types);

TYPED_TEST(FirstTimes, AreThoseOfOneByOne) {
    const auto before = grid(1), after = grid(2);
    const ccd::vertex_rows rows(before, after);
    const auto pairs = random_pairs<TypeParam>(130);
    std::vector<ccd::query_of_pair<TypeParam>> queries;
    for (const TypeParam& pair : pairs) queries.push_back(query_of(rows, pair));
    const std::vector<double> thickness = thicknesses();
    const ccd::time_options all_options[] = {
        {}, {.t_max = 0.25}, {.distances = {0.25}}, {.t_max = 0.5, .distances = {0, thickness}}};
    for (ccd::time_options options : all_options) {
        const auto expected = one_by_one(rows, pairs, options);
        for (options.threads = 0; options.threads < 3; ++options.threads) {
            EXPECT_EQ(ccd::first_times(rows, pairs, options), expected);
            EXPECT_EQ(ccd::timed_contacts(rows, pairs, options), contacts_of(expected));
            expect_same(ccd::earliest(rows, pairs, options), earliest_of(expected));
            if (!options.distances.thickness.empty()) continue;
            EXPECT_EQ(ccd::first_times(queries, options), expected);
            EXPECT_EQ(ccd::timed_contacts(queries, options), contacts_of(expected));
            expect_same(ccd::earliest(queries, options), earliest_of(expected));
        }
    }
}

TEST(FirstTimesOf, CoordinatesThatAreNotFiniteAreUncertain) {
    auto before = grid(7), after = grid(8);
    after[3].y = std::numeric_limits<double>::quiet_NaN();
    const ccd::vertex_rows rows(before, after);
    const std::vector<ccd::vertex_vertex_pair> pairs{{0, 1}, {2, 3}, {4, 4}, {3, 5}};
    const auto times = ccd::first_times(rows, pairs);
    EXPECT_EQ(times[1], first_time());
    EXPECT_TRUE(times[2].at_start());
    EXPECT_EQ(ccd::timed_contacts(rows, pairs, {.t_max = -1}),
              (std::vector<ccd::timed_contact>{{1, {}}, {3, {}}}));
    const auto first = ccd::earliest(rows, pairs);
    EXPECT_EQ(first.time.outcome, outcome::uncertain);
    EXPECT_EQ(first.queries, (std::vector<std::size_t>{1, 3}));
}

/// Comparisons with NaN are false, so NaN must be detected in each coordinate beforehand.
TYPED_TEST(FirstTimes, WithinADistanceOfWhatIsNotFiniteAreUncertain) {
    const auto before = grid(7), after = grid(8);
    const auto pairs = random_pairs<TypeParam>(20);
    const std::vector<double> thickness = thicknesses();
    for (std::size_t at = 0; at < 6 * before.size(); at += 7) {
        auto frames = std::array{before, after};
        ccd::point<double>& broken = frames[at % 2][at / 6];
        (at / 2 % 3 == 0   ? broken.x
         : at / 2 % 3 == 1 ? broken.y
                           : broken.z) = std::numeric_limits<double>::quiet_NaN();
        const ccd::vertex_rows rows(frames[0], frames[1]);
        for (const ccd::pair_distances& d :
             {ccd::pair_distances{0.125}, ccd::pair_distances{0, thickness}}) {
            const auto expected = one_by_one(rows, pairs, {.distances = d});
            for (const ccd::instruction_set set : ccd::instruction_sets())
                EXPECT_EQ(ccd::first_times(rows, pairs, {.distances = d, .set = set}), expected);
            // With few pairs of many vertices, batches test each pair instead of all vertices.
            EXPECT_EQ(ccd::first_times(rows, std::span(pairs).first(1), {.distances = d})[0],
                      expected[0]);
        }
    }
}

TEST(FirstTimesOf, RefuseWhatIsNoQuestion) {
    const auto before = grid(9);
    const ccd::vertex_rows rows(before, before);
    const std::vector<ccd::vertex_vertex_pair> pairs{{0, 1}}, far{{0, vertices}};
    const auto refused = [&](const ccd::time_options& options) {
        return refusal([&] { ccd::first_times(rows, pairs, options); });
    };
    EXPECT_EQ(refused({.t_max = std::numeric_limits<double>::quiet_NaN()}),
              "ccd::first_times: t_max is nan; expected a finite number");
    const std::vector<ccd::vertex_vertex<double>> stored{query_of(rows, pairs[0])};
    const auto no_set = static_cast<ccd::instruction_set>(77);
    EXPECT_NE(refusal([&] { ccd::first_times(stored, {.distances = {1}, .set = no_set}); }),
              "no error");
    EXPECT_EQ(refused({.distances = {-1}}),
              "ccd::first_times: distance is -1; expected a finite number >= 0");
    const std::vector<double> few(3), wrong(vertices, std::numeric_limits<double>::infinity());
    EXPECT_EQ(refused({.distances = {0, few}}),
              "ccd::first_times: number of thicknesses is 3; expected 60, one for each vertex");
    EXPECT_EQ(refused({.distances = {0, wrong}}),
              "ccd::first_times: thickness of vertex 0 is inf; expected a finite number >= 0");
    EXPECT_EQ(refused({.distances = {1, few}}),
              "ccd::first_times: distance and thicknesses are given; expected one of them");
    EXPECT_EQ(refusal([&] { ccd::earliest(rows, far); }),
              "ccd::first_times: vertex index of query 0 is 60; expected less than 60");
    EXPECT_EQ(refusal([&] { ccd::earliest(ccd::vertex_rows(nullptr, nullptr, 9), pairs); }),
              "ccd::first_times: pointer to positions is null; expected positions");
}

// ---- Contact data ----

TYPED_TEST(FirstTimes, HaveTheContactsOfOneByOne) {
    const auto before = grid(1), after = grid(2);
    const ccd::vertex_rows rows(before, after);
    const auto pairs = random_pairs<TypeParam>(500);
    std::vector<ccd::query_of_pair<TypeParam>> queries;
    std::vector<ccd::first_contact> expected;
    for (const TypeParam& pair : pairs) {
        queries.push_back(query_of(rows, pair));
        expected.push_back(ccd::find_first_contact(queries.back()));
    }
    const auto times = ccd::first_times(rows, pairs);
    for (const int threads : {0, 1, 2}) {
        EXPECT_EQ(ccd::first_contacts(rows, pairs, times, threads), expected);
        EXPECT_EQ(ccd::first_contacts(queries, times, threads), expected);
    }
    EXPECT_GT(contacts_of(times).size(), 5U);
    std::vector<ccd::time_derivative> derivatives;
    for (std::size_t i = 0; i < queries.size(); ++i)
        derivatives.push_back(derivative_of(queries[i], expected[i]));
    for (const int threads : {0, 1, 2}) {
        EXPECT_EQ(ccd::time_derivatives(rows, pairs, expected, threads), derivatives);
        EXPECT_EQ(ccd::time_derivatives(queries, expected, threads), derivatives);
    }
    EXPECT_EQ(std::ranges::any_of(derivatives, [](const auto& d) { return d.is_defined(); }),
              ccd::is_cubic(ccd::kind_of<TypeParam>));
}

TEST(FirstContacts, RefuseTimesOfOtherQueries) {
    const auto still = grid(1);
    const auto message = [&](const std::vector<ccd::edge_edge_pair>& pairs) {
        return refusal([&] {
            ccd::first_contacts({still, still}, pairs, std::vector<first_time>(1));
        });
    };
    EXPECT_EQ(message({{0, 1, 2, 3}, {4, 5, 6, 7}}),
              "ccd::first_contacts: number of times is 1; expected 2, one for each query");
    EXPECT_EQ(message({{0, 1, 2, 60}}),
              "ccd::first_contacts: vertex index of query 0 is 60; expected less than 60");
    EXPECT_EQ(refusal([] {
                  ccd::time_derivatives(std::vector<ccd::vertex_edge<double>>(2),
                                        std::vector<ccd::first_contact>(1));
              }),
              "ccd::time_derivatives: number of contacts is 1; expected 2, one for each query");
}

}  // namespace
