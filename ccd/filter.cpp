#include <array>
#include <ccd/static_filter.hpp>

#include "ccd/cascade.hpp"
#include "ccd/finite.hpp"
#include "ccd/stage_turn.hpp"

namespace ccd {
namespace {

using static_filter::above, static_filter::below;

/// Parts of the step that wait for their turn, the earliest last.
template <std::size_t Constraints>
struct waiting_parts {
    struct part {
        static_filter::part_forms<double, Constraints> forms;
        std::size_t depth;
    };
    // Every halving takes one part and leaves two.
    std::array<part, static_filter::max_depth + 2> parts;
    std::size_t size = 0;
};

/// Proof: proofs/Subdivision.v, subdivision_separate and subdivision_collides.
template <template <class> class Forms>
outcome subdivide(const static_filter::whole_step<double, Forms>& whole) {
    constexpr std::size_t constraints = static_filter::whole_step<double, Forms>::constraints;
    const auto& errors = whole.errors;
    waiting_parts<constraints> waiting;
    waiting.parts[waiting.size++] = {whole.forms, 0};
    while (waiting.size > 0) {
        auto& part = waiting.parts[waiting.size - 1];
        const auto& [y, g] = part.forms;
        bool excluded = above(y, errors.y) || below(y, errors.y);
        bool collides = static_filter::changes_sign(y, errors.y);
        for (std::size_t i = 0; i < constraints && !excluded; ++i) {
            excluded = below(g[i], errors.g);
            collides = collides && above(g[i], errors.g);
        }
        if (excluded) {
            --waiting.size;
            continue;
        }
        if (collides) return outcome::collides;
        if (part.depth == static_filter::max_depth || (part.depth >= static_filter::patient_depth &&
                                                       static_filter::within_error(y, errors.y)))
            return outcome::uncertain;
        auto& next = waiting.parts[waiting.size++];
        const auto [left, right] = errbound::halves(y);
        part.forms.y = right, next.forms.y = left;
        for (std::size_t i = 0; i < constraints; ++i) {
            const auto [g_left, g_right] = errbound::halves(g[i]);
            part.forms.g[i] = g_right, next.forms.g[i] = g_left;
        }
        next.depth = ++part.depth;
    }
    return outcome::separate;
}

template <template <class> class Forms, template <class> class Query>
[[gnu::flatten]] verdict run_stages(const Query<double>& query, stage_report* report) {
    if (!is_finite(query)) return {outcome::uncertain, cause::range};
    const Forms<double> forms(query);
    const static_filter::sizes<double> sizes(forms);
    if (!sizes.usable) return {outcome::uncertain, cause::range};
    {
        stage_turn turn(report, stage::axes);
        const bool parted = static_filter::parted_by_coordinates<double>(forms, sizes);
        turn.count(1, parted, 0);
        if (parted) return {outcome::separate, cause::none};
    }
    {
        stage_turn turn(report, stage::coplanarity);
        const auto y = errbound::control_values_of(forms.y());
        const double error = sizes.error_of_y<Forms>();
        const bool rootless = above(y, error) || below(y, error);
        turn.count(1, rootless, 0);
        if (rootless) return {outcome::separate, cause::none};
    }
    {
        // The axes across cost one query more than Y's four coefficients do; not so a pack in
        // float.
        stage_turn turn(report, stage::axes);
        const bool parted = static_filter::parted_by_diagonals<double>(forms, sizes);
        turn.count(0, parted, 0);  // it entered above
        if (parted) return {outcome::separate, cause::none};
    }
    stage_turn inside_turn(report, stage::inside);
    const static_filter::whole_step<double, Forms> whole(forms, sizes);
    const bool outside = whole.outside();
    inside_turn.count(1, outside, 0);
    inside_turn.end();
    if (outside) return {outcome::separate, cause::none};

    stage_turn turn(report, stage::subdivision);
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
