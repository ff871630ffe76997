// The results of errbound/simplices/relation.hpp and errbound/simplices/common_segment.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace errbound {

/// How two closed simplices meet.
enum class relation : std::uint8_t {
    /// They share no point outside their common simplex.
    disjoint,
    /// They share such a point, but neither overlap nor cross: a vertex is on a face, an edge is in
    /// a face's plane, or two points are equal. Arbitrarily small motions separate them.
    touching,
    /// Their relative interiors meet, and both span the same line or plane: coplanar faces that
    /// share an area, collinear edges that share a length.
    overlapping,
    /// Their relative interiors meet, and together they span the space: an edge passes through the
    /// interior of a face and leaves on both sides, or two edges cross in the plane. Sufficiently
    /// small motions do not separate them.
    crossing,
};

constexpr std::string_view name(relation r) {
    constexpr std::string_view names[] = {"disjoint", "touching", "overlapping", "crossing"};
    return names[static_cast<std::size_t>(r)];
}

/// A point known up to rounding.
template <std::size_t D>
struct located_point {
    std::array<double, D> position;
    double error;  ///< bounds the error of each coordinate
};

}  // namespace errbound
