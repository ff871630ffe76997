// Two frames of a mesh in files that all ranks can read, each rank a share of them.
#pragma once

#include <ccd/mpi.hpp>
#include <cstddef>
#include <filesystem>
#include <vector>

#include "ccd/mpi/exchange.hpp"

namespace ccd::program {

/// A rank's part of a mesh, numbered by the vertices' indices in the files.
struct shared_frames {
    std::vector<mpi::vertex_number> numbers;
    std::vector<point<double>> before, after;
    std::vector<face> faces;
    std::vector<edge> edges;
    std::size_t vertices = 0, unused = 0;  ///< of the whole mesh; those on no face and no edge

    mpi::mesh_part part() const { return {numbers, {before, after}, faces, edges}; }
};

/// Each rank reads as many elements as another, and asks those that read the vertices of its faces
/// and edges for their positions. Collective; throws on all ranks what read_mesh_share and
/// require_same_topology throw on one.
shared_frames read_shared_frames(mpi::detail::exchanger& ranks, const std::filesystem::path& before,
                                 const std::filesystem::path& after);

}  // namespace ccd::program
