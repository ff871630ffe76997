// What the text readers share: exact numbers from tokens, line by line reading, safe quoting.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace ccd::io {

/// `found` in quotes for a message: printable ASCII only, at most 40 characters of it.
std::string excerpt(std::string_view found);

/// The text of a file without a byte order mark of UTF-8. Throws errbound::support::file_error,
/// with `name` in its message, where the mark is that of UTF-16 or UTF-32.
std::string_view without_byte_order_mark(std::string_view text, const std::string& name);

/// `text` without the end mark of DOS, Ctrl-Z, and the blanks around it.
std::string_view without_end_mark(std::string_view text);

/// Whether it is a control character, and no tab.
constexpr bool is_control(char c) {
    return (static_cast<unsigned char>(c) < ' ' && c != '\t') || c == 0x7f;
}

/// `text` without blanks (space, tab) at either end.
std::string_view trimmed(std::string_view text);

/// Takes the next line, without its line end (LF, CRLF or CR), off the front of `text`. Nothing if
/// `text` is empty.
std::optional<std::string_view> take_line(std::string_view& text);

/// Takes the next run of characters that are not blanks off the front of `line`; empty at the end.
std::string_view take_word(std::string_view& line);

enum class number_status {
    ok,
    malformed,         ///< not a number of this form
    not_finite,        ///< an infinity or NaN, spelled out, also as 1.#INF or -nan(ind)
    overflow,          ///< beyond the largest value of the type
    inexact,           ///< no value of the type equals it
    zero_denominator,  ///< of a quotient
    too_long,          ///< more digits than longest_number
};

/// Digits beyond which a rational or hexadecimal number is refused, so that the time for a token
/// stays bounded. No double needs more than 1100 in any form.
inline constexpr std::size_t longest_number = 4096;

struct number {
    double value = 0;
    number_status status = number_status::ok;
};

/// "found T, expected E" in words, for a status other than ok. `token` is what was read.
std::string describe(number_status status, std::string_view token);

/// The double nearest to a decimal number, or the one equal to a hexadecimal float ("0x1.8p3"). A
/// hexadecimal float that no double equals is inexact unless `round`. Independent of the locale.
number parse_double(std::string_view token, bool round);

/// The same for a float, widened.
number parse_float(std::string_view token);

/// The double equal to numerator/denominator, two decimal integers of any size. If no double equals
/// it: inexact, or with `round` the nearest one (ties to even).
number parse_quotient(std::string_view numerator, std::string_view denominator, bool round);

}  // namespace ccd::io
