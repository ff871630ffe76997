// Options and tables shared by the benchmarks, printed as text and as JSON.
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
    bool quick = false;      ///< fewer repeats and queries: tests that everything runs
    std::string scene = {};  ///< only scenes whose name contains this
    std::vector<std::string> sections = {};  ///< names in section_names; empty: all

    int repeats() const { return quick ? 3 : 7; }
    /// The largest number of queries for one-by-one runs, which sample larger sets evenly.
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

/// A value as text and as JSON.
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
    std::string key;      ///< name in JSON
    std::string heading;  ///< heading in text
    bool left = false;    ///< left-aligned; columns of words come first
};

/// Prints tables immediately and collects them.
class report {
  public:
    /// `about` is what all rows have in common, such as "scene": "cloth-ball".
    void table(std::string_view section, const nlohmann::json& about, const std::string& title,
               const std::vector<column>& columns, const std::vector<std::vector<cell>>& rows);
    /// Prints a line that is not part of the JSON.
    static void say(const std::string& line);
    const nlohmann::json& tables() const { return tables_; }

  private:
    nlohmann::json tables_ = nlohmann::json::array();
};

}  // namespace bench
