// Tables for people: columns as wide as their longest cell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace errbound::support {

/// Rows of cells, the first row the heading; all rows of one length.
using table = std::vector<std::vector<std::string>>;

/// Text that a terminal can print: each control character, except those in `kept`, as \xNN.
/// (Names of files may hold the escape sequences of terminals.)
std::string printable(std::string_view text, std::string_view kept = {});

/// The table as text, a line per row: the first `left` columns aligned left, the others right.
/// Cells are printable.
std::string text_of(const table& rows, std::size_t left);

/// 1234567 as "1,234,567".
std::string grouped(std::uint64_t n);

}  // namespace errbound::support
