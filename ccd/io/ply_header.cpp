
#include <algorithm>
#include <array>
#include <charconv>
#include <errbound/support/error.hpp>
#include <utility>

#include "ccd/io/ply.hpp"

namespace ccd::io::ply {
namespace {

/// Largest number of elements, and of an element's properties. Names are compared pairwise.
constexpr std::size_t max_names = 1000;

std::optional<std::uint64_t> parse_count(std::string_view token) {
    std::uint64_t value = 0;
    const char* const end = token.data() + token.size();
    const auto [rest, ec] = std::from_chars(token.data(), end, value);
    if (ec != std::errc{} || rest != end) return std::nullopt;
    return value;
}

struct named_scalar {
    std::string_view name, other_name;
    scalar type;
};

constexpr std::array named_scalars{named_scalar{"char", "int8", std::int8_t()},
                                   named_scalar{"uchar", "uint8", std::uint8_t()},
                                   named_scalar{"short", "int16", std::int16_t()},
                                   named_scalar{"ushort", "uint16", std::uint16_t()},
                                   named_scalar{"int", "int32", std::int32_t()},
                                   named_scalar{"uint", "uint32", std::uint32_t()},
                                   named_scalar{"float", "float32", float()},
                                   named_scalar{"double", "float64", double()}};

struct known_property {
    std::string_view element, name;
    ply::role role;
};

constexpr std::array known_properties{known_property{"vertex", "x", role::x},
                                      known_property{"vertex", "y", role::y},
                                      known_property{"vertex", "z", role::z},
                                      known_property{"face", "vertex_indices", role::corners},
                                      known_property{"face", "vertex_index", role::corners},
                                      known_property{"edge", "vertex1", role::vertex1},
                                      known_property{"edge", "vertex2", role::vertex2}};

role role_of(const property& p, std::string_view element) {
    const auto known = std::ranges::find(known_properties, p.name, &known_property::name);
    if (known == known_properties.end()) return role::none;
    const bool is_coordinate = known->element == "vertex";
    if (p.count_type.has_value() != (known->role == role::corners)) return role::none;
    if (!is_coordinate && !is_integer(p.type)) return role::none;
    if (known->element == element) return known->role;
    const bool is_other = element != "vertex" && element != "face" && element != "edge";
    return is_other && !is_coordinate ? role::misplaced : role::none;
}

class header_parser {
  public:
    header_parser(std::string_view& text, const std::string& name) : text_(text), name_(name) {}

    header parse() {
        // If CR alone ends the first line, it ends all: a final LF belongs to a binary body.
        const std::size_t first_end = text_.find_first_of("\r\n");
        if (first_end != std::string_view::npos && !text_.substr(first_end).starts_with("\r\n"))
            line_end_ = text_[first_end];
        line_ = rest_ = next_line();
        if (trimmed(line_) != "ply") fail_expecting("'ply'");
        bool has_format = false;
        while (true) {
            line_ = rest_ = next_line();
            const std::string_view keyword = take_word(rest_);
            if (keyword == "end_header") break;
            if (keyword == "comment" || keyword == "obj_info") continue;
            // Some readers would end a line or a word at a control character.
            if (std::ranges::any_of(line_, is_control)) fail_expecting("no control characters");
            if (keyword == "format") {
                if (has_format) fail("number of format lines is 2; expected 1");
                read_format();
                has_format = true;
            } else if (keyword == "element") {
                read_element();
            } else if (keyword == "property") {
                read_property();
            } else {
                fail_expecting("format, element, property, comment or end_header");
            }
        }
        if (!has_format) fail("number of format lines is 0; expected 1");
        for (const element& e : header_.elements)
            // Elements without data would let a mere count keep the reader busy.
            if (e.properties.empty() && e.count > 0)
                throw errbound::support::file_error(name_ + ": number of properties of element " +
                                                    excerpt(e.name) + " is 0; expected at least 1");
        return std::move(header_);
    }

  private:
    [[noreturn]] void fail(const std::string& what) const { fail_at(name_, header_.lines, what); }
    [[noreturn]] void fail_expecting(const std::string& expected) const {
        fail("line is " + excerpt(line_) + "; expected " + expected);
    }

    std::string_view next_line() {
        ++header_.lines;
        if (text_.empty()) fail("file ends in the header; expected end_header");
        std::string_view line = text_.substr(0, text_.find(line_end_));
        text_.remove_prefix(std::min(line.size() + 1, text_.size()));
        if (line_end_ == '\n' && line.ends_with('\r')) line.remove_suffix(1);
        return line;
    }

    bool at_end() const { return trimmed(rest_).empty(); }

    void read_format() {
        constexpr std::array<std::string_view, 3> formats{"ascii", "binary_little_endian",
                                                          "binary_big_endian"};
        const auto found = std::ranges::find(formats, take_word(rest_));
        if (found == formats.end())
            fail_expecting("format ascii, binary_little_endian or binary_big_endian");
        header_.format = static_cast<encoding>(found - formats.begin());
        if (take_word(rest_) != "1.0" || !at_end()) fail_expecting("version 1.0");
    }

    void read_element() {
        const std::string_view name = take_word(rest_);
        const std::optional<std::uint64_t> count = parse_count(take_word(rest_));
        if (name.empty() || !count || !at_end()) fail_expecting("element NAME COUNT");
        add(header_.elements, {std::string(name), *count, {}}, "element");
    }

    void read_property() {
        if (header_.elements.empty()) fail("property is before all elements; expected an element");
        property p;
        std::string_view word = take_word(rest_);
        if (word == "list") {
            p.count_type = scalar_type(take_word(rest_));
            if (!is_integer(*p.count_type)) fail_expecting("an integer type for the list's count");
            word = take_word(rest_);
        }
        p.type = scalar_type(word);
        p.name = take_word(rest_);
        if (p.name.empty() || !at_end()) fail_expecting("property [list TYPE] TYPE NAME");
        p.role = role_of(p, header_.elements.back().name);
        add(header_.elements.back().properties, std::move(p), "property");
    }

    scalar scalar_type(std::string_view word) const {
        for (const named_scalar& known : named_scalars)
            if (known.name == word || known.other_name == word) return known.type;
        fail("type is " + excerpt(word) + "; expected a PLY type such as float or uchar");
    }

    template <class Named>
    void add(std::vector<Named>& all, Named&& one, const std::string& what) const {
        if (all.size() == max_names)
            fail("number of lines '" + what + "' is more than 1000; expected at most 1000");
        if (std::ranges::find(all, one.name, &Named::name) != all.end())
            fail(what + " " + excerpt(one.name) + " is given twice; expected unique names");
        all.push_back(std::move(one));
    }

    std::string_view& text_;
    const std::string& name_;
    char line_end_ = '\n';          ///< maybe after a CR
    std::string_view line_, rest_;  ///< the line that is read, and the part not yet read
    header header_;
};

}  // namespace

header parse_header(std::string_view& text, const std::string& name) {
    return header_parser(text, name).parse();
}

}  // namespace ccd::io::ply
