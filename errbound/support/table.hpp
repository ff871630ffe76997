// Text tables with columns as wide as their longest cell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace errbound::support {

/// Rows of cells, all of one length. The first row is the heading.
using table = std::vector<std::vector<std::string>>;

/// Replaces control characters, except those in `kept`, by \xNN: file names may contain escape
/// sequences of terminals.
std::string printable(std::string_view text, std::string_view kept = {});

/// Returns one printable line per row. The first `left` columns are aligned left, the others right.
std::string text_of(const table& rows, std::size_t left);

/// Returns "1,234,567" for 1234567.
std::string grouped(std::uint64_t n);

}  // namespace errbound::support
