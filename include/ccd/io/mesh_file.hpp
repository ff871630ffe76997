// Readers and a writer of frames of a mesh (target errbound::ccd_io): PLY (ascii, binary in both
// byte orders) and OBJ; coordinates bit for bit. Lines end in LF, CRLF or CR; a byte order mark of
// UTF-8 is skipped, UTF-16 refused.
#pragma once

#include <ccd/mesh.hpp>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace ccd::io {

/// How a file is read.
struct mesh_options {
    /// Splits a face with more than three corners, in its order, into the triangles (c0, c1, c2),
    /// (c0, c2, c3), ... The split ignores positions, so two frames of one mesh get the same
    /// triangles. Otherwise such a face is an error.
    bool triangulate = false;
};

/// Reads a frame. The extension is the format (.ply or .obj); pipes and files without an extension
/// are recognised by their content. Everything that ccd::step takes is read: faces and edges that
/// repeat a vertex, points only, no elements. Throws errbound::support::file_error if counts do not
/// match, an index is out of range, a face has fewer than three vertices, a coordinate is not
/// finite, or the file is truncated or unreadable.
mesh read_mesh(const std::filesystem::path& path, const mesh_options& options = {});

/// Reads a frame from the text of a PLY file: all scalar types, elements in any order, elements and
/// properties other than the vertices' x, y, z, the faces' vertex_indices (or vertex_index) and the
/// edges' vertex1, vertex2 skipped; other elements with vertex indices (tristrips) are refused. A
/// coordinate is the value of its declared type: `property float x` with the text "0.1" is the
/// float nearest to 0.1. `name` is used in messages. Throws as read_mesh does.
mesh parse_mesh_ply(std::string_view text, const std::string& name,
                    const mesh_options& options = {});

/// Reads a frame from the text of an OBJ file: `v`, `f`, `l` (a polyline, whose parts are edges)
/// and `p`, with v, v/vt, v//vn or v/vt/vn for a vertex; negative indices count back. A point `p`
/// on no face and no edge is returned as an edge that repeats its vertex. The format's other
/// keywords are skipped. Curves, surfaces and `call`, which a mesh cannot hold, and unknown words
/// are refused. A comment starts at a `#` that begins a word. `name` is used in messages. Throws as
/// read_mesh does, and if there is no vertex.
mesh parse_mesh_obj(std::string_view text, const std::string& name,
                    const mesh_options& options = {});

/// Some of a frame's vertices, faces and edges, one after the other; faces and edges name vertices
/// by their indices in the whole frame.
struct mesh_share {
    struct place {
        std::size_t first = 0, all = 0;  ///< of how many of the whole frame
    };
    mesh elements;
    place vertices, faces, edges;
};

/// One of `shares` shares of a frame in a file (not a pipe), for processes that read one together.
/// Of a PLY file no more is held than the share: binary ones are not even looked at elsewhere; OBJ
/// files are read whole. Throws as read_mesh does, on some share if there is reason to, and
/// std::invalid_argument unless share < shares.
mesh_share read_mesh_share(const std::filesystem::path& path, std::size_t share,
                           std::size_t shares);

/// Throws errbound::support::file_error unless both frames have the same topology.
void require_same_topology(const mesh& before, const std::string& before_name, const mesh& after,
                           const std::string& after_name);
/// Of the same share of both.
void require_same_topology(const mesh_share& before, const std::string& before_name,
                           const mesh_share& after, const std::string& after_name);

/// A frame as the text of a PLY file, binary, in this machine's byte order: coordinates in doubles,
/// bit for bit. read_mesh reads it back as it was.
std::string ply_of(const mesh& frame);

}  // namespace ccd::io
