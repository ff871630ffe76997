#include "examples/simulation/collision/neighbours.hpp"

#include <algorithm>

namespace simulation {
namespace {

ccd::edge sorted(vertex_index a, vertex_index b) {
    return {std::min(a, b), std::max(a, b)};
}

}  // namespace

neighbours::neighbours(const std::vector<ccd::face>& faces, const std::vector<ccd::edge>& edges,
                       std::size_t vertices)
    : of_vertex_(vertices) {
    for (const ccd::face& f : faces)
        for (std::size_t i = 0; i < 3; ++i)
            of_edge_[sorted(f[i], f[(i + 1) % 3])].push_back(f[(i + 2) % 3]);
    for (const ccd::edge& e : edges) of_edge_[sorted(e[0], e[1])];
    for (const auto& [edge, third] : of_edge_)
        for (std::size_t i = 0; i < 2; ++i) of_vertex_[edge[i]].push_back(edge[1 - i]);
}

std::span<const vertex_index> neighbours::around(std::span<const vertex_index> feature) const {
    if (feature.size() == 1) return of_vertex_[feature[0]];
    if (feature.size() == 2) return of_edge_.at(sorted(feature[0], feature[1]));
    return {};
}

bool neighbours::next_to(vertex_index v, std::span<const vertex_index> feature) const {
    return std::ranges::any_of(feature, [&](vertex_index w) {
        return v == w || std::ranges::count(of_vertex_[w], v) > 0;
    });
}

bool neighbours::nearest_of_surface(std::span<const vertex_index> feature, const vec3& on,
                                    const vec3& from, std::span<const vertex_index> other,
                                    const rows& positions) const {
    constexpr double rounding = 1e-6;
    const vec3 up = from - on;
    return std::ranges::none_of(around(feature), [&](vertex_index v) {
        const vec3 along = positions.row(v).transpose() - on;
        return up.dot(along) > rounding * up.norm() * along.norm() && !next_to(v, other);
    });
}

}  // namespace simulation
