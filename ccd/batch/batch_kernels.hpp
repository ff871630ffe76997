// The floating-point stages of `exact` over SIMD packs, compiled once per instruction set.
//
// Internal. ccd/batch/batch_kernels.cpp is compiled several times, each time with other flags and
// another value of ERRBOUND_INSTRUCTION_SET, the namespace of its results. So that nothing compiled
// for a newer machine is ever called on an older one, what it includes may define no function that
// another file could share: tests/ccd/batch/instruction_sets_test.sh looks at its symbols.
#pragma once

#include <ccd/batch.hpp>
#include <ccd/explain.hpp>
#include <ccd/kind.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>

#include "ccd/batch/rounded_positions.hpp"

namespace ccd::detail {

/// How a stage fares in a stream of queries: where it does not pay it pauses.
struct stage_pause {
    std::size_t poor_blocks = 0;     ///< of which it decided too few, in a row
    std::size_t blocks_to_pass = 0;  ///< before it is asked again
};

/// Axes are asked in floats where there are rounded positions, else, or where they decide too
/// little, in doubles.
struct axes_pauses {
    stage_pause in_floats, in_doubles;
};

/// Within which distance features count as in contact, and the gaps in floats that are more. By
/// default contact itself. `collides` then says that they do touch.
struct distance_asked {
    double distance = 0;
    rounded_axes::least_gaps gaps = {};
};

/// Decide `count` queries in floating point: `uncertain` in answers[i] leaves the query to exact
/// arithmetic. Indexed coordinates must be finite; stored queries that are not are `uncertain`.
/// `report` may be null. No allocation; some 300 KB of stack.
template <kind K>
struct kernels_of_kind {
    using pair = typename kind_traits<K>::pair;
    using query = typename kind_traits<K>::template query<double>;

    void (*indexed)(const batch_positions& positions, const pair* queries, std::size_t count,
                    const distance_asked& within, outcome* answers, axes_pauses& pauses,
                    stage_report* report);
    void (*stored)(const query* queries, std::size_t count, outcome* answers, axes_pauses& pauses,
                   stage_report* report);
    /// The first times of queries that collide: between low[i] and high[i], which are neighbours,
    /// or NaN where that was not found out.
    void (*indexed_times)(const batch_positions& positions, const pair* queries, std::size_t count,
                          double* low, double* high);
    void (*stored_times)(const query* queries, std::size_t count, double* low, double* high);
};
struct batch_kernels {
    kernels_of_kind<kind::vertex_face> vertex_face;
    kernels_of_kind<kind::edge_edge> edge_edge;
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

}  // namespace ccd::detail
