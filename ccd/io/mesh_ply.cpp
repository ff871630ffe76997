// The PLY reader. Our own, because the PLY libraries that distributions carry convert coordinates
// to float.
#include <algorithm>
#include <ccd/io/mesh_file.hpp>
#include <cmath>
#include <cstdint>
#include <errbound/support/error.hpp>
#include <limits>
#include <utility>

#include "ccd/io/face_check.hpp"
#include "ccd/io/ply_header.hpp"
#include "ccd/io/ply_values.hpp"

namespace ccd::io {

using errbound::support::file_error;

namespace ply {
namespace {

template <class Values>
class body_reader {
  public:
    body_reader(const header& header, Values values, const std::string& name)
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
    /// What to reserve: no more than the bytes that are there can hold, whatever the header claims.
    /// Every element takes at least one byte per property.
    std::size_t capacity(const element& e) const {
        const std::size_t limit =
            values_.remaining() / std::max<std::size_t>(e.properties.size(), 1);
        return static_cast<std::size_t>(std::min<std::uint64_t>(e.count, limit));
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

    const header& header_;
    Values values_;
    const std::string& name_;
    mesh result_;
};

}  // namespace
}  // namespace ply

mesh parse_mesh_ply(std::string_view text, const std::string& name) {
    if (text.empty()) throw file_error(name + ": found an empty file, expected a PLY mesh");
    using namespace ply;
    const header head = parse_header(text, name);
    if (head.format == encoding::ascii)
        return body_reader(head, ascii_values(text, name, head.lines), name).read();
    const std::endian order =
        head.format == encoding::little ? std::endian::little : std::endian::big;
    return body_reader(head, binary_values(text, name, order), name).read();
}

}  // namespace ccd::io
