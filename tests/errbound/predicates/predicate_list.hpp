// All predicates of errbound/predicates.hpp, each with its oracle and what makes it degenerate.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <errbound/predicates.hpp>
#include <string_view>
#include <tuple>

#include "tests/errbound/predicates/predicate_inputs.hpp"
#include "tests/errbound/predicates/predicate_oracle.hpp"

namespace predicate_list {

using predicate_inputs::surface;

template <std::size_t Dimension, std::size_t Count, class Predicate, class Oracle>
struct entry {
    static constexpr std::size_t dimension = Dimension, count = Count;
    std::string_view name;
    Predicate predicate;
    Oracle oracle;
    std::array<surface, 2> surfaces;
    /// Shewchuk's A-filter's, in units of u, where there is one (static_filter.hpp names the
    /// source).
    int constant_of_shewchuk = 0;
};
template <std::size_t Dimension, std::size_t Count, class Predicate, class Oracle>
constexpr entry<Dimension, Count, Predicate, Oracle> make_entry(std::string_view name,
                                                                Predicate predicate, Oracle oracle,
                                                                std::array<surface, 2> surfaces,
                                                                int constant_of_shewchuk = 0) {
    return {name, predicate, oracle, surfaces, constant_of_shewchuk};
}

using enum surface;
namespace oracle = predicate_oracle;

/// Oracles take points in a common unit, and 1 in that unit.
inline constexpr std::tuple all{
    make_entry<2, 3>(
        "orient2d", errbound::orient2d,
        [](const auto& p, const auto&) { return sign(oracle::orient2d(p)); }, {flat, flat}, 3),
    make_entry<3, 4>(
        "orient3d", errbound::orient3d,
        [](const auto& p, const auto&) { return sign(oracle::orient3d(p)); }, {flat, flat}, 7),
    make_entry<2, 4>(
        "incircle", errbound::incircle,
        [](const auto& p, const auto&) { return sign(oracle::incircle(p)); }, {round, round}, 10),
    make_entry<3, 5>(
        "insphere", errbound::insphere,
        [](const auto& p, const auto&) { return sign(oracle::insphere(p)); }, {round, round}, 16),
    make_entry<3, 4>(
        "power_incircle", errbound::power_incircle,
        [](const auto& p, const auto& one) { return sign(oracle::power_incircle(p, one)); },
        {weighted, weighted}),
    make_entry<4, 5>(
        "power_insphere", errbound::power_insphere,
        [](const auto& p, const auto& one) { return sign(oracle::power_insphere(p, one)); },
        {weighted, weighted}),
    make_entry<2, 3>("compare_distances2d", errbound::compare_distances2d,
                     [](const auto& p, const auto&) { return sign(oracle::compare_distances(p)); },
                     {centred, centred}),
    make_entry<3, 3>("compare_distances3d", errbound::compare_distances3d,
                     [](const auto& p, const auto&) { return sign(oracle::compare_distances(p)); },
                     {centred, centred}),
    make_entry<3, 4>("segments_intersect3d", errbound::segments_intersect3d,
                     [](const auto& p, const auto&) { return oracle::segments_intersect3d(p); },
                     {flat, concurrent}),
    make_entry<3, 5>(
        "segment_intersects_triangle", errbound::segment_intersects_triangle,
        [](const auto& p, const auto&) { return oracle::segment_intersects_triangle(p); },
        {flat, concurrent}),
    make_entry<2, 6>("orient2d_line_line", errbound::orient2d_line_line,
                     [](const auto& p, const auto&) { return oracle::orient2d_line_line(p); },
                     {concurrent, concurrent}),
    make_entry<3, 8>("orient3d_line_plane", errbound::orient3d_line_plane,
                     [](const auto& p, const auto&) { return oracle::orient3d_line_plane(p); },
                     {concurrent, concurrent}),
    make_entry<2, 8>("compare_x_line_line", errbound::compare_x_line_line,
                     [](const auto& p, const auto&) { return oracle::compare_x_line_line(p); },
                     {concurrent, concurrent})};

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
