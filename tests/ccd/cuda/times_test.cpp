// First times on devices: compares kernel bodies, run on the host in loops, with the host's times.
#include <gtest/gtest.h>

#include <ccd/contact.hpp>
#include <cstddef>
#include <filesystem>
#include <iostream>
#include <limits>
#include <vector>

#include "ccd/cuda/time_stages.hpp"
#include "tests/ccd/cuda/on_host.hpp"
#include "tests/ccd/cuda/sets.hpp"
#include "tests/support/scaled.hpp"

namespace {

namespace fs = std::filesystem;
using ccd::first_time;
using ccd::outcome;
using ccd::cuda::detail::time_counters;
using cuda_sets::batch;

template <class Pair>
class device_times : public testing::Test {};
using kinds = testing::Types<ccd::vertex_face_pair, ccd::edge_edge_pair>;
TYPED_TEST_SUITE(device_times, kinds);

void expect_equal(const std::vector<first_time>& found, const std::vector<first_time>& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
        ASSERT_EQ(found[i], expected[i]) << i << ": " << found[i].low << ", " << found[i].high
                                         << " and " << expected[i].low << ", " << expected[i].high;
}

/// Compares all queries, with and without contact. Returns the numbers that entered each stage.
template <class Pair>
time_counters expect_times(const batch<Pair>& set, double t_max = 1) {
    time_counters counters{};
    expect_equal(
        cuda_on_host::first_times(set.positions(), set.candidates(), {t_max, false}, &counters),
        ccd::first_times(set.queries, {.t_max = t_max}));
    return counters;
}

/// Otherwise a missing stage would go unnoticed, since the next ones would decide its queries.
void expect_every_stage_to_settle_some(std::size_t queries, const time_counters& c) {
    std::cout << "roots " << queries << ", integers, 1 word " << c.one_word << ", roots, 2 words "
              << c.roots_in_two_words << ", integers, 2 words " << c.two_words << ", host "
              << c.left << '\n';
    EXPECT_LT(c.one_word + c.roots_in_two_words, queries);
    EXPECT_LT(c.two_words, c.roots_in_two_words);
    EXPECT_LT(c.left, c.one_word + c.two_words);
}

TYPED_TEST(device_times, are_those_of_the_host) {
    const auto set = cuda_sets::of_families<TypeParam>(support::scaled(200u), 41);
    expect_every_stage_to_settle_some(set.size(), expect_times(set));
}

TYPED_TEST(device_times, of_stored_queries_are_those_of_the_host) {
    if (!fs::is_directory(stored_data::folder())) GTEST_SKIP() << stored_data::missing;
    const auto set = cuda_sets::stored<TypeParam>(stored_data::folder());
    expect_every_stage_to_settle_some(set.size(), expect_times(set));
}

TYPED_TEST(device_times, are_found_up_to_t_max) {
    const auto set = cuda_sets::of_families<TypeParam>(support::scaled(50u), 42);
    for (const double t_max :
         {-1.0, 0.0, std::numeric_limits<double>::denorm_min(), 0.125, 0.5, 1 - 0x1p-53, 2.0})
        expect_times(set, t_max);
    // t_max at the ends of the brackets.
    const auto times = ccd::first_times(set.queries);
    const auto at = set.positions();
    for (std::size_t i = 0; i < set.size(); i += 7) {
        if (times[i].outcome != outcome::collides) continue;
        const auto number = static_cast<ccd::vertex_index>(i);
        const auto alone = set.candidates().listed(&number, 1);
        for (const double t_max : {times[i].low, times[i].high})
            ASSERT_EQ(cuda_on_host::first_times(at, alone, {t_max, false}).front(),
                      ccd::time_of_impact(set.queries[i], t_max));
    }
}

// Only contacts at the start and the earliest one are required.
TYPED_TEST(device_times, of_the_earliest_alone) {
    const auto set = cuda_sets::of_families<TypeParam>(support::scaled(100u), 43);
    const auto all = ccd::first_times(set.queries);
    const auto found = cuda_on_host::first_times(set.positions(), set.candidates(), {1, true});
    const ccd::cuda::detail::earlier_time earlier;
    const auto earliest = [&](const std::vector<first_time>& times) {
        first_time least{outcome::separate};
        for (std::uint32_t i = 0; i < times.size(); ++i)
            least = earlier(least, ccd::cuda::detail::time_after_start{times.data()}(i));
        return least;
    };
    const first_time first = earliest(all);
    EXPECT_EQ(first, ccd::earliest(set.queries).time);
    EXPECT_EQ(earliest(found), first);
    std::size_t without_time = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        ASSERT_TRUE(found[i] == all[i] ||
                    (found[i].outcome == outcome::separate && all[i].high > earliest(all).high));
        without_time += found[i] != all[i];
    }
    EXPECT_GT(without_time, 0u);
}

TYPED_TEST(device_times, of_coordinates_that_are_not_finite_are_uncertain) {
    auto set = cuda_sets::of_families<TypeParam>(5, 44);
    for (std::size_t i = 0; i < set.size(); i += 5) {
        const double bad = i % 2 == 0 ? std::numeric_limits<double>::quiet_NaN()
                                      : std::numeric_limits<double>::infinity();
        (i % 3 == 0 ? set.before : set.after)[4 * i + i % 4].y = bad;
    }
    const auto found = cuda_on_host::first_times(set.positions(), set.candidates());
    for (std::size_t i = 0; i < set.size(); ++i)
        ASSERT_EQ(found[i], i % 5 == 0 ? first_time{} : ccd::time_of_impact(set.queries[i])) << i;
}

// Candidates of a typical caller: those that select_colliding lists.
TYPED_TEST(device_times, of_listed_candidates_come_in_the_order_of_the_list) {
    const auto set = cuda_sets::of_families<TypeParam>(20, 45);
    std::vector<ccd::vertex_index> numbers;
    std::vector<first_time> expected;
    for (std::size_t i = set.size(); i-- > 0;) {
        const first_time time = ccd::time_of_impact(set.queries[i]);
        if (time.outcome != outcome::collides) continue;
        numbers.push_back(static_cast<ccd::vertex_index>(i));
        expected.push_back(time);
    }
    expect_equal(cuda_on_host::first_times(set.positions(),
                                           set.candidates().listed(numbers.data(), numbers.size())),
                 expected);
}

}  // namespace
