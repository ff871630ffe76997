// Tables for people: columns as wide as their longest cell.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace errbound::support {

/// Rows of cells, the first row the heading; all rows of one length.
using table = std::vector<std::vector<std::string>>;

/// The table as text, a line per row: the first `left` columns aligned left, the others right.
std::string text_of(const table& rows, std::size_t left);

}  // namespace errbound::support
