// Unique edges and faces: sorted by their lowest vertices, so that equal ones are adjacent.
#include <algorithm>
#include <ccd/mesh.hpp>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "ccd/step/order/buckets.hpp"
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

constexpr std::uint64_t packed(vertex_index upper, vertex_index lower) {
    return std::uint64_t(upper) << 32 | lower;
}
constexpr vertex_index upper(std::uint64_t indices) {
    return static_cast<vertex_index>(indices >> 32);
}
constexpr vertex_index lower(std::uint64_t indices) {
    return static_cast<vertex_index>(indices);
}

/// A face's vertices, ascending, and its index. Equal faces are sorted by index.
struct numbered_face {
    std::uint64_t low_and_middle, high_and_number;
    friend auto operator<=>(const numbered_face&, const numbered_face&) = default;

    numbered_face() = default;
    numbered_face(const face& f, std::size_t i) {
        const vertex_index low = std::min({f[0], f[1], f[2]}), high = std::max({f[0], f[1], f[2]});
        low_and_middle = packed(low, f[0] ^ f[1] ^ f[2] ^ low ^ high);
        high_and_number = packed(high, static_cast<vertex_index>(i));
    }
    vertex_index number() const { return lower(high_and_number); }
    bool repeats(const numbered_face& other) const {
        return low_and_middle == other.low_and_middle &&
               upper(high_and_number) == upper(other.high_and_number);
    }
};

}  // namespace

std::vector<edge> unique_edges(std::span<const face> faces, std::span<const edge> edges) {
    const std::size_t shares = detail::shares_of(faces.size() + edges.size());
    const auto share_of = [shares](auto elements, std::size_t share) {
        const std::size_t begin = detail::begin_of_share(share, shares, elements.size());
        return elements.subspan(begin,
                                detail::begin_of_share(share + 1, shares, elements.size()) - begin);
    };
    const std::vector<std::uint64_t> all = detail::sorted_by_vertex<std::uint64_t>(
        shares, std::max(largest(faces), largest(edges)),
        [&](std::size_t share, const auto& visit) {
            const auto take = [&visit](vertex_index v, vertex_index w) {
                if (v != w) visit(packed(std::min(v, w), std::max(v, w)));
            };
            for (const face& f : share_of(faces, share))
                for (std::size_t k = 0; k < 3; ++k) take(f[k], f[(k + 1) % 3]);
            for (const edge& e : share_of(edges, share)) take(e[0], e[1]);
        },
        [](std::uint64_t e) { return upper(e); });
    const auto is_first = [&](std::size_t i) { return i == 0 || all[i] != all[i - 1]; };
    std::size_t count = 0;
    for (std::size_t i = 0; i < all.size(); ++i) count += is_first(i);
    std::vector<edge> unique;
    unique.reserve(count);
    for (std::size_t i = 0; i < all.size(); ++i)
        if (is_first(i)) unique.push_back({upper(all[i]), lower(all[i])});
    return unique;
}

std::vector<face> unique_faces(std::span<const face> faces) {
    const std::size_t shares = detail::shares_of(faces.size());
    const std::vector<numbered_face> all = detail::sorted_by_vertex<numbered_face>(
        shares, largest(faces),
        [&](std::size_t share, const auto& visit) {
            const std::size_t end = detail::begin_of_share(share + 1, shares, faces.size());
            for (std::size_t i = detail::begin_of_share(share, shares, faces.size()); i < end; ++i)
                visit(numbered_face(faces[i], i));
        },
        [](const numbered_face& f) { return upper(f.low_and_middle); });
    std::vector<vertex_index> repeated;
    for (std::size_t i = 1; i < all.size(); ++i)
        if (all[i].repeats(all[i - 1])) repeated.push_back(all[i].number());
    std::ranges::sort(repeated);
    std::vector<face> unique;
    unique.reserve(faces.size());
    std::size_t begin = 0;
    for (const vertex_index i : repeated) {
        unique.insert(unique.end(), faces.begin() + begin, faces.begin() + i);
        begin = i + 1;
    }
    unique.insert(unique.end(), faces.begin() + begin, faces.end());
    return unique;
}

std::vector<vertex_index> unused_vertices(std::span<const face> faces, std::span<const edge> edges,
                                          std::size_t vertices) {
    std::vector<bool> used(vertices);
    const auto use = [&](const auto& element) {
        for (const vertex_index v : element) used[v] = true;
    };
    std::ranges::for_each(faces, use);
    std::ranges::for_each(edges, use);
    std::vector<vertex_index> unused;
    for (vertex_index v = 0; v < vertices; ++v)
        if (!used[v]) unused.push_back(v);
    return unused;
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
