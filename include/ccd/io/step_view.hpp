// Steps to look at (target errbound::ccd_io): a page for any browser, and files for ParaView.
#pragma once

#include <ccd/batch.hpp>
#include <ccd/mesh.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace ccd::io {

/// What is shown of a step. Not owned.
struct step_view {
    vertex_rows positions;
    std::span<const face> faces;
    std::span<const edge> edges;  ///< those beside the faces' own, as a mesh has them
    const pair_lists& pairs;
    const time_lists& times;  ///< of the pairs, or empty: unknown
};

/// A page of HTML, whole in itself, that fetches nothing: the mesh at every time of the step, to
/// turn, move and zoom with mouse, fingers or keys, its pairs, and a list of them, each with its
/// time, weights and normal, and as a query in numbers that read back exactly. Needs a browser with
/// WebGL 2.
///
/// Size: 65 bytes a vertex and 16 a face, and 22 a pair, or 80 with times. Cost: a contact's data
/// for each pair with a time. Throws
/// std::invalid_argument if an index is out of range, or times are neither none nor as many as
/// pairs.
std::string page_of(const step_view& step);

/// One of the two frames.
enum class frame : std::uint8_t { before, after };

/// One frame as VTK's XML PolyData, binary, coordinates bit for bit: points on no edge, edges, and
/// faces, each in the order given, and a vertex cell for each pair, in the order of `pairs` by
/// kind, where it first touches, or where that is unknown in the middle of its vertices.
///
/// Of points: `displacement`, from t = 0 to 1; `normal`, of contacts, as ccd/contact.hpp has
/// it, else 0. Of cells: `pairs`, in how many pairs one of its vertices, edges or itself is;
/// `toi`, when the earliest of these is there (`low`), NaN where none is or times are unknown;
/// `pair`, which it is, or -1; `kind`, as ccd::kind numbers it, or -1. The frame's time, 0 or 1, is
/// the field TimeValue.
///
/// Cost: a contact's data for each pair with a time. Throws as page_of does.
std::string vtp_of(const step_view& step, frame shown);

/// An entry of a series: a file, its path from the series' folder, and its time.
struct series_entry {
    double time = 0;
    std::string file;
};

/// A series of files as ParaView's PVD. Throws std::invalid_argument if a time is not finite or a
/// name has a control character, which XML cannot hold.
std::string pvd_of(std::span<const series_entry> series);

}  // namespace ccd::io
