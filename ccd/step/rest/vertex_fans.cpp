#include "ccd/step/rest/vertex_fans.hpp"

#include <algorithm>
#include <cmath>
#include <errbound/predicates.hpp>
#include <utility>

#include "ccd/batch/threads.hpp"

namespace ccd::detail {

vertex_fans::vertex_fans(std::span<const face> elements, std::size_t vertices)
    : kinds_(vertices, around::one), starts_(vertices + 1) {
    // Room for one more vertex than corners.
    for (const face& f : elements) for_each_vertex(f, [&](vertex_index v) { ++starts_[v + 1]; });
    for (std::size_t v = 0; v < vertices; ++v) starts_[v + 1] += starts_[v] + 1;
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
    for_each_range(vertices, 1024, [&](std::size_t least, std::size_t end) {
        for (std::size_t v = least; v < end; ++v) {
            const std::size_t begin = starts_[v], count = next[v] - begin;
            if (count > 1)
                kinds_[v] = kind_of_corners(std::span(corners).subspan(begin, count),
                                            std::span(ring_).subspan(begin, count + 1));
        }
    });
}

/// The frequent case: few corners that form a closed fan.
bool vertex_fans::are_closed(std::span<corner> corners, std::span<vertex_index> ring) {
    constexpr std::size_t few = 16;
    if (corners.size() > few) return false;
    vertex_index at = corners[0].from;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        // All are tested, since the position of the next one is not predictable.
        std::size_t next = i, matches = 0;
        for (std::size_t j = i; j < corners.size(); ++j) {
            const bool is_next = corners[j].from == at;
            next = is_next ? j : next;
            matches += is_next;
        }
        if (matches != 1) return false;
        std::swap(corners[i], corners[next]);
        ring[i] = at;
        at = corners[i].to;
    }
    ring.back() = at;
    return at == ring.front();
}

vertex_fans::around vertex_fans::kind_of_corners(std::span<corner> corners,
                                                 std::span<vertex_index> ring) {
    if (are_closed(corners, ring)) return around::closed_fan;
    std::ranges::sort(corners, {}, &corner::from);
    if (std::ranges::adjacent_find(corners, {}, &corner::from) != corners.end())
        return around::others;
    // Begin with the corner that follows no other, if there is one.
    const std::span ends = ring.first(corners.size());
    std::ranges::transform(corners, ends.begin(), &corner::to);
    std::ranges::sort(ends);
    const auto first = std::ranges::find_if(
        corners, [&](const corner& c) { return !std::ranges::binary_search(ends, c.from); });
    const vertex_index begin = first == corners.end() ? corners[0].from : first->from;
    vertex_index at = begin;
    for (vertex_index& w : ends) {
        const auto next = std::ranges::lower_bound(corners, at, {}, &corner::from);
        if (next == corners.end() || next->from != at || (at == begin && &w != &ends.front()))
            return around::others;
        w = at;
        at = next->to;
    }
    ring.back() = at;
    if (at == begin) return around::closed_fan;
    return std::ranges::binary_search(corners, at, {}, &corner::from) ? around::others
                                                                      : around::open_fan;
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
    const auto turns_at_most_once = [&](int i, int j) {
        const auto order = [&](const auto& p, int axis) {
            const auto k = static_cast<std::size_t>(axis);
            return int{p[k].value > centre[k].value} - int{p[k].value < centre[k].value};
        };
        auto from = at(ring[0]);
        int x = order(from, i), y = order(from, j);
        sign_type sign = sign_type::zero;
        int turns = 0;
        unsigned not_met = 15;  // of the four half-lines from v along the axes
        for (const vertex_index w : ring.subspan(1)) {
            const auto to = at(w);
            const sign_type area = sign_of(errbound::forms::area(from, to, centre, i, j));
            if (sign == sign_type::zero) sign = area;
            if (area != sign || area == sign_type::zero || area == sign_type::uncertain)
                return false;
            const int to_x = order(to, i), to_y = order(to, j);
            // In both directions, each turn crosses the half-line x > 0 = y upwards or downwards
            // once, and the half-line x < 0 = y in the opposite direction.
            turns += y < 0 && to_y >= 0;
            not_met &= ~(unsigned(y <= 0 && to_y >= 0) | unsigned(y >= 0 && to_y <= 0) << 1 |
                         unsigned(x <= 0 && to_x >= 0) << 2 | unsigned(x >= 0 && to_x <= 0) << 3);
            from = to, x = to_x, y = to_y;
        }
        return kinds_[v] == around::closed_fan ? turns == 1 : not_met != 0;
    };
    // First along the axis on which the projection of the first face is largest.
    const auto first = at(ring[0]), second = at(ring[1]);
    int best = 0;
    double largest = -1;
    for (int i = 0; i < 3; ++i) {
        const double area =
            std::abs(errbound::forms::area(first, second, centre, i, (i + 1) % 3).value);
        if (area > largest) best = i, largest = area;
    }
    for (int k = best; k < best + 3; ++k)
        if (turns_at_most_once(k % 3, (k + 1) % 3)) return true;
    return false;
}

}  // namespace ccd::detail
