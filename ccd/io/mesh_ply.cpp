// The PLY reader. Our own, because the PLY libraries that distributions carry convert coordinates
// to float.
#include <algorithm>
#include <ccd/io/mesh_file.hpp>
#include <cmath>
#include <cstdint>
#include <errbound/support/error.hpp>
#include <limits>
#include <utility>

#include "ccd/io/element_check.hpp"
#include "ccd/io/mesh_shares.hpp"
#include "ccd/io/ply_header.hpp"
#include "ccd/io/ply_values.hpp"

namespace ccd::io {

using errbound::support::file_error;

namespace ply {
namespace {

template <class Values>
class body_reader {
  public:
    body_reader(const header& header, Values values, const std::string& name,
                const mesh_options& options)
        : header_(header), values_(std::move(values)), name_(name), options_(options) {}

    mesh_share read(share_of_file share) {
        require_elements();
        for (const element& e : header_.elements) {
            const auto first = share.first_of(e.count), last = share.last_of(e.count);
            reserve(e, last - first);
            skip_elements(e, 0, first);
            for (std::uint64_t i = first; i < last; ++i) read_element(e, i);
            skip_elements(e, last, e.count);
            const mesh_share::place place{static_cast<std::size_t>(first),
                                          static_cast<std::size_t>(e.count)};
            if (e.name == "vertex") result_.vertices = place;
            if (e.name == "face") result_.faces = place;
            if (e.name == "edge") result_.edges = place;
        }
        values_.finish();
        require_good(options_.triangulate ? "triangle" : "face", result_.elements.faces,
                     result_.faces.first);
        require_good("edge", result_.elements.edges, result_.edges.first);
        return std::move(result_);
    }

  private:
    template <class Element>
    void require_good(const char* kind, const std::vector<Element>& elements,
                      std::size_t first) const {
        for (std::size_t i = 0; i < elements.size(); ++i)
            if (const auto fault = fault_of(elements[i], result_.vertices.all))
                throw file_error(name_ + ": " + kind + " " + std::to_string(first + i) + ": " +
                                 *fault);
    }

    /// No more than the bytes that are there can hold, whatever the header claims. Every element
    /// takes at least one byte per property.
    void reserve(const element& e, std::uint64_t count) {
        const std::size_t limit =
            values_.remaining() / std::max<std::size_t>(e.properties.size(), 1);
        const auto capacity = static_cast<std::size_t>(std::min<std::uint64_t>(count, limit));
        mesh& elements = result_.elements;
        if (e.name == "vertex") elements.vertices.reserve(capacity);
        if (e.name == "face") elements.faces.reserve(capacity);
        if (e.name == "edge") elements.edges.reserve(capacity);
    }

    void skip_elements(const element& e, std::uint64_t first, std::uint64_t last) {
        if (first == last) return;
        values_.begin(e.name, first);
        const std::optional<std::size_t> bytes = bytes_of_each(e);
        if (bytes && values_.skip_elements(*bytes, last - first)) return;
        for (std::uint64_t i = first; i < last; ++i) {
            if (i > first) values_.begin(e.name, i);
            values_.skip_rest([&] {
                for (const property& p : e.properties) skip(p);
            });
        }
    }

    /// Of an element in a binary file, where all have as many: a face its three vertices. If one
    /// has not, then whose share has the first such face reads it where it is, and tells.
    static std::optional<std::size_t> bytes_of_each(const element& e) {
        std::size_t bytes = 0;
        for (const property& p : e.properties) {
            const bool is_face = e.name == "face" && is_face_list(p);
            if (p.count_type && !is_face) return std::nullopt;
            bytes += is_face ? io::ply::bytes_of(*p.count_type) + 3 * io::ply::bytes_of(p.type)
                             : io::ply::bytes_of(p.type);
        }
        return bytes;
    }

    const element* find(std::string_view element_name) const {
        const auto found = std::ranges::find(header_.elements, element_name, &element::name);
        return found == header_.elements.end() ? nullptr : &*found;
    }

    /// Elements that would be lost with what they say of faces or edges, such as tristrips.
    void require_no_other_geometry() const {
        for (const element& e : header_.elements) {
            if (e.count == 0 || e.name == "vertex" || e.name == "face" || e.name == "edge")
                continue;
            const bool has_indices = std::ranges::any_of(e.properties, [](const property& p) {
                return is_face_list(p) || is_vertex_of_edge(p);
            });
            if (has_indices)
                throw file_error(name_ + ": found vertex indices in element " + excerpt(e.name) +
                                 ", expected them in face or edge");
        }
    }

    void require_elements() const {
        require_no_other_geometry();
        const element* const vertices = find("vertex");
        const element* const faces = find("face");
        const element* const edges = find("edge");
        if (vertices == nullptr)
            throw file_error(name_ + ": found no element 'vertex', expected one");
        if (vertices->count > std::numeric_limits<vertex_index>::max()) {
            throw file_error(name_ + ": found " + std::to_string(vertices->count) +
                             " vertices, expected fewer than 2^32");
        }
        const bool has_faces = faces != nullptr && faces->count > 0;
        const bool has_edges = edges != nullptr && edges->count > 0;
        for (const char* axis : {"x", "y", "z"}) require_property(*vertices, axis, is_coordinate);
        if (has_faces) require_face_list(*faces);
        if (has_edges)
            for (const char* end : {"vertex1", "vertex2"})
                require_property(*edges, end, is_vertex_of_edge);
    }

