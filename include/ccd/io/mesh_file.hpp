// Reads and writes frames of a mesh (target errbound::ccd_io): PLY (ascii, binary in both byte
// orders) and OBJ; coordinates bit for bit. Lines end in LF, CRLF or CR; a byte order mark of UTF-8
// is skipped, UTF-16 refused.
#pragma once

#include <ccd/mesh.hpp>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace ccd::io {

struct mesh_options {
    /// Splits a face with more than three corners into the triangles (c0, c1, c2), (c0, c2, c3),
    /// ... The split ignores positions, so two frames of one mesh get the same triangles. Otherwise
    /// such a face is an error.
    bool triangulate = false;
};

/// Reads a frame. The extension names the format (.ply or .obj); the content shows that of pipes
/// and of files without an extension. Accepts all frames of ccd::step, also with repeated vertices,
/// with points only, or without elements. Throws errbound::support::file_error if counts do not
/// match, an index is out of range or a face has fewer than three vertices. Also throws if a
/// coordinate is not finite, or if the file is truncated or unreadable.
mesh read_mesh(const std::filesystem::path& path, const mesh_options& options = {});

/// Reads a frame from the text of a PLY file, with all scalar types and elements in any order. Uses
/// the vertices' x, y, z, the faces' vertex_indices (or vertex_index) and the edges' vertex1,
/// vertex2. Refuses other elements with vertex indices (tristrips), and skips all else. A
/// coordinate is the value of its declared type: `property float x` with the text "0.1" is the
/// float nearest to 0.1. `name` is used in messages. Throws as read_mesh.
mesh parse_mesh_ply(std::string_view text, const std::string& name,
                    const mesh_options& options = {});

/// Reads a frame from the text of an OBJ file: `v`, `f`, `l` (a polyline, whose segments are edges)
/// and `p`, with v, v/vt, v//vn or v/vt/vn for a vertex; negative indices count back. A point `p`
/// on no face and no edge becomes an edge that repeats its vertex. Skips the format's other
/// keywords, but refuses unknown words, and curves, surfaces and `call`, which a mesh cannot hold.
/// A comment starts at a `#` that begins a word. Throws as read_mesh, and if there is no vertex.
mesh parse_mesh_obj(std::string_view text, const std::string& name,
                    const mesh_options& options = {});

/// Consecutive vertices, faces and edges of a frame. Indices are those of the whole frame.
struct mesh_share {
    struct place {
        std::size_t first = 0, all = 0;  ///< `all`: number in the whole frame
    };
    mesh elements;
    place vertices, faces, edges;
};

/// Reads one of `shares` shares of a frame in a file (not a pipe), for processes that read a file
/// together. Memory: the share of a PLY file (only its bytes are read if binary), all of an OBJ
/// file. At least one share throws if read_mesh would. Throws std::invalid_argument unless share <
/// shares.
mesh_share read_mesh_share(const std::filesystem::path& path, std::size_t share,
                           std::size_t shares);

/// Throws errbound::support::file_error unless both frames, or equal shares, have one topology.
void require_same_topology(const mesh& before, const std::string& before_name, const mesh& after,
                           const std::string& after_name);
void require_same_topology(const mesh_share& before, const std::string& before_name,
                           const mesh_share& after, const std::string& after_name);

/// Returns a binary PLY file in this machine's byte order, which read_mesh reads bit for bit.
std::string ply_of(const mesh& frame);

}  // namespace ccd::io
