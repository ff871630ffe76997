// First times of stored queries, and of all colliding pairs of stored scenes, compared with the
// oracle and with stored times. Such data has many contacts at the start, ties, and contacts
// without crossing. One scene is in the repository.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <ccd/io/mesh_file.hpp>
#include <ccd/io/query_file.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <variant>

#include "tests/support/distance_families.hpp"
#include "tests/support/first_time_faults.hpp"
#include "tests/support/stored_data.hpp"

namespace {

namespace fs = std::filesystem;
using rational = boost::multiprecision::cpp_rational;
using stored_data::files_in;
using whole = boost::multiprecision::cpp_int;

/// Compares contact, and a random distance.
template <class Query>
void expect_right_times(const Query& query, std::size_t index) {
    EXPECT_EQ(support::fault_of(query, ccd::time_of_impact(query)), "") << "query " << index;
    ccd::lab::points at{};
    std::ranges::copy(ccd::points_of(query), at.begin());
    auto random = ccd::lab::source_of("stored", {index});
    const auto& family = distance_families::draw(random);
    const ccd::separation d = family.make(random, ccd::kind_of<Query>, at);
    EXPECT_EQ(support::fault_of(query, d, ccd::time_within(query, d)), "")
        << "query " << index << ", " << family.name;
}

TEST(stored, queries) {
    const fs::path data = stored_data::folder();
    if (!fs::is_directory(data)) GTEST_SKIP() << stored_data::missing;
    std::size_t count = 0;
    for (const fs::path& path : files_in(data, ".csv")) {
        SCOPED_TRACE(path.string());
        const auto file = ccd::io::read_queries(path, std::nullopt, false);
        std::visit(
            [&](const auto& queries) {
                for (std::size_t i = 0; i < queries.size(); ++i, ++count)
                    expect_right_times(queries[i], i);
            },
            file.queries);
    }
    std::cout << count << " queries\n";
}

void expect_right_scene(const fs::path& before, const fs::path& after) {
    SCOPED_TRACE(before.string());
    const ccd::mesh first = ccd::io::read_mesh(before), second = ccd::io::read_mesh(after);
    const ccd::step_result step = ccd::step(first, second, {.times = true});
    const ccd::vertex_rows rows{&first.vertices.data()->x, &second.vertices.data()->x,
                                first.vertices.size()};
    std::size_t count = 0, at_start = 0;
    ccd::for_each_kind([&]<ccd::kind K>() {
        const auto& pairs = step.pairs.of<K>();
        const auto& times = step.times.of<K>();
        ASSERT_EQ(times.size(), pairs.size());
        for (std::size_t i = 0; i < pairs.size(); ++i, ++count) {
            at_start += times[i].at_start();
            EXPECT_EQ(support::fault_of(query_of(rows, pairs[i]), times[i]), "")
                << path_name(K) << " pair " << i;
        }
    });
    EXPECT_GT(count, 0u);
    std::cout << count << " pairs collide, " << at_start << " at the start: " << before << "\n";
}

TEST(stored, scene_of_the_repository) {
    const fs::path scene = ERRBOUND_SCENE;
    expect_right_scene(scene / "frame0.ply", scene / "frame1.ply");
}

TEST(stored, scenes) {
    if (!stored_data::has_scenes()) GTEST_SKIP() << stored_data::missing;
    stored_data::for_each_scene(expect_right_scene);
}

// The stored first contacts of cloth-funnel, which were computed symbolically, must be in their
// brackets.

/// A line with a query's index and a decimal fraction, truncated or rounded after its last digit.
struct decimal {
    rational value, last_digit;
};
std::map<std::size_t, decimal> read_times(const fs::path& path) {
    std::ifstream file(path);
    std::map<std::size_t, decimal> times;
    for (std::string line; std::getline(file, line);) {
        const auto comma = line.find(','), dot = line.find('.');
        const std::string digits = dot == std::string::npos ? "" : line.substr(dot + 1);
        const whole unit = pow(whole(10), static_cast<unsigned>(digits.size()));
        const std::string before =
            line.substr(comma + 1, dot == std::string::npos ? dot : dot - comma - 1);
        // GMP would read a number with a leading zero as octal.
        const auto number = [](const std::string& s) {
            whole n = 0;
            for (const char c : s) n = n * 10 + (c - '0');
            return n;
        };
        times[std::stoul(line.substr(0, comma))] = {
            rational(number(before) * unit + number(digits), unit), rational(1, unit)};
    }
    return times;
}

struct stored_set {
    const char *queries, *times;
};

class stored_first_contacts : public testing::TestWithParam<stored_set> {};

TEST_P(stored_first_contacts, lie_in_their_brackets) {
    const fs::path data = stored_data::folder(), times_path = data / "toi" / GetParam().times;
    if (!fs::exists(times_path)) GTEST_SKIP() << stored_data::missing;
    const auto times = read_times(times_path);
    const auto file = ccd::io::read_queries(
        data / "scenes" / "cloth-funnel" / "queries" / GetParam().queries, std::nullopt, false);
    std::visit(
        [&](const auto& queries) {
            for (std::size_t i = 0; i < queries.size(); ++i) {
                const ccd::first_time found = ccd::time_of_impact(queries[i]);
                const auto truth = times.find(i);
                if (truth == times.end()) continue;
                const auto& [t, last_digit] = truth->second;
                ASSERT_EQ(found.outcome, ccd::outcome::collides) << "query " << i;
                EXPECT_LE(rational(found.low), t + last_digit) << "query " << i;
                EXPECT_GE(rational(found.high), t - last_digit) << "query " << i;
            }
        },
        file.queries);
    std::cout << times.size() << " stored times, " << file.size() << " queries\n";
}

INSTANTIATE_TEST_SUITE_P(cloth_funnel, stored_first_contacts,
                         testing::Values(stored_set{"227vf.csv", "cloth-funnel-227vf.txt"},
                                         stored_set{"227ee.csv", "cloth-funnel-227ee.txt"}),
                         [](const auto& set) { return std::string(set.param.queries, 5); });

}  // namespace
