// Batches some of whose positions are not finite: only the finite queries are decided. Internal.
#pragma once

#include <algorithm>
#include <ccd/batch.hpp>
#include <ccd/kind.hpp>
#include <cstddef>

#include "ccd/exact/finite.hpp"

namespace ccd::detail {

template <class Pair>
bool has_finite_vertices(const vertex_rows& rows, const Pair& pair) {
    return std::ranges::all_of(vertices_of(pair), [&rows](vertex_index v) {
        return all_finite(rows.before + 3 * std::size_t(v), 3) &&
               all_finite(rows.after + 3 * std::size_t(v), 3);
    });
}

/// Calls decide(first, count) for the runs of finite queries; the others are uncertain.
template <class IsFinite, class Decide>
void decide_finite(std::size_t count, outcome* answers, bool all_are_finite,
                   const IsFinite& is_finite, const Decide& decide) {
    if (all_are_finite) {
        decide(std::size_t(0), count);
        return;
    }
    for (std::size_t first = 0, end = 0; first < count; first = end) {
        while (end < count && is_finite(end)) ++end;
        if (end > first) decide(first, end - first);
        if (end < count) answers[end++] = outcome::uncertain;
    }
}

}  // namespace ccd::detail
