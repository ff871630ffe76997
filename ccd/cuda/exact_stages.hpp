// `exact` on the device: its stages as kernel bodies, and their order. Internal.
//
// Each stage reads the numbers of its candidates from one queue and pushes those that it cannot
// settle to the next: so the threads of a warp do the same work, and one hard candidate holds up
// none of the easy ones. The first stage reads only floats; later ones read the few that are left
// again, which is less than handing their differences on.
#pragma once

#include <algorithm>
#include <ccd/batch.hpp>
#include <ccd/cuda.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <cstdint>
#include <errbound/number_traits.hpp>
#include <errbound/roots/control_values.hpp>
#include <type_traits>

#include "ccd/batch/rounded_axes.hpp"
#include "ccd/cuda/launch.hpp"
#include "ccd/cuda/queries.hpp"
#include "ccd/exact/integer_decision.hpp"
#include "ccd/exact/static_filter/subdivision.hpp"
#include "ccd/exact/static_filter/whole_step.hpp"

namespace ccd::cuda {

/// Four floats of a vertex: x y z at one end of the step, and nothing.
struct alignas(16) rounded_position {
    float x, y, z, unused;
};

/// The box around all positions, and whether every coordinate is finite.
struct scene_extent {
    detail::rounded_axes::extent box;
    bool finite;

    /// A power of two, times which no difference of coordinates exceeds 4 in size.
    constexpr double power_of_two() const {
        using traits = errbound::number_traits<double>;
        double half_extent = 0;
        for (std::size_t k = 0; k < 3; ++k)
            half_extent = traits::max(half_extent, box.high[k] / 2 - box.low[k] / 2);
        // Bounded so that it is neither zero nor infinite: then floats settle little or nothing.
        const int e =
            half_extent > 0 && traits::is_finite(half_extent) ? traits::exponent(half_extent) : 0;
        return traits::scale(1.0, -std::clamp(e, -1000, 1000));
    }

    static constexpr scene_extent nothing() {
        return {detail::rounded_axes::extent::nothing(), true};
    }
};

/// For launcher.reduce.
struct extent_of_vertex {
    positions at;

    constexpr scene_extent operator()(std::uint32_t v) const {
        auto e = scene_extent::nothing();
        for (const auto* frame : {&at.before, &at.after})
            for (std::size_t k = 0; k < 3; ++k) {
                const double x = coordinate_at(at, *frame, k, v);
                e.box.widen(k, x);
                e.finite = e.finite && errbound::number_traits<double>::is_finite(x);
            }
        return e;
    }
};
struct hull_of_extents {
    constexpr scene_extent operator()(scene_extent a, const scene_extent& b) const {
        for (std::size_t k = 0; k < 3; ++k) {
            a.box.widen(k, b.box.low[k]);
            a.box.widen(k, b.box.high[k]);
        }
        a.finite = a.finite && b.finite;
        return a;
    }
};

/// Rounds a vertex' positions to rows 2v (before) and 2v + 1 (after).
struct round_vertex {
    positions at;
    const scene_extent* scene;
    rounded_position* rows;

    constexpr void operator()(std::uint32_t v) const {
        const detail::rounded_axes::frame rounded(scene->box);
        const auto row = [&](const positions::frame& frame) {
            const auto x = [&](std::size_t k) {
                return rounded(k, coordinate_at(at, frame, k, v));
            };
            return rounded_position{x(0), x(1), x(2), 0};
        };
        rows[2 * std::size_t(v)] = row(at.before);
        rows[2 * std::size_t(v) + 1] = row(at.after);
    }
};

/// What every stage knows.
template <class Pair>
struct exact_stage {
    template <class S>
    using forms = linear_forms<kind_of<Pair>, S>;

    positions at;
    cuda::candidates<Pair> candidates;
    outcome* answers;
    queue open;  ///< what the stage leaves to the next

    constexpr query_of_pair<Pair, double> query(std::uint32_t i) const {
        return query_at<double>(at, pair_at(candidates, i));
    }
};

/// All candidates: the cull by axes, in floats. Sets every answer to `separate`.
template <class Pair>
struct axes_stage : exact_stage<Pair> {
    const scene_extent* scene;
    const rounded_position* rows;

    constexpr void operator()(std::uint32_t i) const {
        this->answers[i] = outcome::separate;
        // Comparisons may overlook NaN.
        if (!scene->finite || !separated(i)) this->open.push(i);
    }

