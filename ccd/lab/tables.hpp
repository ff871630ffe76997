// The sinks of experiments: tallies of answers, rows of values, tables.
#pragma once

#include <ccd/verdict.hpp>
#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "errbound/support/table.hpp"

namespace ccd::lab {

/// An object: column -> value. Rows become CSV (ccd/io/plots), JSON and tables.
using row = nlohmann::ordered_json;
using rows = std::vector<row>;

/// A method's answers compared with the truth. Uncertain counts as a collision.
struct tally {
    std::size_t queries = 0, colliding = 0;  ///< by the truth
    std::size_t collisions = 0, uncertain = 0, false_positives = 0, false_negatives = 0;

    void add(outcome answer, bool collides);
    tally& operator+=(const tally& more);
};

/// The smallest of the sorted numbers that are no less than a share `p` of all (nearest rank). NaN
/// if there are none.
double quantile(std::span<const double> sorted, double p);

/// Three significant digits, or more of a whole number below 1e9: 1,234,567, 12.3, 0.012, 1.23e-20.
/// Precondition: x >= 0.
std::string digits(double x);

/// The rows as cells: texts as they are, whole numbers grouped, others by digits(); a dash where a
/// row lacks the column.
errbound::support::table cells_of(const rows& all, const std::vector<std::string>& heading,
                                  const std::vector<std::string>& columns);

/// A Markdown table; the first row is the heading, the first `left` columns are words.
std::string markdown_of(const errbound::support::table& cells, std::size_t left);

/// 64-bit FNV-1a, as 16 hexadecimal digits: it detects accidental changes, not malicious ones.
std::string fingerprint_of(std::string_view bytes);

/// Makes the folder. Throws errbound::support::file_error if it cannot be written to.
void make_folder(const std::filesystem::path& folder);

/// The values as text; a path in them need not be UTF-8.
std::string text_of(const row& json, int indent);

}  // namespace ccd::lab
