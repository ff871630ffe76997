// The values of a PLY file's body, one after the other: binary or ascii.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <errbound/support/error.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "ccd/io/ply_header.hpp"
#include "ccd/io/text.hpp"

namespace ccd::io::ply {

/// Values from a PLY file's binary body. Every integer type fits a double exactly, so one result
/// type serves all.
class binary_values {
  public:
    binary_values(std::string_view text, const std::string& name, std::endian order)
        : text_(text), name_(name), swap_(order != std::endian::native) {}

    void begin(const std::string& element_name, std::uint64_t number) {
        element_ = &element_name;
        number_ = number;
    }

    double next(scalar type) {
        switch (type) {
            case scalar::int8:
                return take<std::int8_t>();
            case scalar::uint8:
                return take<std::uint8_t>();
            case scalar::int16:
                return take<std::int16_t>();
            case scalar::uint16:
                return take<std::uint16_t>();
            case scalar::int32:
                return take<std::int32_t>();
            case scalar::uint32:
                return take<std::uint32_t>();
            case scalar::float32:
                return static_cast<double>(take<float>());
            case scalar::float64:
                break;
        }
        return take<double>();
    }

    void skip(scalar type, std::uint64_t count) {
        if (count > text_.size() / bytes_of(type)) fail_truncated();
        text_.remove_prefix(static_cast<std::size_t>(count) * bytes_of(type));
    }

    /// Elements of so many bytes each, from the one that has begun.
    bool skip_elements(std::size_t bytes, std::uint64_t count) {
        if (bytes == 0) return true;
        if (count > text_.size() / bytes) fail_truncated();
        text_.remove_prefix(static_cast<std::size_t>(count) * bytes);
        return true;
    }

    /// The properties of an element that has begun, which `each` skips one by one.
    template <class Each>
    void skip_rest(const Each& each) {
        each();
    }

    void end() const {}

    void finish() const {
        if (text_.empty()) return;
        throw errbound::support::file_error(
            name_ + ": found " + std::to_string(text_.size()) +
            " bytes after the last element, expected the end of the file");
    }

    std::size_t remaining() const { return text_.size(); }

    /// The beginning of a message: the file and the element.
    std::string where() const { return name_ + ": " + *element_ + " " + std::to_string(number_); }
    [[noreturn]] void fail(const std::string& what) const {
        throw errbound::support::file_error(where() + ": " + what);
    }

  private:
    [[noreturn]] void fail_truncated() const {
        fail("found the end of the file, expected more data (truncated, or a wrong count)");
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
    std::uint64_t number_ = 0;
};

/// Values from a PLY file's ascii body: a line per element.
class ascii_values {
  public:
    ascii_values(std::string_view text, const std::string& name, std::size_t lines)
        : text_(text), name_(name), line_number_(lines) {}

    void begin(const std::string& element_name, std::uint64_t number) {
        do {
            const std::optional<std::string_view> line = take_line(text_);
            ++line_number_;
            if (!line) {
                fail("found the end of the file, expected " + element_name + " " +
                     std::to_string(number) + " (truncated, or a wrong count)");
            }
            line_ = *line;
        } while (trimmed(line_).empty());
    }

    double next(scalar type) {
        const std::string_view word = take_word(line_);
        if (word.empty()) fail("found too few values, expected one per property");
        number result;
        if (type == scalar::float32) {
            result = parse_float(word);
        } else {
            result = parse_double(word, false);
            if (is_integer(type) &&
                (result.status != number_status::ok || !holds(type, result.value))) {
                fail("found " + excerpt(word) + ", expected an integer of the declared type");
            }
        }
        if (result.status != number_status::ok) fail(describe(result.status, word));
        return result.value;
    }

    void skip(scalar, std::uint64_t count) {
        for (; count > 0; --count) {
            if (take_word(line_).empty()) fail("found too few values, expected one per property");
        }
    }

    /// They have no size of their own.
    bool skip_elements(std::size_t, std::uint64_t) { return false; }

    /// An element is its line.
    template <class Each>
    void skip_rest(const Each&) {}

    void end() {
        if (!trimmed(line_).empty()) {
            fail("found " + excerpt(trimmed(line_)) +
                 " after the last property, expected the end of the line");
        }
    }

    void finish() {
        while (const std::optional<std::string_view> line = take_line(text_)) {
            ++line_number_;
            if (!trimmed(*line).empty()) {
                fail("found " + excerpt(*line) +
                     " after the last element, expected the end of the file");
            }
        }
    }

    std::size_t remaining() const { return text_.size(); }

    /// The beginning of a message: the file and the line.
    std::string where() const { return name_ + ":" + std::to_string(line_number_); }
    [[noreturn]] void fail(const std::string& what) const {
        throw errbound::support::file_error(where() + ": " + what);
    }

  private:
    static bool holds(scalar type, double value) {
        const int bits = 8 * static_cast<int>(bytes_of(type));
        const bool is_signed =
            type == scalar::int8 || type == scalar::int16 || type == scalar::int32;
        const double least = is_signed ? -std::ldexp(1.0, bits - 1) : 0;
        const double beyond = std::ldexp(1.0, is_signed ? bits - 1 : bits);
        return value >= least && value < beyond && value == std::trunc(value);
    }

    std::string_view text_, line_;
    const std::string& name_;
    std::size_t line_number_;
};

}  // namespace ccd::io::ply