  private:
    constexpr bool separated(std::uint32_t i) const {
        float x[3][2][4];
        const auto vertices = vertices_of(pair_at(this->candidates, i));
        for (std::size_t p = 0; p < 4; ++p)
            for (std::size_t end = 0; end < 2; ++end) {
                const rounded_position r = load_aligned(rows + 2 * std::size_t(vertices[p]) + end);
                x[0][end][p] = r.x, x[1][end][p] = r.y, x[2][end][p] = r.z;
            }
        return detail::rounded_axes::separated<Pair>(x);
    }
};

/// What the tests of coefficients share. In floats, differences come in units of the scene's size.
template <class Pair, class Real>
struct coefficient_stage : exact_stage<Pair> {
    template <class S>
    using forms = typename exact_stage<Pair>::template forms<S>;

    const scene_extent* scene;

  protected:
    /// The query's forms. Differences are rounded once in doubles, and to floats where asked for:
    /// off by at most ε each, as error_count::difference() says, and by η where that underflows.
    /// Proof: proofs/RoundedAxes.v, converted_difference_near.
    constexpr forms<Real> forms_of_query(const query_of_pair<Pair, double>& query) const {
        if constexpr (std::is_same_v<Real, double>) {
            return forms<double>(query);
        } else {
            const double unit = scene->power_of_two();
            const auto converted = [unit](const vector_form<double, 1>& v) {
                const auto of = [unit](const errbound::bernstein<double, 1>& d) {
                    return errbound::bernstein<float, 1>{
                        {static_cast<float>(d[0] * unit), static_cast<float>(d[1] * unit)}};
                };
                return vector_form<float, 1>{of(v.x), of(v.y), of(v.z)};
            };
            const forms<double> in_doubles(query);
            return forms<float>(converted(in_doubles.b), converted(in_doubles.c),
                                converted(in_doubles.p));
        }
    }
    /// Whether comparisons may be believed.
    constexpr bool usable(const static_filter::difference_extents<Real>& extents) const {
        return extents.usable && (std::is_same_v<Real, double> || scene->finite);
    }
};

/// The coefficients of Y. Candidates whose coordinates are not finite are `uncertain` and leave.
template <class Pair, class Real>
struct coplanarity_stage : coefficient_stage<Pair, Real> {
    using base = coefficient_stage<Pair, Real>;

    constexpr void operator()(std::uint32_t i) const {
        const auto query = this->query(i);
        bool finite = true;
        for_each_coordinate(query, [&](double x) {
            finite = finite && errbound::number_traits<double>::is_finite(x);
        });
        if (!finite) {
            this->answers[i] = outcome::uncertain;
            return;
        }
        const auto forms = this->forms_of_query(query);
        const static_filter::difference_extents<Real> extents(forms);
        const auto y = errbound::roots::control_values_of(forms.y());
        const Real error = extents.template error_of_y<base::template forms>();
        const bool rootless = static_filter::above(y, error) || static_filter::below(y, error);
        if (!this->usable(extents) || !rootless) this->open.push(i);
    }
};

/// The coefficients of the G_i.
template <class Pair, class Real>
struct inside_stage : coefficient_stage<Pair, Real> {
    using base = coefficient_stage<Pair, Real>;

    constexpr void operator()(std::uint32_t i) const {
        const auto forms = this->forms_of_query(this->query(i));
        const static_filter::difference_extents<Real> extents(forms);
        const static_filter::whole_step<Real, base::template forms> whole(forms, extents);
        if (!this->usable(extents) || !whole.outside()) this->open.push(i);
    }
};

/// Y and G_i on ever smaller parts of the step.
template <class Pair>
struct subdivision_stage : exact_stage<Pair> {
    using base = exact_stage<Pair>;

    constexpr void operator()(std::uint32_t i) const {
        const typename base::template forms<double> forms(this->query(i));
        const static_filter::difference_extents<double> extents(forms);
        if (extents.usable) {
            const static_filter::whole_step<double, base::template forms> whole(forms, extents);
            const outcome found = static_filter::subdivide(whole);
            this->answers[i] = found;
            if (found != outcome::uncertain) return;
        }
        // Until exact arithmetic says otherwise: nobody may take it for separate.
        this->answers[i] = outcome::uncertain;
        this->open.push(i);
    }
};

/// Integers of Words words. What needs more goes to `open`, what stays uncertain to `left`.
template <class Pair, int Words>
struct integer_stage : exact_stage<Pair> {
    queue left;

