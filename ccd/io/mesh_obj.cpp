// The OBJ reader. The available libraries do not round coordinates correctly.
#include <algorithm>
#include <array>
#include <ccd/io/mesh_file.hpp>
#include <charconv>
#include <cstdint>
#include <errbound/support/error.hpp>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "ccd/io/mesh_reading.hpp"
#include "ccd/io/text.hpp"

namespace ccd::io {
namespace {

using errbound::support::file_error;

/// Names, materials, rendering, attributes of vertices, parts of free-form geometry.
constexpr std::array<std::string_view, 32> skipped_keywords{
    "vt",        "vn",     "vp",     "g",      "s",      "mg",     "o",     "bevel",
    "c_interp",  "lod",    "usemtl", "mtllib", "usemap", "maplib", "ctech", "d_interp",
    "trace_obj", "cstype", "deg",    "bmat",   "step",   "curv2",  "parm",  "shadow_obj",
    "hole",      "scrv",   "sp",     "end",    "con",    "res",    "trim",  "stech"};

/// Free-form curves and surfaces, and lines from other files, which a mesh would lack.
constexpr std::array<std::string_view, 8> refused_keywords{"curv", "surf", "bzp",  "bsp",
                                                           "cdc",  "cdp",  "call", "csh"};

bool is_blank(char c) {
    return c == ' ' || c == '\t';
}

class obj_parser {
  public:
    obj_parser(std::string_view text, const std::string& name, const mesh_options& options)
        : lines_(text, name), options_(options) {}

    mesh parse() {
        while (std::optional<std::string_view> line = next_line()) {
            const std::string_view keyword = take_word(*line);
            if (keyword == "v")
                read_vertex(*line);
            else if (keyword == "f" || keyword == "fo")  // fo: an old name of f
                read_face(*line);
            else if (keyword == "l")
                read_polyline(*line);
            else if (keyword == "p")
                read_points(*line);
            else if (!keyword.empty())
                require_skipped(keyword);
        }
        if (result_.vertices.empty())
            throw file_error(lines_.name() + ": number of vertices is 0; expected lines 'v x y z'");
        // A face may come before its vertices.
        require_good(options_.triangulate ? "triangle" : "face", result_.faces, face_lines_);
        require_good("edge", result_.edges, edge_lines_);
        require_good("point", points_, point_lines_);
        add_points();
        return std::move(result_);
    }

  private:
    [[noreturn]] void fail(const std::string& what) const { fail_at(lines_.name(), line_, what); }

    /// The next line without its comment, joined with the lines that backslashes add.
    std::optional<std::string_view> next_line() {
        line_ = lines_.line() + 1;
        const std::optional<std::string_view> first = next_piece();
        if (!first || !first->ends_with('\\')) return first;
        joined_ = *first;
        while (joined_.ends_with('\\')) {
            joined_.pop_back();
            const std::optional<std::string_view> next = next_piece();
            if (!next) fail("last line ends with a backslash; expected a line after it");
            // Readers differ on whether a word goes on across the line end.
            const bool may_split = !joined_.empty() && !next->empty() &&
                                   !is_blank(joined_.back()) && !is_blank(next->front());
            if (may_split) fail("backslash may split a word; expected a blank before it");
            joined_ += *next;
        }
        return joined_;
    }

    /// A line without its comment, which starts at a '#' that begins a word (unlike 1.#INF).
    std::optional<std::string_view> next_piece() {
        const std::optional<std::string_view> whole = lines_.next();
        if (!whole) return whole;
        std::size_t end = whole->find('#');
        while (end != std::string_view::npos && end > 0 && !is_blank((*whole)[end - 1]))
            end = whole->find('#', end + 1);
        const std::string_view piece = whole->substr(0, end);
        if (std::ranges::any_of(piece, is_control))
            fail("line is " + excerpt(piece) + "; expected no control characters");
        return piece;
    }

    void require_skipped(std::string_view keyword) const {
        if (std::ranges::find(refused_keywords, keyword) != refused_keywords.end())
            fail("keyword is " + excerpt(keyword) +
                 ", which a mesh cannot hold; expected triangles");
        if (std::ranges::find(skipped_keywords, keyword) == skipped_keywords.end())
            fail("keyword is " + excerpt(keyword) + "; expected v, f, l or another of OBJ's");
    }

    template <class Element>
    void require_good(const std::string& name, const std::vector<Element>& elements,
                      const std::vector<std::size_t>& lines) const {
        for (std::size_t i = 0; i < elements.size(); ++i)
            if (const auto fault = fault_of(elements[i], result_.vertices.size()))
                fail_at(lines_.name(), lines[i],
                        name + " " + std::to_string(i) + " (indices from 0): " + *fault);
    }

