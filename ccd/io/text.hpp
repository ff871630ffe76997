// Reads text files: lines and words, exact numbers, and messages with file and line.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace ccd::io {

/// `found` in quotes for a message: printable ASCII only, at most 40 characters of it.
std::string excerpt(std::string_view found);

/// Removes a UTF-8 byte order mark. Throws errbound::support::file_error if the mark is that of
/// UTF-16 or UTF-32.
std::string_view without_byte_order_mark(std::string_view text, const std::string& name);

/// Removes the end marks of DOS, Ctrl-Z, with blanks and line ends around them. Without a mark,
/// removes nothing.
std::string_view without_end_mark(std::string_view text);

/// True if c is a control character other than tab.
constexpr bool is_control(char c) {
    return (static_cast<unsigned char>(c) < ' ' && c != '\t') || c == 0x7f;
}

/// Removes blanks (space, tab) at both ends.
std::string_view trimmed(std::string_view text);

/// Takes the next line off the front, without its line end (LF, CRLF or CR). Returns nothing at the
/// end of the text.
std::optional<std::string_view> take_line(std::string_view& text);

/// Takes the next run of characters that are not blanks off the front. Returns an empty word at the
/// end.
std::string_view take_word(std::string_view& line);

/// Throws errbound::support::file_error: "NAME:LINE: what".
[[noreturn]] void fail_at(const std::string& name, std::size_t line, const std::string& what);

class line_reader {
  public:
    /// `name` is not copied. `lines` is the number of the file's lines before the text.
    line_reader(std::string_view text, const std::string& name, std::size_t lines = 0)
        : text_(text), name_(name), line_(lines) {}

    /// The next line, or nothing at the end, which counts as a line.
    std::optional<std::string_view> next() {
        ++line_;
        return take_line(text_);
    }
    std::size_t line() const { return line_; }
    std::size_t remaining() const { return text_.size(); }
    const std::string& name() const { return name_; }
    [[noreturn]] void fail(const std::string& what) const { fail_at(name_, line_, what); }

  private:
    std::string_view text_;
    const std::string& name_;
    std::size_t line_;
};

enum class number_status {
    ok,
    malformed,         ///< not a number of this form
    not_finite,        ///< an infinity or NaN, spelled out, also as 1.#INF or -nan(ind)
    overflow,          ///< beyond the largest value of the type
    inexact,           ///< no value of the type equals it
    zero_denominator,  ///< of a quotient
    too_long,          ///< more digits than longest_number
};

/// The most digits of a rational or hexadecimal number, which bounds the time to read it. No double
/// needs more than 1100 digits.
inline constexpr std::size_t longest_number = 4096;

struct number {
    double value = 0;
    number_status status = number_status::ok;
};

/// The message "NAME is FOUND; expected ..." for a status other than ok. `found` is an excerpt.
std::string describe(number_status status, const std::string& name, const std::string& found);

/// The double nearest to a decimal number, or the one equal to a hexadecimal float ("0x1.8p3"). A
/// hexadecimal float that no double equals is inexact unless `round`. Independent of the locale.
number parse_double(std::string_view token, bool round);

/// Same as parse_double(token, false) for float: the nearest float of a decimal number, or the
/// float equal to a hexadecimal one, converted to double.
number parse_float(std::string_view token);

/// The double equal to numerator/denominator, two decimal integers of any size. If no double equals
/// it: inexact, or with `round` the nearest one (ties to even).
number parse_quotient(std::string_view numerator, std::string_view denominator, bool round);

}  // namespace ccd::io