    constexpr void operator()(std::uint32_t i) const {
        const auto query = this->query(i);
        const detail::integer_units units(query);
        if (units.bits() > detail::extent_limit(Words)) {
            this->open.push(i);
            return;
        }
        const outcome found = detail::decide_in_words<Words>(query, units);
        this->answers[i] = found;
        if (found == outcome::uncertain) left.push(i);
    }
};

/// How far the candidates of one call have come: a queue's size for each stage.
struct exact_counters {
    std::uint32_t coplanarity, inside, subdivision, one_word, two_words, left;
};

/// Scratch memory of one call.
struct exact_memory {
    exact_counters* counters;
    scene_extent* scene;
    rounded_position* rows;
    std::uint32_t *first, *second;  ///< queues' items, in turn
    std::uint32_t* left;

    /// In braces, so that memory is taken in one order always.
    exact_memory(arena& from, std::size_t vertices, std::size_t candidates)
        : exact_memory{from, from.take<scene_extent>(1), from.take<rounded_position>(2 * vertices),
                       candidates} {}
    /// Of positions whose rounding has a place already.
    exact_memory(arena& from, scene_extent* scene_, rounded_position* rows_, std::size_t candidates)
        : counters(from.take<exact_counters>(1)),
          scene(scene_),
          rows(rows_),
          first(from.take<std::uint32_t>(queue_items(candidates))),
          second(from.take<std::uint32_t>(queue_items(candidates))),
          left(from.take<std::uint32_t>(candidates)) {}

    /// Room of the first two queues: at least for one query (ccd/cuda/pairs.hpp).
    static constexpr std::size_t queue_items(std::size_t candidates) {
        return candidates < 64 ? 64 : candidates;
    }
};

/// Rounds all positions for the first stage.
template <class Launcher>
void run_rounding(Launcher& launcher, const positions& at, scene_extent* scene,
                  rounded_position* rows) {
    launcher.reduce(at.vertices, extent_of_vertex{at}, hull_of_extents{}, scene_extent::nothing(),
                    scene);
    launcher.for_each(at.vertices, round_vertex{at, scene, rows});
}

/// Queues all stages, the tests of coefficients in `p`; positions are rounded already.
template <class Launcher, class Pair>
void run_exact_stages(Launcher& launcher, const positions& at, const candidates<Pair>& candidates,
                      outcome* answers, const exact_memory& memory, precision p) {
    launcher.set(memory.counters, exact_counters{});
    exact_counters& sizes = *memory.counters;  // its members' addresses alone are used
    const queue after_axes{memory.first, &sizes.coplanarity};
    const queue after_coplanarity{memory.second, &sizes.inside};
    const queue after_inside{memory.first, &sizes.subdivision};
    const queue after_subdivision{memory.second, &sizes.one_word};
    const queue after_one_word{memory.first, &sizes.two_words};
    const queue left{memory.left, &sizes.left};
    const auto stage = [&](const queue& open) {
        return exact_stage<Pair>{at, candidates, answers, open};
    };
    launcher.for_each(candidates.count,
                      axes_stage<Pair>{stage(after_axes), memory.scene, memory.rows});
    const auto coefficients = [&](auto real) {
        using Real = decltype(real);
        const auto of = [&](const queue& open) {
            return coefficient_stage<Pair, Real>{stage(open), memory.scene};
        };
        launcher.for_each_queued(after_axes, coplanarity_stage<Pair, Real>{of(after_coplanarity)});
        launcher.for_each_queued(after_coplanarity, inside_stage<Pair, Real>{of(after_inside)});
    };
    if (p == precision::float32)
        coefficients(0.0f);
    else
        coefficients(0.0);
    // In doubles in either case: it looks at the whole step again first.
    launcher.for_each_queued(after_inside, subdivision_stage<Pair>{stage(after_subdivision)});
    launcher.for_each_queued(after_subdivision,
                             integer_stage<Pair, 1>{stage(after_one_word), left});
    launcher.for_each_queued(after_one_word, integer_stage<Pair, 2>{stage(left), left});
}

}  // namespace ccd::cuda
