// All predicates of errbound/predicates.hpp and errbound/simplices/predicates.hpp, each with its
// oracle and its degenerate surfaces.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <errbound/predicates.hpp>
#include <errbound/simplices/predicates.hpp>
#include <string_view>
#include <tuple>

#include "tests/errbound/predicates/predicate_inputs.hpp"
#include "tests/errbound/predicates/predicate_oracle.hpp"
#include "tests/errbound/predicates/simplices_oracle.hpp"

namespace predicate_list {

using predicate_inputs::surface;

template <std::size_t Dimension, std::size_t Count, class Predicate, class Oracle>
struct entry {
    static constexpr std::size_t dimension = Dimension, count = Count;
    std::string_view name;
    Predicate predicate;
    Oracle oracle;
    std::array<surface, 2> surfaces;
    /// The constant of Shewchuk's A-filter in units of u, or 0 (source: static_filter.hpp).
    int constant_of_shewchuk = 0;
};
template <std::size_t D, std::size_t N, class Predicate, class Oracle>
constexpr entry<D, N, Predicate, Oracle> make_entry(std::string_view name, Predicate predicate,
                                                    Oracle oracle, std::array<surface, 2> surfaces,
                                                    int constant_of_shewchuk = 0) {
    return {name, predicate, oracle, surfaces, constant_of_shewchuk};
}
constexpr int sign(int s) {
    return s;
}
/// Oracles take points in a common unit. Some also take 1 in that unit.
#define ERRBOUND_ENTRY(D, N, NAME, ORACLE, ...)                 \
    make_entry<D, N>(                                           \
        #NAME, errbound::NAME,                                  \
        [](const auto& p, [[maybe_unused]] const auto& one) {   \
            if constexpr (requires { oracle::ORACLE(p, one); }) \
                return sign(oracle::ORACLE(p, one));            \
            else                                                \
                return sign(oracle::ORACLE(p));                 \
        },                                                      \
        __VA_ARGS__)

using enum surface;
namespace oracle = predicate_oracle;

inline constexpr std::tuple all{
    ERRBOUND_ENTRY(2, 3, orient2d, orient, {flat, flat}, 3),
    ERRBOUND_ENTRY(3, 4, orient3d, orient, {flat, flat}, 7),
    ERRBOUND_ENTRY(2, 4, incircle, insphere, {round, round}, 10),
    ERRBOUND_ENTRY(3, 5, insphere, insphere, {round, round}, 16),
    ERRBOUND_ENTRY(3, 4, power_incircle, power_insphere, {weighted, weighted}),
    ERRBOUND_ENTRY(4, 5, power_insphere, power_insphere, {weighted, weighted}),
    ERRBOUND_ENTRY(2, 3, compare_distances2d, compare_distances, {centred, centred}),
    ERRBOUND_ENTRY(3, 3, compare_distances3d, compare_distances, {centred, centred}),
    ERRBOUND_ENTRY(3, 4, segments_intersect3d, segments, {flat, concurrent}),
    ERRBOUND_ENTRY(3, 5, segment_intersects_triangle, segment_and_triangle, {flat, concurrent}),
    ERRBOUND_ENTRY(2, 6, orient2d_line_line, orient2d_line_line, {concurrent, concurrent}),
    ERRBOUND_ENTRY(3, 8, orient3d_line_plane, orient3d_line_plane, {concurrent, concurrent}),
    ERRBOUND_ENTRY(2, 8, compare_x_line_line, compare_x_line_line, {concurrent, concurrent}),
    ERRBOUND_ENTRY(2, 4, segments_intersect2d, segments, {flat, concurrent}),
    ERRBOUND_ENTRY(3, 6, triangle_intersects_triangle, triangles, {flat, concurrent}),
    ERRBOUND_ENTRY(4, 5, orient4d, orient, {flat, flat}),
    ERRBOUND_ENTRY(5, 6, orient5d, orient, {flat, flat}),
    ERRBOUND_ENTRY(4, 6, insphere4d, insphere, {round, round}),
    ERRBOUND_ENTRY(5, 7, insphere5d, insphere, {round, round}),
    ERRBOUND_ENTRY(2, 4, compare_lengths2d, compare_lengths, {flat, round}),
    ERRBOUND_ENTRY(3, 4, compare_lengths3d, compare_lengths, {flat, round}),
    ERRBOUND_ENTRY(2, 4, compare_slopes, compare_slopes, {flat, concurrent}),
    ERRBOUND_ENTRY(2, 4, compare_directions, compare_directions, {flat, concurrent}),
    ERRBOUND_ENTRY(2, 6, compare_angles2d, compare_angles, {flat, concurrent}),
    ERRBOUND_ENTRY(3, 6, compare_angles3d, compare_angles, {flat, round}),
    ERRBOUND_ENTRY(2, 4, point_in_triangle2d, point_and_other, {flat, concurrent}),
    ERRBOUND_ENTRY(3, 5, point_in_tetrahedron, point_and_other, {flat, concurrent}),
    ERRBOUND_ENTRY(2, 4, segment_intersects_box2d, segment_intersects_box, {flat, round}),
    ERRBOUND_ENTRY(3, 4, segment_intersects_box3d, segment_intersects_box, {flat, round})};
#undef ERRBOUND_ENTRY

/// The unit in which an entry's oracle takes these points.
template <class Entry, class Points>
int unit_of(const Entry& e, const Points& p) {
    const int unit = predicate_oracle::common_unit(p);
    return e.predicate.counts.mixed ? std::min(unit, 0) : unit;
}
template <class Entry, class Points>
errbound::sign_type right_sign(const Entry& e, const Points& p) {
    const int unit = unit_of(e, p);
    const big_integer one(1, std::min(unit, 0));
    return static_cast<errbound::sign_type>(
        1 + e.oracle(predicate_oracle::scaled_points(p, unit), one));
}

}  // namespace predicate_list
