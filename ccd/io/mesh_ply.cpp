// The reader and writer of PLY. The libraries of distributions convert coordinates to float.
#include <algorithm>
#include <bit>
#include <ccd/io/mesh_file.hpp>
#include <cmath>
#include <cstdint>
#include <errbound/support/error.hpp>
#include <limits>
#include <type_traits>
#include <utility>

#include "ccd/io/mesh_reading.hpp"
#include "ccd/io/ply.hpp"

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
    [[noreturn]] void fail(const std::string& what) const { throw file_error(name_ + ": " + what); }

    void require_elements() const {
        bool has_vertices = false;
        for (const element& e : header_.elements) {
            if (e.count > 0 && e.number_of(role::misplaced) > 0)
                fail("element " + excerpt(e.name) +
                     " has vertex indices; expected them in face or edge");
            if (e.name == "vertex") {
                has_vertices = true;
                if (e.count > std::numeric_limits<vertex_index>::max())
                    fail("number of vertices is " + std::to_string(e.count) +
                         "; expected fewer than 2^32");
                for (const auto& [axis, r] :
                     {std::pair("x", role::x), {"y", role::y}, {"z", role::z}})
                    require_property(e, axis, r, "x, y and z");
            } else if (e.name == "face" && e.count > 0) {
                const auto lists = e.number_of(role::corners);
                if (lists != 1)
                    fail("number of lists of vertex indices in face is " + std::to_string(lists) +
                         "; expected 1, of integers, called vertex_indices or vertex_index");
            } else if (e.name == "edge" && e.count > 0) {
                require_property(e, "vertex1", role::vertex1, "integers vertex1 and vertex2");
                require_property(e, "vertex2", role::vertex2, "integers vertex1 and vertex2");
            }
        }
        if (!has_vertices) fail("number of elements 'vertex' is 0; expected 1");
    }

    void require_property(const element& e, const char* wanted, role r,
                          const char* expected) const {
        if (e.number_of(r) == 0)
            fail(std::string("property '") + wanted + "' of " + e.name + " is missing; expected " +
                 expected);
    }

    template <class Element>
    void require_good(const std::string& kind, const std::vector<Element>& elements,
                      std::size_t first) const {
        for (std::size_t i = 0; i < elements.size(); ++i)
            if (const auto fault = fault_of(elements[i], result_.vertices.all))
                fail(kind + " " + std::to_string(first + i) + ": " + *fault);
    }

    /// Reserves no more than the file's bytes can hold: each element has at least one per property.
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

    /// The bytes of an element, if every element has the same number of bytes. Assumes that faces
    /// are triangles: the share that holds the first other face fails when it reads that face.
    static std::optional<std::size_t> bytes_of_each(const element& e) {
        std::size_t bytes = 0;
        for (const property& p : e.properties) {
            const bool is_face = p.role == role::corners;
            if (p.count_type && !is_face) return std::nullopt;
            bytes += is_face ? bytes_of(*p.count_type) + 3 * bytes_of(p.type) : bytes_of(p.type);
        }
        return bytes;
    }

    void read_element(const element& e, std::uint64_t index) {
        values_.begin(e.name, index);
        point<double> position;
        edge ends{};
        for (const property& p : e.properties) {
            switch (p.role) {
                case role::x:
                    position.x = coordinate(p);
                    break;
                case role::y:
                    position.y = coordinate(p);
                    break;
                case role::z:
                    position.z = coordinate(p);
                    break;
                case role::corners:
                    read_corners(p);
                    break;
                case role::vertex1:
                    ends[0] = read_index(p);
                    break;
                case role::vertex2:
                    ends[1] = read_index(p);
                    break;
                case role::none:
                case role::misplaced:
                    skip(p);
            }
        }
        if (e.name == "vertex") result_.elements.vertices.push_back(position);
        if (e.name == "edge") result_.elements.edges.push_back(ends);
        values_.end();
    }

    void skip(const property& p) { values_.skip(p.type, p.count_type ? list_size(p) : 1); }

    std::uint64_t list_size(const property& p) {
        const double count = values_.next(*p.count_type);
        if (count < 0)
            values_.fail("count of a list is " + std::to_string(static_cast<std::int64_t>(count)) +
                         "; expected 0 or more");
        return static_cast<std::uint64_t>(count);
    }

    double coordinate(const property& p) {
        const double value = values_.next(p.type);
        if (!std::isfinite(value))
            values_.fail(p.name + " is " + (std::isnan(value) ? "NaN" : "an infinity") +
                         "; expected a finite number");
        return value;
    }

    void read_corners(const property& p) {
        const std::uint64_t count = list_size(p);
        if (const auto fault = fault_of_corners(count, options_)) values_.fail(*fault);
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
        if (value < 0)
            values_.fail("vertex index is " + std::to_string(static_cast<std::int64_t>(value)) +
                         "; expected 0 or more");
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
    if (text.empty()) throw file_error(name + ": file is empty; expected a PLY mesh");
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

namespace {

template <class Value>
void append(std::string& text, const Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

std::string ply_of(const mesh& frame) {
    std::string text = "ply\nformat binary_";
    text += std::endian::native == std::endian::little ? "little" : "big";
    text += "_endian 1.0\nelement vertex " + std::to_string(frame.vertices.size());
    for (const char axis : {'x', 'y', 'z'}) (text += "\nproperty double ") += axis;
    text += "\nelement face " + std::to_string(frame.faces.size());
    text += "\nproperty list uchar uint vertex_indices";
    if (!frame.edges.empty())
        text += "\nelement edge " + std::to_string(frame.edges.size()) +
                "\nproperty uint vertex1\nproperty uint vertex2";
    text += "\nend_header\n";
    for (const point<double>& p : frame.vertices) append(text, p);
    for (const face& f : frame.faces) {
        append(text, std::uint8_t(f.size()));
        append(text, f);
    }
    for (const edge& e : frame.edges) append(text, e);
    return text;
}

}  // namespace ccd::io
