// Unique edges and faces: each goes to the bucket of its lowest vertex, which leaves only short
// runs to sort.
#include <algorithm>
#include <ccd/mesh.hpp>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "ccd/step/buckets.hpp"
#include "ccd/step/vertex_groups.hpp"

namespace ccd {
namespace {

template <std::size_t N>
vertex_index largest(std::span<const std::array<vertex_index, N>> elements) {
    vertex_index last = 0;
    for (const auto& e : elements)
        for (const vertex_index v : e) last = std::max(last, v);
    return last;
}

/// A face's vertices, ascending, and its number: equal faces follow each other, the first one
/// first.
struct numbered_face {
    vertex_index low, middle, high, number;
    friend auto operator<=>(const numbered_face&, const numbered_face&) = default;

    numbered_face() = default;
    numbered_face(const face& f, std::size_t i)
        : low(std::min({f[0], f[1], f[2]})),
          high(std::max({f[0], f[1], f[2]})),
          number(static_cast<vertex_index>(i)) {
        middle = f[0] ^ f[1] ^ f[2] ^ low ^ high;
    }
    bool repeats(const numbered_face& other) const {
        return low == other.low && middle == other.middle && high == other.high;
    }
};

}  // namespace

std::vector<edge> unique_edges(std::span<const face> faces, std::span<const edge> edges) {
    const auto for_each_edge = [&](const auto& visit) {
        const auto take = [&visit](vertex_index v, vertex_index w) {
            if (v != w) visit(std::min(v, w), edge{std::min(v, w), std::max(v, w)});
        };
        for (const face& f : faces)
            for (std::size_t k = 0; k < 3; ++k) take(f[k], f[(k + 1) % 3]);
        for (const edge& e : edges) take(e[0], e[1]);
    };
    detail::buckets<edge> all(3 * faces.size() + edges.size(),
                              std::max(largest(faces), largest(edges)), for_each_edge);
    all.items.resize(all.end.back());
    all.for_each_bucket([](std::span<edge> bucket) { std::ranges::sort(bucket); });
    std::vector<edge> unique = std::move(all.items);
    unique.erase(std::unique(unique.begin(), unique.end()), unique.end());
    unique.shrink_to_fit();
    return unique;
}

std::vector<face> unique_faces(std::span<const face> faces) {
    detail::buckets<numbered_face> all(faces.size(), largest(faces), [&](const auto& visit) {
        for (std::size_t i = 0; i < faces.size(); ++i) {
            const numbered_face f(faces[i], i);
            visit(f.low, f);
        }
    });
    std::vector<std::uint8_t> repeated(faces.size());
    all.for_each_bucket([&](std::span<numbered_face> bucket) {
        if (bucket.size() < 2) return;
        std::ranges::sort(bucket);
        for (std::size_t i = 1; i < bucket.size(); ++i)
            if (bucket[i].repeats(bucket[i - 1])) repeated[bucket[i].number] = 1;
    });
    std::vector<face> unique;
    unique.reserve(faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i)
        if (!repeated[i]) unique.push_back(faces[i]);
    return unique;
}

std::vector<int> connected_parts(std::span<const face> faces, std::span<const edge> edges,
                                 std::size_t vertices) {
    detail::vertex_groups groups(vertices);
    for (const face& f : faces)
        for (const vertex_index v : f) groups.join(f[0], v);
    for (const edge& e : edges) groups.join(e[0], e[1]);
    std::vector<int> part_of(vertices), part_of_root(vertices, -1);
    int parts = 0;
    for (vertex_index v = 0; v < vertices; ++v) {
        int& part = part_of_root[groups.root_of(v)];
        if (part < 0) part = parts++;
        part_of[v] = part;
    }
    return part_of;
}

}  // namespace ccd
