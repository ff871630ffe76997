// The stored first contacts of cloth-funnel, which were computed symbolically, must be in their
// brackets.
//
// Data are in the folder ERRBOUND_SHARED_DATA of the environment, else of the build.
#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <ccd/contact.hpp>
#include <ccd/io/query_file.hpp>
#include <ccd/reference.hpp>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <variant>

namespace {

namespace fs = std::filesystem;
using rational = boost::multiprecision::cpp_rational;
using whole = boost::multiprecision::cpp_int;

fs::path data_folder() {
    if (const char* folder = std::getenv("ERRBOUND_SHARED_DATA")) return folder;
    return ERRBOUND_SHARED_DATA;
}

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
    const fs::path data = data_folder(), times_path = data / "toi" / GetParam().times;
    if (!fs::exists(times_path))
        GTEST_SKIP() << "No stored times at \"" << times_path.string()
                     << "\": set ERRBOUND_SHARED_DATA to the folder that holds them.";
    const auto times = read_times(times_path);
    const auto file = ccd::io::read_queries(
        data / "scenes" / "cloth-funnel" / "queries" / GetParam().queries, std::nullopt, false);
    std::visit(
        [&](const auto& queries) {
            for (std::size_t i = 0; i < queries.size(); ++i) {
                const ccd::first_time found = ccd::time_of_impact(queries[i]);
                EXPECT_EQ(found, ccd::time_of_impact_reference(queries[i])) << "query " << i;
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
