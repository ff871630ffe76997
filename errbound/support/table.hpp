// Tables with columns as wide as their longest cell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace errbound::support {

using table = std::vector<std::vector<std::string>>;  ///< the first row is the heading

/// Replaces control characters, except those in `kept`, by \xNN: file names may contain escapes.
std::string printable(std::string_view text, std::string_view kept = {});

/// The first `left` columns are aligned left, the others right. Cells are made printable.
std::string text_of(const table& rows, std::size_t left);

std::string grouped(std::uint64_t n);  ///< 1234567 as "1,234,567"

/// The value in a format of printf.
std::string fixed(double value, const char* format);

}  // namespace errbound::support
