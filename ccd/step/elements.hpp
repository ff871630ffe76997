// Elements and pairs, for the searches for candidates on hosts and devices.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/kind.hpp>
#include <ccd/mesh.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

namespace ccd::detail {

template <std::size_t A, std::size_t B>
constexpr bool share_vertex(const std::array<vertex_index, A>& a,
                            const std::array<vertex_index, B>& b) {
    bool shared = false;
    for (const vertex_index v : a)
        for (const vertex_index w : b) shared |= v == w;
    return shared;
}

/// The vertices of a face keep the mesh's order.
constexpr vertex_face_pair candidate_of(const std::array<vertex_index, 1>& v, const face& f) {
    return {v[0], f[0], f[1], f[2]};
}
/// Precondition: edges ascend. The one with the lesser first vertex comes first.
constexpr edge_edge_pair candidate_of(const edge& a, const edge& b) {
    const bool in_order = a[0] < b[0];
    const edge &x = in_order ? a : b, &y = in_order ? b : a;
    return {x[0], x[1], y[0], y[1]};
}
constexpr vertex_edge_pair candidate_of(const std::array<vertex_index, 1>& v, const edge& e) {
    return {v[0], e[0], e[1]};
}
/// The lesser vertex comes first.
constexpr vertex_vertex_pair candidate_of(const std::array<vertex_index, 1>& v,
                                          const std::array<vertex_index, 1>& w) {
    return {v[0] < w[0] ? v[0] : w[0], v[0] < w[0] ? w[0] : v[0]};
}

/// Returns a candidate in the reported order: the vertices of a face ascend. (All else is in order
/// already.)
template <class Pair>
constexpr Pair canonical(const Pair& pair) {
    if constexpr (kind_of<Pair> == kind::vertex_face) {
        std::array<vertex_index, 3> f{pair.f0, pair.f1, pair.f2};
        std::ranges::sort(f);
        return {pair.v, f[0], f[1], f[2]};
    } else {
        return pair;
    }
}

/// Spreads ten bits, or 21 bits below, with two zeros before each, for a key on a Morton curve.
constexpr std::uint32_t spread_bits(std::uint32_t x) {
    x = (x | (x << 16)) & 0x030000FF;
    x = (x | (x << 8)) & 0x0300F00F;
    x = (x | (x << 4)) & 0x030C30C3;
    return (x | (x << 2)) & 0x09249249;
}
constexpr std::uint64_t spread_bits(std::uint64_t x) {
    x = (x | (x << 32)) & 0x001F00000000FFFF;
    x = (x | (x << 16)) & 0x001F0000FF0000FF;
    x = (x | (x << 8)) & 0x100F00F00F00F00F;
    x = (x | (x << 4)) & 0x10C30C30C30C30C3;
    return (x | (x << 2)) & 0x1249249249249249;
}

/// Precondition: both are sorted.
template <class Item>
std::vector<Item> without(const std::vector<Item>& items, const std::vector<Item>& others) {
    std::vector<Item> rest;
    std::ranges::set_difference(items, others, std::back_inserter(rest));
    return rest;
}

/// Adds a pair that first touches at this time to result.first_pairs, unless others touch before.
template <class Pair, class Result>
void add_first(const first_time& time, const Pair& pair, Result& result) {
    first_time& first = result.first_contact;
    if (first.outcome == outcome::collides) {
        if (std::pair(first.low, first.high) < std::pair(time.low, time.high)) return;
        if (first != time) result.first_pairs = {};
    }
    first = time;
    result.first_pairs.template of<kind_of<Pair>>().push_back(pair);
}

}  // namespace ccd::detail
