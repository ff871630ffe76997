// The floating-point stages of `exact` over SIMD packs, compiled once per instruction set.
//
// Internal. ccd/batch/batch_kernels.cpp is compiled several times, each time with other flags and
// another value of ERRBOUND_INSTRUCTION_SET, the namespace of its results. So that nothing compiled
// for a newer machine is ever called on an older one, that file may define no function that another
// could share: tests/ccd/batch/instruction_sets_test.sh looks at its symbols.
#pragma once

#include <ccd/batch.hpp>
#include <ccd/explain.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>

namespace ccd {

/// How a cull fares in a stream of queries: where it does not pay it pauses.
struct cull_state {
    std::size_t poor_blocks = 0;     ///< of which it settled too few, in a row
    std::size_t blocks_to_pass = 0;  ///< before it is tried again
};

/// The cull by fixed axes: in single precision where there are such positions, else, or where that
/// settles too little, in double.
struct axes_state {
    cull_state in_float, in_double;
};

/// Positions of a batch; `rounded` are those of ccd/batch/rounded_positions.hpp, or null.
struct batch_positions {
    vertex_rows exact;
    const float* rounded = nullptr;
};

/// Decides `count` queries in floating point: `uncertain` in answers[i] leaves the query to exact
/// arithmetic. `report` may be null. No allocation; some 300 KB of stack.
struct batch_kernels {
    void (*indexed_vertex_face)(const batch_positions& positions, const vertex_face_pair* queries,
                                std::size_t count, outcome* answers, axes_state& axes,
                                stage_report* report);
    void (*indexed_edge_edge)(const batch_positions& positions, const edge_edge_pair* queries,
                              std::size_t count, outcome* answers, axes_state& axes,
                              stage_report* report);
    void (*stored_vertex_face)(const vertex_face<double>* queries, std::size_t count,
                               outcome* answers, axes_state& axes, stage_report* report);
    void (*stored_edge_edge)(const edge_edge<double>* queries, std::size_t count, outcome* answers,
                             axes_state& axes, stage_report* report);
};

// Which of them there are is up to the build: ERRBOUND_HAVE_X86_KERNELS.
namespace baseline {
extern const batch_kernels kernels;
}
namespace avx2 {
extern const batch_kernels kernels;
}
namespace avx512 {
extern const batch_kernels kernels;
}

}  // namespace ccd
