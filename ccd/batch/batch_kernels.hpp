// The floating-point stages of `exact` over SIMD packs, compiled once per instruction set.
//
// Internal. batch_kernels.cpp is compiled several times, with different flags and values of
// ERRBOUND_INSTRUCTION_SET, the namespace of its results. Its includes must not define functions
// that another file could share: no code for a newer machine may run on an older one.
// tests/ccd/batch/instruction_sets_test.sh checks its symbols.
#pragma once

#include <ccd/explain.hpp>
#include <ccd/kind.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>

#include "ccd/batch/rounded_positions.hpp"

namespace ccd::detail {

/// A stage pauses while it decides too few queries of a stream.
struct stage_pause {
    std::size_t poor_blocks = 0;     ///< successive blocks with too few decisions
    std::size_t blocks_to_pass = 0;  ///< blocks to skip before it runs again
};

/// Axes are tested in doubles if there are no rounded positions or floats decide too few queries.
struct axes_pauses {
    stage_pause in_floats, in_doubles;
};

/// The distance that counts as contact, and the gaps in floats that prove a larger one. `collides`
/// is certain only for the default distance 0.
struct distance_request {
    double distance = 0;
    rounded_axes::least_gaps gaps = {};
};

/// Functions that decide `count` queries in floating point; `uncertain` in answers[i] leaves the
/// query to exact arithmetic. Precondition: coordinates of `positions` are finite. Queries by value
/// that are not finite are `uncertain`. `report` may be null. No allocation; some 300 KB of stack.
template <kind K>
struct kernels_of_kind {
    using pair = typename kind_traits<K>::pair;
    using query = typename kind_traits<K>::template query<double>;

    void (*indexed)(const batch_positions& positions, const pair* queries, std::size_t count,
                    const distance_request& within, outcome* answers, axes_pauses& pauses,
                    stage_report* report);
    void (*stored)(const query* queries, std::size_t count, outcome* answers, axes_pauses& pauses,
                   stage_report* report);
    /// Compute the brackets low[i], high[i] of the first times of colliding queries; NaN if
    /// undecided.
    void (*indexed_times)(const batch_positions& positions, const pair* queries, std::size_t count,
                          double* low, double* high);
    void (*stored_times)(const query* queries, std::size_t count, double* low, double* high);
};
struct batch_kernels {
    kernels_of_kind<kind::vertex_face> vertex_face;
    kernels_of_kind<kind::edge_edge> edge_edge;

    template <kind K>
    constexpr const kernels_of_kind<K>& of() const {
        if constexpr (K == kind::vertex_face)
            return vertex_face;
        else
            return edge_edge;
    }
};

// avx2 and avx512 need ERRBOUND_HAVE_X86_KERNELS.
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
