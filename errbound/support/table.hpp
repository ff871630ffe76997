// Tables with columns as wide as their longest cell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace errbound::support {

/// The first row is the heading; all rows have equal length.
using table = std::vector<std::vector<std::string>>;

/// Replaces control characters, except those in `kept`, by \xNN. (File names may contain escape
/// sequences of terminals.)
std::string printable(std::string_view text, std::string_view kept = {});

/// A line per row: the first `left` columns aligned left, the others right. Cells are made
/// printable.
std::string text_of(const table& rows, std::size_t left);

/// 1234567 as "1,234,567".
std::string grouped(std::uint64_t n);

}  // namespace errbound::support
