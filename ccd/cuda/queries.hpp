// Reads positions and candidates as include/ccd/cuda.hpp describes them. Internal.
#pragma once

#include <ccd/batch.hpp>
#include <ccd/cuda.hpp>
#include <ccd/kind.hpp>
#include <cstddef>
#include <cstdint>

namespace ccd::cuda::detail {

/// Sixteen bytes, read by one instruction if possible.
template <class T>
constexpr T load_aligned(const T* p) {
    static_assert(sizeof(T) == 16);
#ifdef __CUDA_ARCH__
    const uint4 bits = __ldg(reinterpret_cast<const uint4*>(p));
    T x;
    __builtin_memcpy(&x, &bits, sizeof x);
    return x;
#else
    return *p;
#endif
}

template <class Pair>
constexpr Pair pair_at(const candidates<Pair>& c, std::uint32_t i) {
    if (c.numbers != nullptr) i = c.numbers[i];
    if (c.of_rows != nullptr) return load_aligned(c.of_rows + i);
    if (c.elements == nullptr)
        return {c.columns[0][i], c.columns[1][i], c.columns[2][i], c.columns[3][i]};
    const auto& second = c.elements[c.columns[1][i]];
    if constexpr (kind_traits<kind_of<Pair>>::first_vertices == 1) {
        return {c.columns[0][i], second[0], second[1], second[2]};
    } else {
        const auto& first = c.elements[c.columns[0][i]];
        return {first[0], first[1], second[0], second[1]};
    }
}

/// Coordinate `axis` of a vertex in one of the two frames; double holds floats exactly.
constexpr double coordinate_at(const positions& p, const positions::frame& frame, std::size_t axis,
                               vertex_index vertex) {
    const std::size_t place = frame.stride * vertex;
    return p.in_floats ? double(static_cast<const float*>(frame.axis[axis])[place])
                       : static_cast<const double*>(frame.axis[axis])[place];
}

/// A query's points, in T: double, or float where positions are in floats.
template <class T, class Pair>
constexpr query_of_pair<Pair, T> query_at(const positions& p, const Pair& pair) {
    const auto at = [&](const positions::frame& frame, vertex_index v) {
        const auto coordinate = [&](std::size_t axis) {
            return static_cast<T>(coordinate_at(p, frame, axis, v));
        };
        return point<T>{coordinate(0), coordinate(1), coordinate(2)};
    };
    const auto moving = [&](vertex_index v) {
        return moving_point<T>{at(p.before, v), at(p.after, v)};
    };
    const auto [a, b, c, d] = vertices_of(pair);
    return {moving(a), moving(b), moving(c), moving(d)};
}

}  // namespace ccd::cuda::detail
