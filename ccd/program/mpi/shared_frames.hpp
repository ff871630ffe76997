// Two frames of a mesh, in files of which each rank reads a share.
#pragma once

#include <ccd/mpi.hpp>
#include <cstddef>
#include <filesystem>
#include <vector>

#include "ccd/mpi/exchange.hpp"

namespace ccd::program {

/// A rank's elements. `numbers` are the indices of vertices in the files.
struct shared_frames {
    std::vector<mpi::vertex_number> numbers;
    std::vector<point<double>> before, after;
    std::vector<face> faces;
    std::vector<edge> edges;
    std::size_t vertices = 0, unused = 0;  ///< of the whole mesh; `unused` have no face or edge

    mpi::mesh_part part() const { return {numbers, {before, after}, faces, edges}; }
};

/// Collective. Errors of read_mesh_share and require_same_topology are thrown on all ranks.
shared_frames read_shared_frames(mpi::detail::exchanger& ranks, const std::filesystem::path& before,
                                 const std::filesystem::path& after);

}  // namespace ccd::program
