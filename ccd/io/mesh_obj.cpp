// The OBJ reader. Our own, because the libraries at hand do not round coordinates correctly.
#include <array>
#include <ccd/io/mesh_file.hpp>
#include <charconv>
#include <cstdint>
#include <errbound/support/error.hpp>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "ccd/io/element_check.hpp"
#include "ccd/io/text.hpp"

namespace ccd::io {
namespace {

using errbound::support::file_error;

class obj_parser {
  public:
    explicit obj_parser(const std::string& name) : name_(name) {}

    mesh parse(std::string_view text) {
        while (const std::optional<std::string_view> whole = take_line(text)) {
            ++line_;
            std::string_view line = whole->substr(0, whole->find('#'));
            const std::string_view keyword = take_word(line);
            if (keyword == "v") read_vertex(line);
            if (keyword == "f") read_face(line);
            if (keyword == "l") read_polyline(line);
        }
        if (result_.vertices.empty() || (result_.faces.empty() && result_.edges.empty())) {
            throw file_error(name_ + ": found no " +
                             (result_.vertices.empty() ? "vertices" : "faces or edges") +
                             ", expected lines 'v x y z' and 'f i j k' or 'l i j'");
        }
        // A face may come before its vertices, so this must wait until all are read.
        require_good("face", result_.faces, face_lines_);
        require_good("edge", result_.edges, edge_lines_);
        return std::move(result_);
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw file_error(name_ + ":" + std::to_string(line_) + ": " + what);
    }

    template <class Element>
    void require_good(const char* name, const std::vector<Element>& elements,
                      const std::vector<std::size_t>& lines) {
        for (std::size_t i = 0; i < elements.size(); ++i) {
            line_ = lines[i];
            if (const auto fault = fault_of(elements[i], result_.vertices.size()))
                fail(std::string(name) + " " + std::to_string(i) + " (indices from 0): " + *fault);
        }
    }

    void read_vertex(std::string_view line) {
        // x y z, then optionally w, or r g b.
        std::array<double, 6> values{};
        std::size_t count = 0;
        for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
            if (count == values.size()) fail("found more than 6 values of a vertex");
            const number value = parse_double(word, false);
            if (value.status != number_status::ok) fail(describe(value.status, word));
            values[count++] = value.value;
        }
        if (count != 3 && count != 4 && count != 6) {
            fail("found " + std::to_string(count) + " values of a vertex, expected 3 (x y z)");
        }
        if (count == 4 && values[3] != 1) fail("found a vertex with weight, expected none or 1");
        if (result_.vertices.size() == std::numeric_limits<vertex_index>::max()) {
            fail("found more vertices than expected, fewer than 2^32");
        }
        result_.vertices.push_back({values[0], values[1], values[2]});
    }

    void read_face(std::string_view line) {
        face corners{};
        std::size_t count = 0;
        for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
            if (count < corners.size()) corners[count] = corner(word);
            ++count;
        }
        if (count != 3) {
            fail("found a face with " + std::to_string(count) + " vertices, expected a triangle");
        }
        result_.faces.push_back(corners);
        face_lines_.push_back(line_);
    }

    /// An edge between every two neighbours.
    void read_polyline(std::string_view line) {
        std::optional<vertex_index> last;
        std::size_t count = 0;
        for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
            const vertex_index next = corner(word);
            if (last) {
                result_.edges.push_back({*last, next});
                edge_lines_.push_back(line_);
            }
            last = next;
            ++count;
        }
        if (count < 2) {
            fail("found a line with " + std::to_string(count) + " vertices, expected 2 or more");
        }
    }

    /// The vertex index of v, v/vt, v//vn or v/vt/vn, from 0.
    vertex_index corner(std::string_view word) const {
        std::array<std::int64_t, 3> indices{};
        std::string_view rest = word;
        for (std::size_t part = 0;; ++part) {
            const std::size_t slash = rest.find('/');
            const std::string_view token = rest.substr(0, slash);
            const bool last = slash == std::string_view::npos;
            const bool may_be_empty = part == 1 && !last;  // v//vn
            const char* const end = token.data() + token.size();
            const auto [stop, ec] = std::from_chars(token.data(), end, indices[part]);
            if ((ec != std::errc{} || stop != end) && !(token.empty() && may_be_empty)) {
                fail("found " + excerpt(word) + ", expected v, v/vt, v//vn or v/vt/vn, integers");
            }
            if (last) break;
            if (part == 2) fail("found " + excerpt(word) + ", expected at most v/vt/vn");
            rest.remove_prefix(slash + 1);
        }
        const auto vertices = static_cast<std::int64_t>(result_.vertices.size());
        const std::int64_t i = indices[0];
        const bool in_range =
            i > 0 ? i <= std::numeric_limits<vertex_index>::max() : i < 0 && i >= -vertices;
        if (!in_range) {
            fail("found vertex index " + std::to_string(i) +
                 ", expected 1 or more, or one back from the last vertex so far (-1 to -" +
                 std::to_string(vertices) + ")");
        }
        return static_cast<vertex_index>(i > 0 ? i - 1 : vertices + i);
    }

    const std::string& name_;
    mesh result_;
    std::vector<std::size_t> face_lines_, edge_lines_;
    std::size_t line_ = 0;
};

}  // namespace

mesh parse_mesh_obj(std::string_view text, const std::string& name) {
    if (text.empty()) throw file_error(name + ": found an empty file, expected an OBJ mesh");
    return obj_parser(name).parse(text);
}

}  // namespace ccd::io