    template <class IsOne>
    void require_property(const element& of, const char* wanted, const IsOne& is_one) const {
        const bool found = std::ranges::any_of(
            of.properties, [&](const property& p) { return p.name == wanted && is_one(p); });
        if (found) return;
        const bool coordinates = of.name == "vertex";
        throw file_error(name_ + ": found no property '" + wanted + "' of " + of.name +
                         ", expected " +
                         (coordinates ? "x, y and z" : "integers vertex1 and vertex2"));
    }

    void require_face_list(const element& faces) const {
        const auto lists = std::ranges::count_if(faces.properties, is_face_list);
        if (lists != 1) {
            throw file_error(name_ + ": found " + (lists == 0 ? "no" : "more than one") +
                             " list of vertex indices in face, expected one list of integers "
                             "called vertex_indices or vertex_index");
        }
    }

    static bool is_coordinate(const property& p) {
        return !p.count_type && (p.name == "x" || p.name == "y" || p.name == "z");
    }
    static bool is_vertex_of_edge(const property& p) {
        return !p.count_type && is_integer(p.type) && (p.name == "vertex1" || p.name == "vertex2");
    }
    static bool is_face_list(const property& p) {
        return p.count_type && is_integer(p.type) &&
               (p.name == "vertex_indices" || p.name == "vertex_index");
    }

    void read_element(const element& e, std::uint64_t number) {
        values_.begin(e.name, number);
        if (e.name == "vertex") {
            result_.elements.vertices.push_back(read_vertex(e));
        } else if (e.name == "face") {
            read_face(e);
        } else if (e.name == "edge") {
            result_.elements.edges.push_back(read_edge(e));
        } else {
            for (const property& p : e.properties) skip(p);
        }
        values_.end();
    }

    point<double> read_vertex(const element& e) {
        point<double> position;
        for (const property& p : e.properties) {
            if (is_coordinate(p))
                (p.name == "x"   ? position.x
                 : p.name == "y" ? position.y
                                 : position.z) = coordinate(p);
            else
                skip(p);
        }
        return position;
    }

    void read_face(const element& e) {
        for (const property& p : e.properties) {
            if (is_face_list(p))
                read_corners(p);
            else
                skip(p);
        }
    }

    edge read_edge(const element& e) {
        edge ends{};
        for (const property& p : e.properties) {
            if (is_vertex_of_edge(p))
                ends[p.name == "vertex1" ? 0 : 1] = read_index(p);
            else
                skip(p);
        }
        return ends;
    }

    void skip(const property& p) { values_.skip(p.type, p.count_type ? list_size(p) : 1); }

    std::uint64_t list_size(const property& p) {
        const double count = values_.next(*p.count_type);
        if (count < 0) values_.fail("found a negative count of a list");
        return static_cast<std::uint64_t>(count);
    }

    double coordinate(const property& p) {
        const double value = values_.next(p.type);
        if (!std::isfinite(value)) {
            values_.fail(std::string("found ") + (std::isnan(value) ? "NaN" : "an infinity") +
                         " as " + p.name + ", expected a finite number");
        }
        return value;
    }

    void read_corners(const property& p) {
        const std::uint64_t count = list_size(p);
        if (count != 3) check_corners(count, options_, values_.where());
        face triangle;
        for (vertex_index& i : triangle) i = read_index(p);
        result_.elements.faces.push_back(triangle);
        for (std::uint64_t corner = 3; corner < count; ++corner) {
            triangle = {triangle[0], triangle[2], read_index(p)};
            result_.elements.faces.push_back(triangle);
        }
    }

    vertex_index read_index(const property& p) {
        const double value = values_.next(p.type);
        if (value < 0) {
            values_.fail("found vertex index " + std::to_string(static_cast<std::int64_t>(value)) +
                         ", expected 0 or more");
        }
        return static_cast<vertex_index>(value);
    }

    const header& header_;
    Values values_;
    const std::string& name_;
    const mesh_options& options_;
    mesh_share result_;
};

}  // namespace
}  // namespace ply

mesh_share parse_share_ply(std::string_view text, const std::string& name, share_of_file share,
                           const mesh_options& options) {
    if (text.empty()) throw file_error(name + ": found an empty file, expected a PLY mesh");
    using namespace ply;
    text = without_byte_order_mark(text, name);
    const header head = parse_header(text, name);
    if (head.format == encoding::ascii)
        return body_reader(head, ascii_values(without_end_mark(text), name, head.lines), name,
                           options)
            .read(share);
    const std::endian order =
        head.format == encoding::little ? std::endian::little : std::endian::big;
    return body_reader(head, binary_values(text, name, order), name, options).read(share);
}

mesh parse_mesh_ply(std::string_view text, const std::string& name, const mesh_options& options) {
    return parse_share_ply(text, name, share_of_file(), options).elements;
}

}  // namespace ccd::io
