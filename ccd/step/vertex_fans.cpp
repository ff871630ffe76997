#include "ccd/step/vertex_fans.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <errbound/predicates.hpp>
#include <numeric>

#include "ccd/step/elements.hpp"

namespace ccd::detail {

vertex_fans::vertex_fans(std::span<const face> elements, std::size_t vertices)
    : kinds_(vertices, around::one), starts_(vertices + 1) {
    for (const face& f : elements) for_each_vertex(f, [&](vertex_index v) { ++starts_[v + 1]; });
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    std::vector<corner> corners(starts_.back());
    std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
    for (const face& f : elements) {
        if (is_triangle(f))
            for (std::size_t k = 0; k < 3; ++k)
                corners[next[f[k]]++] = {f[(k + 1) % 3], f[(k + 2) % 3]};
        else
            for_each_vertex(f, [&](vertex_index v) { corners[next[v]++] = {v, v}; });
    }
    ring_.resize(corners.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, vertices, 1024), [&](const auto& range) {
        for (std::size_t v = range.begin(); v < range.end(); ++v) {
            const std::size_t begin = starts_[v], count = starts_[v + 1] - begin;
            if (count > 1)
                kinds_[v] = kind_of_corners(std::span(corners).subspan(begin, count),
                                            std::span(ring_).subspan(begin, count));
        }
    });
}

vertex_fans::around vertex_fans::kind_of_corners(std::span<corner> corners,
                                                 std::span<vertex_index> ring) const {
    std::ranges::sort(corners, {}, &corner::from);
    if (std::ranges::adjacent_find(corners, {}, &corner::from) != corners.end())
        return around::others;
    std::size_t at = 0;
    for (vertex_index& w : ring) {
        w = corners[at].from;
        const auto next = std::ranges::lower_bound(corners, corners[at].to, {}, &corner::from);
        if (next == corners.end() || next->from != corners[at].to) return around::others;
        at = static_cast<std::size_t>(next - corners.begin());
        if (at == 0) return &w == &ring.back() ? around::fan : around::others;
    }
    return around::others;
}

bool vertex_fans::is_flat_fan(vertex_index v, const double* positions) const {
    using errbound::sign_type;
    using coordinate = errbound::filters::filtered_coordinate<double>;
    const std::span ring = std::span(ring_).subspan(starts_[v], starts_[v + 1] - starts_[v]);
    const auto at = [positions](vertex_index w) {
        const double* x = positions + 3 * std::size_t(w);
        return std::array{coordinate{x[0]}, coordinate{x[1]}, coordinate{x[2]}};
    };
    const auto centre = at(v);
    const auto turns_once_along = [&](int i, int j) {
        const auto level = static_cast<std::size_t>(j);
        auto from = at(ring.back());
        sign_type sign = sign_type::uncertain;
        int turns = 0;
        for (const vertex_index w : ring) {
            const auto to = at(w);
            const sign_type area = sign_of(errbound::forms::area(from, to, centre, i, j));
            if (sign == sign_type::uncertain) sign = area;
            if (area != sign || area == sign_type::zero || area == sign_type::uncertain)
                return false;
            // Both directions cross the half-line from v along axis i once in each turn.
            turns +=
                from[level].value < centre[level].value && to[level].value >= centre[level].value;
            from = to;
        }
        return turns == 1;
    };
    return turns_once_along(0, 1) || turns_once_along(1, 2) || turns_once_along(2, 0);
}

}  // namespace ccd::detail
