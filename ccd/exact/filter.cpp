#include "ccd/exact/cascade.hpp"
#include "ccd/exact/finite.hpp"
#include "ccd/exact/stage_timer.hpp"
#include "ccd/exact/static_filter.hpp"
#include "ccd/exact/subdivision.hpp"

namespace ccd {
namespace {

using static_filter::above, static_filter::below;

// Proof: proofs/FilterStages.v, filter_face_separate, filter_face_collides, filter_edges_separate,
// filter_edges_collide, filter_bounded.
template <template <class> class Forms, template <class> class Query>
[[gnu::flatten]] verdict run_stages(const Query<double>& query, stage_report* report) {
    if (!is_finite(query)) return {outcome::uncertain, cause::range};
    const Forms<double> forms(query);
    const static_filter::sizes<double> sizes(forms);
    if (!sizes.usable) return {outcome::uncertain, cause::range};
    {
        stage_timer turn(report, stage::axes);
        const bool separated = static_filter::separated_by_coordinates<double>(forms, sizes);
        turn.count(1, separated, 0);
        if (separated) return {outcome::separate, cause::none};
    }
    {
        stage_timer turn(report, stage::coplanarity);
        const auto y = errbound::roots::control_values_of(forms.y());
        const double error = sizes.error_of_y<Forms>();
        const bool rootless = above(y, error) || below(y, error);
        turn.count(1, rootless, 0);
        if (rootless) return {outcome::separate, cause::none};
    }
    {
        // The axes across cost one query more than Y's four coefficients do, a pack of floats less.
        stage_timer turn(report, stage::axes);
        const bool separated = static_filter::separated_by_diagonals<double>(forms, sizes);
        turn.count(0, separated, 0);  // it entered above
        if (separated) return {outcome::separate, cause::none};
    }
    stage_timer inside_turn(report, stage::inside);
    const static_filter::whole_step<double, Forms> whole(forms, sizes);
    const bool outside = whole.outside();
    inside_turn.count(1, outside, 0);
    inside_turn.end();
    if (outside) return {outcome::separate, cause::none};

    stage_timer turn(report, stage::subdivision);
    const outcome answer = subdivide(whole);
    turn.count(1, answer == outcome::separate, answer == outcome::collides);
    return {answer, answer == outcome::uncertain ? cause::inside : cause::none};
}

}  // namespace

verdict filter(const vertex_face<double>& query, stage_report* report) {
    return run_stages<linear_vertex_face_forms>(query, report);
}
verdict filter(const edge_edge<double>& query, stage_report* report) {
    return run_stages<linear_edge_edge_forms>(query, report);
}

}  // namespace ccd
