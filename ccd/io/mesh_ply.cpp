// The PLY reader. Our own, because the PLY libraries that distributions carry convert coordinates
// to float.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <errbound/support/error.hpp>
#include <limits>
#include <optional>
#include <utility>

#include "ccd/io/face_check.hpp"
#include "ccd/io/mesh_file.hpp"
#include "ccd/io/text.hpp"

namespace ccd::io {
namespace {

using errbound::support::file_error;

std::optional<std::uint64_t> parse_count(std::string_view token) {
    std::uint64_t value = 0;
    const char* const end = token.data() + token.size();
    const auto [rest, ec] = std::from_chars(token.data(), end, value);
    if (ec != std::errc{} || rest != end) return std::nullopt;
    return value;
}

enum class scalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct scalar_name {
    std::string_view name;
    scalar type;
};

/// Elements of a header, or properties of an element, at most: names are compared pairwise.
constexpr std::size_t max_names = 1000;

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

bool is_integer(scalar type) {
    return type != scalar::float32 && type != scalar::float64;
}

std::size_t bytes_of(scalar type) {
    constexpr std::array<std::size_t, 8> sizes = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

struct property {
    std::string name;
    scalar type{};
    std::optional<scalar> count_type;  ///< of a list
};

struct element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<property> properties;
};

enum class encoding { ascii, little, big };

struct ply_header {
    encoding format{};
    std::vector<element> elements;
    std::size_t lines = 0;
};

class ply_header_parser {
  public:
    ply_header_parser(std::string_view& text, const std::string& name) : text_(text), name_(name) {}