    void read_vertex(std::string_view line) {
        // x y z, then optionally w, or r g b, or r g b a.
        std::array<double, 7> values{};
        std::size_t count = 0;
        for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
            if (count == values.size())
                fail("number of values of a vertex is more than 7; expected 3 (x y z)");
            const number value = parse_double(word, false);
            if (value.status != number_status::ok)
                fail(describe(value.status, "value", excerpt(word)));
            values[count++] = value.value;
        }
        if (count < 3 || count == 5)
            fail("number of values of a vertex is " + std::to_string(count) +
                 "; expected 3 (x y z)");
        if (count == 4 && values[3] != 1) fail("weight of a vertex is not 1; expected none or 1");
        if (result_.vertices.size() == std::numeric_limits<vertex_index>::max())
            fail("number of vertices is 2^32 or more; expected fewer than 2^32");
        result_.vertices.push_back({values[0], values[1], values[2]});
    }

    void read_face(std::string_view line) {
        read_corners(line);
        if (const auto fault = fault_of_corners(corners_.size(), options_)) fail(*fault);
        for (std::size_t i = 2; i < corners_.size(); ++i) {
            result_.faces.push_back({corners_[0], corners_[i - 1], corners_[i]});
            face_lines_.push_back(line_);
        }
    }

    void read_polyline(std::string_view line) {
        read_corners(line);
        if (corners_.size() < 2)
            fail("number of vertices of a line is " + std::to_string(corners_.size()) +
                 "; expected 2 or more");
        for (std::size_t i = 1; i < corners_.size(); ++i) {
            result_.edges.push_back({corners_[i - 1], corners_[i]});
            edge_lines_.push_back(line_);
        }
    }

    void read_points(std::string_view line) {
        read_corners(line);
        if (corners_.empty())
            fail("number of vertices of a point element is 0; expected 1 or more");
        for (const vertex_index v : corners_) {
            points_.push_back({v});
            point_lines_.push_back(line_);
        }
    }

    void add_points() {
        if (points_.empty()) return;
        std::vector<bool> is_unused(result_.vertices.size());
        for (const vertex_index v :
             unused_vertices(result_.faces, result_.edges, result_.vertices.size()))
            is_unused[v] = true;
        for (const auto& [v] : points_) {
            if (is_unused[v]) result_.edges.push_back({v, v});
            is_unused[v] = false;
        }
    }

    void read_corners(std::string_view line) {
        corners_.clear();
        for (std::string_view word = take_word(line); !word.empty(); word = take_word(line))
            corners_.push_back(corner(word));
    }

    static bool read_index(std::string_view token, std::int64_t& index) {
        const bool plus = token.starts_with('+') && !token.starts_with("+-");
        if (plus) token.remove_prefix(1);
        const char* const end = token.data() + token.size();
        const auto [stop, error] = std::from_chars(token.data(), end, index);
        return error == std::errc{} && stop == end;
    }

    /// If vt and vn are absent, slashes may stay: v/, v//, v/vt/.
    vertex_index corner(std::string_view word) const {
        std::array<std::int64_t, 3> indices{};
        std::string_view rest = word;
        for (std::size_t part = 0;; ++part) {
            const std::size_t slash = rest.find('/');
            const std::string_view token = rest.substr(0, slash);
            const bool last = slash == std::string_view::npos;
            const bool is_omitted = token.empty() && part > 0;
            const bool is_index = read_index(token, indices[part]) &&
                                  (part == 0 || indices[part] != 0);  // v is checked below
            if (!is_index && !is_omitted)
                fail("vertex is " + excerpt(word) +
                     "; expected v, v/vt, v//vn or v/vt/vn, integers other than 0");
            if (last) break;
            if (part == 2) fail("vertex is " + excerpt(word) + "; expected at most v/vt/vn");
            rest.remove_prefix(slash + 1);
        }
        const auto vertices = static_cast<std::int64_t>(result_.vertices.size());
        const std::int64_t i = indices[0];
        const bool in_range =
            i > 0 ? i <= std::numeric_limits<vertex_index>::max() : i < 0 && i >= -vertices;
        if (!in_range)
            fail("vertex index is " + std::to_string(i) +
                 "; expected 1 or more, or one back from the last vertex so far (-1 to -" +
                 std::to_string(vertices) + ")");
        return static_cast<vertex_index>(i > 0 ? i - 1 : vertices + i);
    }

    line_reader lines_;
    const mesh_options& options_;
    std::string joined_;  ///< lines that backslashes join
    mesh result_;
    std::vector<vertex_index> corners_;  ///< of the last element
    std::vector<std::array<vertex_index, 1>> points_;
    std::vector<std::size_t> face_lines_, edge_lines_, point_lines_;
    std::size_t line_ = 0;  ///< the first of the joined lines
};

}  // namespace

mesh parse_mesh_obj(std::string_view text, const std::string& name, const mesh_options& options) {
    if (text.empty()) throw file_error(name + ": file is empty; expected an OBJ mesh");
    text = without_end_mark(without_byte_order_mark(text, name));
    return obj_parser(text, name, options).parse();
}

}  // namespace ccd::io
