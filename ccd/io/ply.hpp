#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <errbound/support/error.hpp>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "ccd/io/text.hpp"

namespace ccd::io::ply {

/// A type of property values. The variant's alternative is the type; its value has no meaning.
using scalar = std::variant<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t, std::int32_t,
                            std::uint32_t, float, double>;

inline bool is_integer(scalar type) {
    return std::visit([](auto t) { return std::is_integral_v<decltype(t)>; }, type);
}
inline std::size_t bytes_of(scalar type) {
    return std::visit([](auto t) { return sizeof t; }, type);
}

/// `misplaced`: vertex indices of an element, such as tristrips, whose faces or edges would be
/// lost.
enum class role { none, x, y, z, corners, vertex1, vertex2, misplaced };

struct property {
    std::string name;
    scalar type;
    std::optional<scalar> count_type;  ///< of a list
    ply::role role = role::none;
};

struct element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<property> properties;

    std::ptrdiff_t number_of(role r) const {
        return std::ranges::count(properties, r, &property::role);
    }
};

enum class encoding { ascii, little, big };

struct header {
    encoding format{};
    std::vector<element> elements;
    std::size_t lines = 0;
};

/// Takes the header, with end_header, off the text. Throws errbound::support::file_error.
header parse_header(std::string_view& text, const std::string& name);

/// Values from a binary body. A double holds every value of the other types exactly.
class binary_values {
  public:
    binary_values(std::string_view text, const std::string& name, std::endian order)
        : text_(text), name_(name), swap_(order != std::endian::native) {}

    /// Does not copy the name.
    void begin(const std::string& element_name, std::uint64_t index) {
        element_ = &element_name;
        index_ = index;
    }

    double next(scalar type) {
        return std::visit([this](auto t) { return static_cast<double>(take<decltype(t)>()); },
                          type);
    }

    void skip(scalar type, std::uint64_t count) { skip_elements(bytes_of(type), count); }

    /// Skips `count` elements of `bytes` bytes each.
    bool skip_elements(std::size_t bytes, std::uint64_t count) {
        if (bytes == 0) return true;
        if (count > text_.size() / bytes) fail_truncated();
        text_.remove_prefix(static_cast<std::size_t>(count) * bytes);
        return true;
    }

    /// Skips an element: each() skips all its properties.
    template <class Each>
    void skip_rest(const Each& each) {
        each();
    }

    void end() const {}

    void finish() const {
        if (text_.empty()) return;
        throw errbound::support::file_error(name_ + ": number of bytes after the last element is " +
                                            std::to_string(text_.size()) + "; expected 0");
    }

    std::size_t remaining() const { return text_.size(); }

    [[noreturn]] void fail(const std::string& what) const {
        throw errbound::support::file_error(name_ + ": " + *element_ + " " +
                                            std::to_string(index_) + ": " + what);
    }

  private:
    [[noreturn]] void fail_truncated() const {
        fail("file ends here; expected more data (truncated, or a wrong count)");
    }

    template <class T>
    T take() {
        if (text_.size() < sizeof(T)) fail_truncated();
        std::array<char, sizeof(T)> bytes;
        std::memcpy(bytes.data(), text_.data(), sizeof(T));
        text_.remove_prefix(sizeof(T));
        if (swap_) std::reverse(bytes.begin(), bytes.end());
        return std::bit_cast<T>(bytes);
    }

    std::string_view text_;
    const std::string& name_;
    bool swap_;
    const std::string* element_ = nullptr;
    std::uint64_t index_ = 0;
};

/// Values from an ascii body: a line per element. The functions are those of binary_values.
class ascii_values {
  public:
    ascii_values(std::string_view text, const std::string& name, std::size_t lines)
        : lines_(text, name, lines) {}

    void begin(const std::string& element_name, std::uint64_t index) {
        do {
            const std::optional<std::string_view> line = lines_.next();
            if (!line)
                fail("file ends here; expected " + element_name + " " + std::to_string(index) +
                     " (truncated, or a wrong count)");
            line_ = *line;
        } while (trimmed(line_).empty());
    }

    double next(scalar type) {
        const std::string_view word = next_word();
        const number result =
            std::holds_alternative<float>(type) ? parse_float(word) : parse_double(word, false);
        const bool is_number = result.status == number_status::ok;
        if (is_integer(type) && !(is_number && holds(type, result.value)))
            fail("value is " + excerpt(word) + "; expected an integer of the declared type");
        if (!is_number) fail(describe(result.status, "value", excerpt(word)));
        return result.value;
    }

    void skip(scalar, std::uint64_t count) {
        for (; count > 0; --count) next_word();
    }

    bool skip_elements(std::size_t, std::uint64_t) { return false; }

    /// Has nothing to skip, because the line holds the whole element.
    template <class Each>
    void skip_rest(const Each&) {}

    void end() {
        if (!trimmed(line_).empty())
            fail("text after the last property is " + excerpt(trimmed(line_)) +
                 "; expected the end of the line");
    }

    void finish() {
        while (const std::optional<std::string_view> line = lines_.next())
            if (!trimmed(*line).empty())
                fail("text after the last element is " + excerpt(*line) +
                     "; expected the end of the file");
    }

    std::size_t remaining() const { return lines_.remaining(); }
    [[noreturn]] void fail(const std::string& what) const { lines_.fail(what); }

  private:
    std::string_view next_word() {
        const std::string_view word = take_word(line_);
        if (word.empty()) fail("line has too few values; expected one for each property");
        return word;
    }

    static bool holds(scalar type, double value) {
        return value == std::trunc(value) &&
               std::visit(
                   [value](auto t) {
                       using limits = std::numeric_limits<decltype(t)>;
                       return value >= static_cast<double>(limits::lowest()) &&
                              value <= static_cast<double>(limits::max());
                   },
                   type);
    }

    line_reader lines_;
    std::string_view line_;
};

}  // namespace ccd::io::ply
