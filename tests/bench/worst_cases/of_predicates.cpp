#include <errbound/predicates.hpp>
#include <utility>

#include "ccd/report/measuring/timing.hpp"
#include "tests/bench/worst_cases/subjects.hpp"

namespace worst_cases {
namespace {

template <class Shape, class F, class Options>
subject of(std::string name, const errbound::predicate_type<Shape, F, Options>& predicate) {
    const auto call = [predicate](const double* numbers) {
        [&]<std::size_t... K>(std::index_sequence<K...>) {
            ccd::report::keep(predicate((numbers + Shape::offset(K))...));
        }
        (std::make_index_sequence<Shape::count>());
    };
    return {std::move(name), Shape::size, call};
}

}  // namespace

std::vector<subject> of_predicates() {
    return {of("orient2d", errbound::orient2d),
            of("orient3d", errbound::orient3d),
            of("incircle", errbound::incircle),
            of("insphere", errbound::insphere),
            of("power_incircle", errbound::power_incircle),
            of("power_insphere", errbound::power_insphere),
            of("compare_distances2d", errbound::compare_distances2d),
            of("compare_distances3d", errbound::compare_distances3d),
            of("segments_intersect3d", errbound::segments_intersect3d),
            of("segment_intersects_triangle", errbound::segment_intersects_triangle),
            of("orient2d_line_line", errbound::orient2d_line_line),
            of("orient3d_line_plane", errbound::orient3d_line_plane),
            of("compare_x_line_line", errbound::compare_x_line_line)};
}

}  // namespace worst_cases
