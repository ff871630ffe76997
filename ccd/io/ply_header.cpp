#include "ccd/io/ply_header.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <errbound/support/error.hpp>
#include <utility>

#include "ccd/io/text.hpp"

namespace ccd::io::ply {
namespace {

using errbound::support::file_error;

/// Elements of a header, or properties of an element, at most: names are compared pairwise.
constexpr std::size_t max_names = 1000;

std::optional<std::uint64_t> parse_count(std::string_view token) {
    std::uint64_t value = 0;
    const char* const end = token.data() + token.size();
    const auto [rest, ec] = std::from_chars(token.data(), end, value);
    if (ec != std::errc{} || rest != end) return std::nullopt;
    return value;
}

struct scalar_name {
    std::string_view name;
    scalar type;
};

constexpr std::array<scalar_name, 16> scalar_names{{{"char", scalar::int8},
                                                    {"uchar", scalar::uint8},
                                                    {"short", scalar::int16},
                                                    {"ushort", scalar::uint16},
                                                    {"int", scalar::int32},
                                                    {"uint", scalar::uint32},
                                                    {"float", scalar::float32},
                                                    {"double", scalar::float64},
                                                    {"int8", scalar::int8},
                                                    {"uint8", scalar::uint8},
                                                    {"int16", scalar::int16},
                                                    {"uint16", scalar::uint16},
                                                    {"int32", scalar::int32},
                                                    {"uint32", scalar::uint32},
                                                    {"float32", scalar::float32},
                                                    {"float64", scalar::float64}}};

class header_parser {
  public:
    header_parser(std::string_view& text, const std::string& name) : text_(text), name_(name) {}

    header parse() {
        // Where CR alone ends the first line it ends all: a LF after the last is of a binary body.
        const std::size_t first_end = text_.find_first_of("\r\n");
        if (first_end != std::string_view::npos && !text_.substr(first_end).starts_with("\r\n"))
            line_end_ = text_[first_end];
        std::string_view line = next_line();
        if (trimmed(line) != "ply") fail("found " + excerpt(line) + ", expected 'ply'");
        bool has_format = false;
        while (true) {
            const std::string_view whole = next_line();
            line = whole;
            const std::string_view keyword = take_word(line);
            if (keyword == "end_header") break;
            if (keyword == "comment" || keyword == "obj_info") continue;
            // Some readers would end a line there, or a word.
            if (std::ranges::any_of(whole, is_control))
                fail("found a control character in " + excerpt(whole) + ", expected none");
            if (keyword == "format") {
                if (has_format) fail("found a second format line, expected one");
                read_format(line, whole);
                has_format = true;
            } else if (keyword == "element") {
                read_element(line, whole);
            } else if (keyword == "property") {
                read_property(line, whole);
            } else {
                fail("found " + excerpt(whole) +
                     ", expected format, element, property, comment or end_header");
            }
        }
        if (!has_format) fail("found no format line before end_header, expected one");
        for (const element& e : header_.elements) {
            // Data without bytes would let a count alone keep the reader busy.
            if (e.properties.empty() && e.count > 0) {
                throw file_error(name_ + ": found no properties in element " + excerpt(e.name) +
                                 ", expected at least one");
            }
        }
        return std::move(header_);
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw file_error(name_ + ":" + std::to_string(header_.lines) + ": " + what);
    }

    std::string_view next_line() {
        ++header_.lines;
        if (text_.empty()) fail("found the end of the file in the header, expected end_header");
        std::string_view line = text_.substr(0, text_.find(line_end_));
        text_.remove_prefix(std::min(line.size() + 1, text_.size()));
        if (line_end_ == '\n' && line.ends_with('\r')) line.remove_suffix(1);
        return line;
    }

    void read_format(std::string_view line, std::string_view whole) {
        const std::string_view format = take_word(line), version = take_word(line);
        if (format == "ascii") {
            header_.format = encoding::ascii;
        } else if (format == "binary_little_endian") {
            header_.format = encoding::little;
        } else if (format == "binary_big_endian") {
            header_.format = encoding::big;
        } else {
            fail("found " + excerpt(whole) +
                 ", expected format ascii, binary_little_endian or binary_big_endian");
        }
        if (version != "1.0" || !trimmed(line).empty()) {
            fail("found " + excerpt(whole) + ", expected version 1.0");
        }
    }

    void read_element(std::string_view line, std::string_view whole) {
        element e;
        e.name = take_word(line);
        const std::optional<std::uint64_t> count = parse_count(take_word(line));
        if (e.name.empty() || !count || !trimmed(line).empty()) {
            fail("found " + excerpt(whole) + ", expected element NAME COUNT");
        }
        e.count = *count;
        if (header_.elements.size() == max_names)
            fail("found more than 1000 elements, expected at most that many");
        for (const element& other : header_.elements) {
            if (other.name == e.name) fail("found element " + excerpt(e.name) + " twice");
        }
        header_.elements.push_back(std::move(e));
    }

    scalar scalar_type(std::string_view word) const {
        for (const scalar_name& known : scalar_names) {
            if (known.name == word) return known.type;
        }
        fail("found type " + excerpt(word) + ", expected a PLY type such as float or uchar");
    }

    void read_property(std::string_view line, std::string_view whole) {
        if (header_.elements.empty()) fail("found a property before any element");
        property p;
        std::string_view word = take_word(line);
        if (word == "list") {
            p.count_type = scalar_type(take_word(line));
            if (!is_integer(*p.count_type)) {
                fail("found " + excerpt(whole) + ", expected an integer type for the list's count");
            }
            word = take_word(line);
        }
        p.type = scalar_type(word);
        p.name = take_word(line);
        if (p.name.empty() || !trimmed(line).empty()) {
            fail("found " + excerpt(whole) + ", expected property [list TYPE] TYPE NAME");
        }
        std::vector<property>& properties = header_.elements.back().properties;
        if (properties.size() == max_names)
            fail("found more than 1000 properties, expected at most that many");
        for (const property& other : properties) {
            if (other.name == p.name) fail("found property " + excerpt(p.name) + " twice");
        }
        properties.push_back(std::move(p));
    }

    std::string_view& text_;
    const std::string& name_;
    char line_end_ = '\n';  ///< maybe after a CR
    header header_;
};

}  // namespace

bool is_integer(scalar type) {
    return type != scalar::float32 && type != scalar::float64;
}

std::size_t bytes_of(scalar type) {
    constexpr std::array<std::size_t, 8> sizes = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

header parse_header(std::string_view& text, const std::string& name) {
    return header_parser(text, name).parse();
}

}  // namespace ccd::io::ply
