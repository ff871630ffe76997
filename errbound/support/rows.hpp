// Rows of named values, and their output as text, Markdown, CSV and JSON.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "errbound/support/table.hpp"

namespace errbound::support {

using row = nlohmann::ordered_json;  ///< an object: column -> value
using rows = std::vector<row>;

/// Three significant digits, or more of a whole number below 1e9: 1,234,567, 12.3, 0.012, 1.23e-20.
/// Precondition: x >= 0.
std::string digits(double x);

/// Texts as they are, whole numbers grouped, others by digits(), "yes" and "no"; a dash for null
/// and for a missing column.
table cells_of(const rows& all, const std::vector<std::string>& heading,
               const std::vector<std::string>& columns);

std::vector<std::string> columns_of(const rows& all);  ///< in order of first appearance

/// A text table of all columns, whose headings are their names with spaces for underscores. The
/// first columns are aligned left if the first row has texts there. Empty without rows.
std::string text_of(const rows& all);

/// A Markdown table; the first row is the heading, the first `left` columns are words.
std::string markdown_of(const table& cells, std::size_t left);

/// Missing values stay empty. Texts with a comma or a quotation mark are quoted.
std::string csv_of(const std::vector<std::string>& columns, const rows& all);

/// The value as JSON; a text in it need not be UTF-8. An indent of -1 writes one line.
std::string json_of(const row& value, int indent);

}  // namespace errbound::support