    ply_header parse() {
        std::string_view line = next_line();
        if (trimmed(line) != "ply") fail("found " + excerpt(line) + ", expected 'ply'");
        bool has_format = false;
        while (true) {
            const std::string_view whole = next_line();
            line = whole;
            const std::string_view keyword = take_word(line);
            if (keyword == "end_header") break;
            if (keyword == "comment" || keyword == "obj_info") continue;
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
        const std::optional<std::string_view> line = take_line(text_);
        ++header_.lines;
        if (!line) fail("found the end of the file in the header, expected end_header");
        return *line;
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
    ply_header header_;
};

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

    void end() const {}

    void finish() const {
        if (text_.empty()) return;
        throw file_error(name_ + ": found " + std::to_string(text_.size()) +
                         " bytes after the last element, expected the end of the file");
    }

    std::size_t remaining() const { return text_.size(); }

    [[noreturn]] void fail(const std::string& what) const {
        throw file_error(name_ + ": " + *element_ + " " + std::to_string(number_) + ": " + what);
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

    [[noreturn]] void fail(const std::string& what) const {
        throw file_error(name_ + ":" + std::to_string(line_number_) + ": " + what);
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

template <class Values>
class ply_body_reader {
  public:
    ply_body_reader(const ply_header& header, Values values, const std::string& name)
        : header_(header), values_(std::move(values)), name_(name) {}

    mesh read() {
        require_elements();
        for (const element& e : header_.elements) {
            if (e.name == "vertex") {
                result_.vertices.reserve(capacity(e));
            } else if (e.name == "face") {
                result_.faces.reserve(capacity(e));
            }
            for (std::uint64_t i = 0; i < e.count; ++i) read_element(e, i);
        }
        values_.finish();
        for (std::size_t i = 0; i < result_.faces.size(); ++i) {
            if (const auto fault = fault_of(result_.faces[i], result_.vertices.size())) {
                throw file_error(name_ + ": face " + std::to_string(i) + ": " + *fault);
            }
        }
        return std::move(result_);
    }

  private:
    /// A count is only believed as far as the bytes that are there can bear it out: every element
    /// takes at least one byte per property.
    std::size_t capacity(const element& e) const {
        const std::size_t most =
            values_.remaining() / std::max<std::size_t>(e.properties.size(), 1);
        return static_cast<std::size_t>(std::min<std::uint64_t>(e.count, most));
    }

    void require_elements() const {
        const element* vertices = nullptr;
        const element* faces = nullptr;
        for (const element& e : header_.elements) {
            if (e.name == "vertex") vertices = &e;
            if (e.name == "face") faces = &e;
        }
        if (vertices == nullptr || faces == nullptr) {
            throw file_error(name_ + ": found no element '" +
                             (vertices == nullptr ? "vertex" : "face") +
                             "', expected the elements vertex and face");
        }
        if (vertices->count > std::numeric_limits<index>::max()) {
            throw file_error(name_ + ": found " + std::to_string(vertices->count) +
                             " vertices, expected fewer than 2^32");
        }
        if (faces->count == 0) throw file_error(name_ + ": found no faces, expected at least one");
        for (const char* axis : {"x", "y", "z"}) {
            if (std::none_of(vertices->properties.begin(), vertices->properties.end(),
                             [&](const property& p) { return p.name == axis && !p.count_type; })) {
                throw file_error(name_ + ": found no property '" + axis +
                                 "' of vertex, expected x, y and z");
            }
        }
        const auto lists = std::count_if(faces->properties.begin(), faces->properties.end(),
                                         [](const property& p) { return is_face_list(p); });
        if (lists != 1) {
            throw file_error(name_ + ": found " + (lists == 0 ? "no" : "more than one") +
                             " list of vertex indices in face, expected one list of integers "
                             "called vertex_indices or vertex_index");
        }
    }

    static bool is_face_list(const property& p) {
        return p.count_type && is_integer(p.type) &&
               (p.name == "vertex_indices" || p.name == "vertex_index");
    }

    void read_element(const element& e, std::uint64_t number) {
        values_.begin(e.name, number);
        point<double> position;
        face corners{};
        for (const property& p : e.properties) {
            if (p.count_type) {
                const double count = values_.next(*p.count_type);
                if (count < 0) values_.fail("found a negative count of a list");
                if (e.name == "face" && is_face_list(p)) {
                    corners = read_corners(p, static_cast<std::uint64_t>(count));
                } else {
                    values_.skip(p.type, static_cast<std::uint64_t>(count));
                }
            } else if (e.name == "vertex" && p.name == "x") {
                position.x = coordinate(p);
            } else if (e.name == "vertex" && p.name == "y") {
                position.y = coordinate(p);
            } else if (e.name == "vertex" && p.name == "z") {
                position.z = coordinate(p);
            } else {
                values_.skip(p.type, 1);
            }
        }
        values_.end();
        if (e.name == "vertex") result_.vertices.push_back(position);
        if (e.name == "face") result_.faces.push_back(corners);
    }

    double coordinate(const property& p) {
        const double value = values_.next(p.type);
        if (!std::isfinite(value)) {
            values_.fail(std::string("found ") + (std::isnan(value) ? "NaN" : "an infinity") +
                         " as " + p.name + ", expected a finite number");
        }
        return value;
    }

    face read_corners(const property& p, std::uint64_t count) {
        if (count != 3) {
            values_.fail("found a face with " + std::to_string(count) +
                         " vertices, expected a triangle");
        }
        face result;
        for (index& i : result) {
            const double value = values_.next(p.type);
            if (value < 0) {
                values_.fail("found vertex index " +
                             std::to_string(static_cast<std::int64_t>(value)) +
                             ", expected 0 or more");
            }
            i = static_cast<index>(value);
        }
        return result;
    }

    const ply_header& header_;
    Values values_;
    const std::string& name_;
    mesh result_;
};

}  // namespace

mesh parse_mesh_ply(std::string_view text, const std::string& name) {
    if (text.empty()) throw file_error(name + ": found an empty file, expected a PLY mesh");
    const ply_header header = ply_header_parser(text, name).parse();
    if (header.format == encoding::ascii) {
        return ply_body_reader(header, ascii_values(text, name, header.lines), name).read();
    }
    const std::endian order =
        header.format == encoding::little ? std::endian::little : std::endian::big;
    return ply_body_reader(header, binary_values(text, name, order), name).read();
}

}  // namespace ccd::io
