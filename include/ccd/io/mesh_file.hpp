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

/// Reads a frame; the format is that of the extension (.ply or .obj), or told from the content
/// where there is none and for pipes. Faces with more than three vertices are an error. Throws
/// errbound::support::file_error: counts that do not match, indices out of range, faces with fewer
/// than three or repeated vertices, neither faces nor edges, coordinates that are not finite,
/// truncated or unreadable files.
mesh read_mesh(const std::filesystem::path& path);

/// Reads a frame from the text of a PLY file: all scalar types, elements in any order, elements and
/// properties other than the vertices' x, y, z, the faces' vertex_indices (or vertex_index) and the
/// edges' vertex1, vertex2 skipped; other elements with vertex indices (tristrips) are refused. A
/// coordinate is the value of its declared type: `property float x` with the text "0.1" is the
/// float nearest to 0.1. `name` is used in messages. Throws as read_mesh does.
mesh parse_mesh_ply(std::string_view text, const std::string& name);

/// Reads a frame from the text of an OBJ file: `v`, `f` and `l`, a polyline whose parts are
/// edges (v, v/vt, v//vn, v/vt/vn, negative indices count back). The format's other keywords are
/// skipped; curves, surfaces and `call`, which stand for what a mesh would lack, and words that are
/// no keyword are refused. `name` is used in messages. Throws as read_mesh does.
mesh parse_mesh_obj(std::string_view text, const std::string& name);

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
