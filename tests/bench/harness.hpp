// Shared by the benchmarks: options, and tables for people and machines.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "ccd/lab/timing.hpp"

namespace bench {

struct options {
    bool quick = false;                      ///< fewer repeats and queries: to see that all works
    std::string scene = {};                  ///< only scenes whose name holds this
    std::vector<std::string> sections = {};  ///< of section_names; empty: all

    int repeats() const { return quick ? 3 : 7; }
    /// The number of queries one by one; they are drawn evenly from more.
    std::size_t max_queries() const { return quick ? 10'000 : 200'000; }
    bool wants(std::string_view section) const {
        return sections.empty() || std::ranges::find(sections, section) != sections.end();
    }
    bool wants_scenes() const {
        return wants("methods") || wants("stages") || wants("contacts") || wants("steps") ||
               wants("growth");
    }
};

inline constexpr std::string_view section_names[] = {"methods", "stages",     "contacts", "steps",
                                                     "growth",  "predicates", "curves"};

using ccd::lab::clock;
using ccd::lab::keep;
using ccd::lab::race;
using ccd::lab::seconds_since;
using ccd::lab::timing;

/// A value for people and the same for machines.
struct cell {
    std::string text;
    nlohmann::json value;
};
cell word(std::string_view text);
cell count(std::uint64_t n);  ///< 1234567 as 1,234,567
cell number(double x, int digits);
cell percent(double share);
cell none();  ///< a dash; null

struct column {
    std::string key;      ///< for machines
    std::string heading;  ///< for people
    bool left = false;    ///< words stand left; columns of words come first
};

/// Prints tables as they come and collects them.
class report {
  public:
    /// `about` is what the rows have in common ("scene": "cloth-ball").
    void table(std::string_view section, const nlohmann::json& about, const std::string& title,
               const std::vector<column>& columns, const std::vector<std::vector<cell>>& rows);
    /// A line of text for people alone.
    static void say(const std::string& line);
    const nlohmann::json& tables() const { return tables_; }

  private:
    nlohmann::json tables_ = nlohmann::json::array();
};

}  // namespace bench
