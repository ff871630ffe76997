// Views of steps (target errbound::ccd_io): a page for any browser, and files for ParaView.
#pragma once

#include <ccd/batch.hpp>
#include <ccd/bodies/steps.hpp>
#include <ccd/mesh.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace ccd::io {

struct step_view {
    vertex_rows positions;
    std::span<const face> faces;
    std::span<const edge> edges;  ///< other than those of faces, as in a mesh
    const pair_lists& pairs;
    const time_lists& times;                           ///< of the pairs, or empty if unknown
    std::span<const intersection> intersections = {};  ///< at the start, for page_of
};

/// Returns a page of HTML that fetches nothing and needs WebGL 2. It shows the mesh and its pairs
/// at every time of the step, to turn, move and zoom with mouse, fingers or keys. A list has each
/// pair's time, weights and normal, and the pair as a query in numbers that read back exactly. It
/// also has the intersections at the start, with relations and common segments.
///
/// Size: 65 bytes a vertex and 16 a face, and 22 a pair, or 80 with times. Cost: contact_at for
/// each pair with a time. Throws std::invalid_argument if an index is out of range, or if there are
/// times but not one a pair.
std::string page_of(const step_view& step);

/// The same page for bodies, which turn. It has no weights and normals of contacts. Preconditions:
/// `found` is a result of `steps` for these motions.
std::string page_of(const body_steps& steps, std::span<const body_motion> motions,
                    const body_step_result& found);

enum class frame : std::uint8_t { before, after };

/// Returns one frame as VTK's XML PolyData, binary, with coordinates bit for bit. Cells are points
/// on no edge, edges and faces, each in the given order. A vertex cell for each pair follows, by
/// kind in the order of `pairs`: the first contact point, or the middle of the pair's vertices if
/// the contact is unknown.
///
/// Arrays of points: `displacement` from t = 0 to 1; `normal` of contacts (ccd/contact.hpp), else
/// 0. Arrays of cells: `pairs`, the number of pairs of the cell, its edges and its vertices; `toi`,
/// the lowest `low` of these pairs, or NaN; `pair`, the index of a pair's own cell, or -1; `kind`,
/// the number of its ccd::kind, or -1. The field TimeValue is the frame's time, 0 or 1. Cost and
/// exceptions: as page_of.
std::string vtp_of(const step_view& step, frame shown);

/// A file of a series: its time, and its path from the series' folder.
struct series_entry {
    double time = 0;
    std::string file;
};

/// Returns a series as ParaView's PVD. Throws std::invalid_argument if a time is not finite or a
/// name has a control character, which XML cannot hold.
std::string pvd_of(std::span<const series_entry> series);

}  // namespace ccd::io
