// The soak of first times detects a time that is wrong by a last place or missing, a rounded
// distance, and missing nearest points.
#include "tests/soak/first_times.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

using ccd::first_time;
using ccd::outcome;
using ccd::separation;

const soak::time_decider contacts = soak::contact_deciders().front();
const soak::time_decider distances = soak::distance_deciders().front();

/// `right` after `change(query, first_time)`.
template <class Change>
soak::time_decider changed(std::string name, const soak::time_decider& right,
                           const Change& change) {
    return soak::by_time(std::move(name), [when = right.when, change]<class Query>(
                                              const Query& query, separation d, double t_max) {
        return change(query, when.template of<ccd::kind_of<Query>>()(query, d, t_max));
    });
}

first_time a_double_later(first_time t) {
    t.low = t.high;
    t.high = std::nextafter(t.high, 2);
    return t;
}

/// Expects differences when the decider is compared with the oracle, and with another decider.
void expect_found_out(soak::part (*part)(std::vector<soak::time_decider>),
                      const soak::time_decider& right, const soak::time_decider& wrong,
                      std::string_view fault) {
    const auto found = part({wrong}).compare_block(1, 0);
    EXPECT_GT(found.different, 0u);
    EXPECT_TRUE(found.have(fault)) << found.differences.at(0).text;
    EXPECT_GT(part({right, wrong}).compare_block(1, 0).different, 0u);
}

TEST(times, right_ones_do_not_differ) {
    const soak::part part = soak::contact_time_part(soak::contact_deciders());
    const soak::findings found = part.compare_block(2, 0);
    EXPECT_EQ(found.different, 0u) << found.differences.at(0).text;
    std::uint64_t queries = 0;
    for (const auto& row : found.table("kind").rows) {
        queries += row.counts.at(0);
        EXPECT_GT(row.counts.at(1), row.counts.at(2) + row.counts.at(3)) << row.name;
        EXPECT_GT(row.counts.at(2), 0u) << row.name;
        EXPECT_GT(row.counts.at(3), 0u) << row.name;
    }
    EXPECT_EQ(queries, part.count(1));
}

TEST(times, late_by_a_double) {
    const auto late = changed("late", contacts, [](const auto&, first_time t) {
        return t.outcome == outcome::collides ? a_double_later(t) : t;
    });
    expect_found_out(soak::contact_time_part, contacts, late, "it holds at low or before");
}

TEST(times, lost_where_edges_touch_at_a_double) {
    const auto lost = changed("forgetful", contacts, []<class Query>(const Query&, first_time t) {
        return t.low == t.high && ccd::kind_of<Query> == ccd::kind::edge_edge
                   ? first_time{.outcome = outcome::separate}
                   : t;
    });
    expect_found_out(soak::contact_time_part, contacts, lost, "there is one");
}

/// Contact data after `change(data)`.
template <class Change>
void expect_data_found_out(const Change& change, std::string_view fault) {
    const auto wrong = soak::by_data("wrong", [change](const auto& query, const first_time& time) {
        ccd::first_contact data = ccd::contact_at(query, time);
        change(data);
        return data;
    });
    const auto found = soak::contact_time_part({contacts, wrong}).compare_block(1, 0);
    EXPECT_TRUE(found.have(fault)) << fault;
}

TEST(times, data_that_are_off) {
    expect_data_found_out([](ccd::first_contact& c) { std::swap(c.weights[2], c.weights[3]); },
                          "off by more than its error");
    expect_data_found_out([](ccd::first_contact& c) { c.normal_velocity *= 1 + 0x1p-30; },
                          "velocity off by more than its error");
    expect_data_found_out(
        [](ccd::first_contact& c) {
            c.normal = {-c.normal.x, -c.normal.y, -c.normal.z};
            c.normal_velocity = -c.normal_velocity;
        },
        "a sided normal along which the features move apart");
    expect_data_found_out([](ccd::first_contact& c) { c.time.low = 0; }, "what is not so");
}

TEST(distances, right_ones_do_not_differ) {
    const soak::findings found =
        soak::distance_time_part(soak::distance_deciders()).compare_block(2, 0);
    EXPECT_EQ(found.different, 0u) << found.differences.at(0).text;
    for (const auto& row : found.table("distance").rows)
        EXPECT_GT(row.counts.at(0), 0u) << row.name;
}

TEST(distances, rounded_sum) {
    const auto rounded = soak::by_time("rounded", [](const auto& q, separation d, double t_max) {
        const double sum = d.first + d.second;
        return std::isfinite(sum) ? ccd::time_within(q, {sum, 0}, t_max)
                                  : ccd::time_within(q, d, t_max);
    });
    expect_found_out(soak::distance_time_part, distances, rounded, "it");
}

TEST(distances, of_one_end_instead_of_the_edge) {
    const auto of_end =
        soak::by_time("end", []<class Query>(const Query& q, separation d, double t_max) {
            if constexpr (ccd::kind_of<Query> == ccd::kind::vertex_edge)
                return ccd::time_within(ccd::vertex_vertex<double>{q.v, q.e0}, d, t_max);
            else
                return ccd::time_within(q, d, t_max);
        });
    expect_found_out(soak::distance_time_part, distances, of_end, "it");
}

}  // namespace
