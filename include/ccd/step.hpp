// One step of a mesh: from two frames in memory to the colliding pairs.
#pragma once

#include <ccd/batch.hpp>
#include <ccd/mesh.hpp>
#include <ccd/method.hpp>
#include <cstddef>
#include <optional>
#include <vector>

namespace ccd {

struct step_options {
    ccd::method method = ccd::method::exact;
    int threads = 0;  ///< at most; 0 or less, or more than the machine has cores: one per core
    std::optional<instruction_set> set = {};  ///< for `exact`; by default the strongest
    bool explain = false;                     ///< fill step_result::stages; other methods have none
};

struct step_result {
    std::size_t vertex_face_candidates = 0;  ///< pairs whose swept boxes touch, no shared vertex
    std::size_t edge_edge_candidates = 0;
    /// Reported pairs, sorted; the vertices of a face or an edge ascending, the lesser edge first.
    std::vector<vertex_face_pair> vertex_face;
    std::vector<edge_edge_pair> edge_edge;
    double prepare_seconds = 0;       ///< checks of the input, the mesh's edges
    double broad_phase_seconds = 0;   ///< both phases together, less the narrow phase
    double narrow_phase_seconds = 0;  ///< of all threads together, over their number
    double sort_seconds = 0;          ///< of the reported pairs
    double total_seconds = 0;
    int threads = 0;      ///< used at most
    stage_report stages;  ///< of `exact`, if asked for
};

/// The pairs of one step that `options.method` cannot certify as separate.
///
/// Candidates are the vertex/face and edge/edge pairs that share no vertex and whose swept boxes
/// (closed, exact doubles) touch. They are found by trees over the boxes and decided block by
/// block, never stored as a whole. The result is the same for every number of threads. Memory
/// beside it: about one and a half times that of the two frames, or two and a half where parts of
/// the mesh are so far apart that floats do not tell their elements' boxes apart.
///
/// `before` and `after` must have the same faces and numbers of vertices, all indices in range and
/// all coordinates finite; throws std::invalid_argument otherwise, or if options.set is not of
/// instruction_sets().
step_result step(const mesh& before, const mesh& after, const step_options& options = {});

}  // namespace ccd
