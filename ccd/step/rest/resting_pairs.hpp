// Pairs in contact at rest, which a mesh keeps from step to step. A step in which their vertices
// still rest need not search for them.
#pragma once

#include <algorithm>
#include <ccd/step.hpp>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace ccd::detail {

class resting_pairs {
  public:
    /// Returns a flag for each vertex: 0 if its positions at both ends of the step are those at the
    /// end of the kept one, bit for bit. Returns no flags if no step was kept for this filter.
    std::vector<std::uint8_t> moving(const vertex_rows& way, const pair_filter& filter) const {
        if (positions_.size() != way.vertices || skip_unused_ != filter.skip_unused) return {};
        std::vector<std::uint8_t> flags(way.vertices);
        for (std::size_t v = 0; v < way.vertices; ++v)
            flags[v] = differ(&way.before[3 * v], &way.after[3 * v]) ||
                       differ(&way.before[3 * v], &positions_[v].x);
        return flags;
    }

    /// Returns the pairs without a moving vertex. Among all such pairs of the mesh, they include
    /// those in contact.
    template <kind K>
    std::vector<pair_of_kind<K>> at_rest(std::span<const std::uint8_t> moving) const {
        std::vector<pair_of_kind<K>> found;
        for (const auto& pair : pairs_.of<K>())
            if (std::ranges::none_of(vertices_of(pair), [&](auto v) { return moving[v] != 0; }))
                found.push_back(pair);
        return found;
    }

    /// Keeps the end of a step in which a vertex rests. `pairs` are all pairs that are in contact
    /// in [0, 1].
    void keep(const vertex_rows& way, const pair_filter& filter, const pair_lists& pairs) {
        bool any_rests = false;
        for (std::size_t v = 0; v < way.vertices && !any_rests; ++v)
            any_rests = !differ(&way.before[3 * v], &way.after[3 * v]);
        if (!any_rests) return;
        pairs_ = pairs;
        positions_.resize(way.vertices);
        for (vertex_index v = 0; v < way.vertices; ++v) positions_[v] = way[v].t1;
        skip_unused_ = filter.skip_unused;
    }

  private:
    static bool differ(const double* p, const double* q) {
        return std::memcmp(p, q, sizeof(point<double>)) != 0;
    }

    std::vector<point<double>> positions_;
    pair_lists pairs_;
    bool skip_unused_ = false;
};

}  // namespace ccd::detail
