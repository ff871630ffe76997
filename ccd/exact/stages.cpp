#include "ccd/exact/stages.hpp"

#include <ccd/methods/forms.hpp>
#include <ccd/reference.hpp>
#include <errbound/roots/control_values.hpp>

#include "ccd/exact/coordinate_axes.hpp"
#include "ccd/exact/integers.hpp"
#include "ccd/exact/stage_timer.hpp"
#include "ccd/exact/static_filter/coefficient_signs.hpp"
#include "ccd/exact/static_filter/difference_extents.hpp"
#include "ccd/exact/static_filter/separating_axes.hpp"
#include "ccd/exact/static_filter/subdivision.hpp"
#include "ccd/exact/static_filter/whole_step.hpp"

namespace ccd::detail {
namespace {

/// Proof: proofs/filters/FilterStages.v, filter_face_separate, filter_face_collides,
/// filter_edges_separate, filter_edges_collide, filter_bounded.
template <template <class> class Forms, class Query>
[[gnu::flatten]] verdict axes_to_subdivision(const Query& query, stage_report* report,
                                             static_filter::contact_interval* found,
                                             std::size_t deepest) {
    constexpr verdict separate{outcome::separate, cause::none};
    static_assert(sizeof(query) == 24 * sizeof(double));
    const auto* numbers = reinterpret_cast<const double*>(&query);
    if (!ERRBOUND_INSTRUCTION_SET::are_finite(numbers, 24))
        return {outcome::uncertain, cause::range};
    {
        stage_timer timer(report, stage::axes);
        const bool separated =
            ERRBOUND_INSTRUCTION_SET::packs_separated_by_coordinates<kind_of<Query>>(numbers);
        timer.count(1, separated, 0);
        if (separated) return separate;
    }
    const Forms<double> forms(query);
    const static_filter::difference_extents<double> extents(forms);
    if (!extents.usable) return {outcome::uncertain, cause::range};
    {
        stage_timer timer(report, stage::coplanarity);
        const auto y = errbound::roots::control_values_of(forms.y());
        const double error = extents.template error_of_y<Forms>();
        const bool rootless = static_filter::above(y, error) || static_filter::below(y, error);
        timer.count(1, rootless, 0);
        if (rootless) return separate;
    }
    {
        // Diagonals cost more than Y's four coefficients here, but less in packs of floats.
        stage_timer timer(report, stage::axes);
        const bool separated = static_filter::separated_by_diagonals<double>(forms, extents);
        timer.count(0, separated, 0);  // the stage already counted this query above
        if (separated) return separate;
    }
    stage_timer inside_timer(report, stage::inside);
    const static_filter::whole_step<double, Forms> whole(forms, extents);
    const bool outside = whole.outside();
    inside_timer.count(1, outside, 0);
    inside_timer.end();
    if (outside) return separate;

    stage_timer timer(report, stage::subdivision);
    const outcome answer = static_filter::subdivide(whole, found, deepest);
    timer.count(1, answer == outcome::separate, answer == outcome::collides);
    return {answer, answer == outcome::uncertain ? cause::inside : cause::none};
}

}  // namespace

template <cubic_query Query>
verdict decide_in_floating_point(const Query& query, stage_report* report,
                                 static_filter::contact_interval* found, std::size_t deepest) {
    return axes_to_subdivision<forms_of_kind<kind_of<Query>>::template type>(query, report, found,
                                                                             deepest);
}

template <any_query Query>
verdict decide_with_integers(const Query& query, stage_report* report) {
    const auto decided = [&](stage s, const auto& decide) {
        stage_timer timer(report, s);
        const verdict answer = decide(query);
        timer.count(1, answer.outcome == outcome::separate, answer.outcome == outcome::collides);
        return answer;
    };
    const verdict in_fixed_width =
        decided(stage::integers, [](const Query& q) { return decide_in_integers(q); });
    if (in_fixed_width.outcome != outcome::uncertain) return in_fixed_width;
    return decided(stage::unbounded, [](const Query& q) { return decide_reference(q); });
}

template verdict decide_in_floating_point(const vertex_face<double>&, stage_report*,
                                          static_filter::contact_interval*, std::size_t);
template verdict decide_in_floating_point(const edge_edge<double>&, stage_report*,
                                          static_filter::contact_interval*, std::size_t);

template verdict decide_with_integers(const vertex_face<double>&, stage_report*);
template verdict decide_with_integers(const edge_edge<double>&, stage_report*);
template verdict decide_with_integers(const vertex_edge<double>&, stage_report*);
template verdict decide_with_integers(const vertex_vertex<double>&, stage_report*);

}  // namespace ccd::detail
