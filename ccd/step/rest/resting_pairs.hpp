// Pairs in contact at rest, which a mesh keeps from step to step. A step in which their vertices
// still rest need not search for them.
#pragma once

#include <algorithm>
#include <ccd/step.hpp>
#include <cstddef>
#include <cstring>
#include <vector>

#include "ccd/step/rest/kept_positions.hpp"

namespace ccd::detail {

class resting_pairs {
  public:
    /// Lists the vertices that do not rest: see kept_positions::find_moving. Returns false also if
    /// no step was kept for this filter.
    bool find_moving(const vertex_rows& way, const pair_filter& filter) {
        if (skip_unused_ != filter.skip_unused) positions_.forget();
        skip_unused_ = filter.skip_unused;
        return positions_.find_moving(way);
    }
    const kept_positions& positions() const { return positions_; }
    kept_positions& positions() { return positions_; }

    /// Returns the pairs without an active vertex. Among all such pairs of the mesh, they include
    /// those in contact.
    template <kind K>
    std::vector<pair_of_kind<K>> at_rest() const {
        std::vector<pair_of_kind<K>> found;
        for (const auto& pair : pairs_.of<K>())
            if (std::ranges::none_of(vertices_of(pair),
                                     [&](auto v) { return positions_.is_active(v); }))
                found.push_back(pair);
        return found;
    }

    /// Keeps the end of a step in which a vertex rests, after find_moving(way, ...). `pairs` are
    /// all pairs that are in contact in [0, 1].
    void keep(const vertex_rows& way, const pair_lists& pairs) {
        if (!any_rests(way)) return;
        positions_.keep(way);
        pairs_ = pairs;
    }

  private:
    static bool any_rests(const vertex_rows& way) {
        constexpr std::size_t size = 3 * sizeof(double);
        for (std::size_t v = 0; v < way.vertices; ++v)
            if (std::memcmp(&way.before[3 * v], &way.after[3 * v], size) == 0) return true;
        return false;
    }

    kept_positions positions_;
    pair_lists pairs_;
    bool skip_unused_ = false;
};

}  // namespace ccd::detail
