// `exact` on the device: its stages as kernel bodies, and their order. Internal.
//
// Each stage reads indices of candidates from a queue, writes certain answers and pushes the other
// candidates to the next queue. So the threads of a warp do equal work. Reading undecided
// candidates again is cheaper than storing their differences.
#pragma once

#include <ccd/batch.hpp>
#include <ccd/cuda.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <cstdint>
#include <errbound/number_traits.hpp>
#include <errbound/roots/control_values.hpp>
#include <type_traits>

#include "ccd/cuda/launch.hpp"
#include "ccd/cuda/queries.hpp"
#include "ccd/cuda/rounding.hpp"
#include "ccd/exact/integer_decision.hpp"
#include "ccd/exact/static_filter/subdivision.hpp"
#include "ccd/exact/static_filter/whole_step.hpp"

namespace ccd::cuda::detail {

template <class Pair>
struct exact_stage {
    template <class S>
    using forms = linear_forms<kind_of<Pair>, S>;

    positions at;
    cuda::candidates<Pair> candidates;
    outcome* answers;
    queue open;

    constexpr query_of_pair<Pair, double> query(std::uint32_t i) const {
        return query_at<double>(at, pair_at(candidates, i));
    }
    constexpr void decide(std::uint32_t i, bool separate) const {
        if (separate)
            answers[i] = outcome::separate;
        else
            open.push(i);
    }
};

/// Tests all candidates on nine axes, in floats. Candidates that are not finite go to no other
/// stage.
template <class Pair>
struct axes_stage : exact_stage<Pair> {
    const scene_extent* scene;
    const rounded_position* rows;

    constexpr void operator()(std::uint32_t i) const {
        const bool separate = scene->finite && separated(i);  // comparisons may miss NaN
        this->answers[i] = separate ? outcome::separate : outcome::uncertain;
        if (!separate && (scene->finite || is_finite(this->query(i)))) this->open.push(i);
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
        return ccd::detail::rounded_axes::separated<Pair>(x);
    }
    static constexpr bool is_finite(const query_of_pair<Pair, double>& query) {
        bool finite = true;
        for_each_coordinate(query, [&](double x) {
            finite = finite && errbound::number_traits<double>::is_finite(x);
        });
        return finite;
    }
};

/// The base of the stages that test coefficients. In floats, differences are scaled by
/// scene->power_of_two().
template <class Pair, class Real>
struct coefficient_stage : exact_stage<Pair> {
    template <class S>
    using forms = typename exact_stage<Pair>::template forms<S>;

    const scene_extent* scene;

  protected:
    /// The query's forms. Differences are rounded in doubles, then to Real, with a relative error
    /// of at most Real's ε in all, as in error_count::difference(), and η if they underflow. Proof:
    /// proofs/filters/RoundedAxes.v, converted_difference_near.
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
    constexpr bool usable(const static_filter::difference_extents<Real>& extents) const {
        return extents.usable && (std::is_same_v<Real, double> || scene->finite);
    }
};

template <class Pair, class Real>
struct coplanarity_stage : coefficient_stage<Pair, Real> {
    using base = coefficient_stage<Pair, Real>;

    constexpr void operator()(std::uint32_t i) const {
        const auto forms = this->forms_of_query(this->query(i));
        const static_filter::difference_extents<Real> extents(forms);
        const auto y = errbound::roots::control_values_of(forms.y());
        const Real error = extents.template error_of_y<base::template forms>();
        const bool rootless = static_filter::above(y, error) || static_filter::below(y, error);
        this->decide(i, this->usable(extents) && rootless);
    }
};

template <class Pair, class Real>
struct inside_stage : coefficient_stage<Pair, Real> {
    using base = coefficient_stage<Pair, Real>;

    constexpr void operator()(std::uint32_t i) const {
        const auto forms = this->forms_of_query(this->query(i));
        const static_filter::difference_extents<Real> extents(forms);
        const static_filter::whole_step<Real, base::template forms> whole(forms, extents);
        this->decide(i, this->usable(extents) && whole.outside());
    }
};

/// Evaluates Y and the G_i on ever smaller intervals of the step.
template <class Pair>
struct subdivision_stage : exact_stage<Pair> {
    using base = exact_stage<Pair>;

    constexpr void operator()(std::uint32_t i) const {
        const typename base::template forms<double> forms(this->query(i));
        const static_filter::difference_extents<double> extents(forms);
        if (extents.usable) {
            const static_filter::whole_step<double, base::template forms> whole(forms, extents);
            const outcome found = static_filter::subdivide(whole);
            if (found != outcome::uncertain) {
                this->answers[i] = found;
                return;
            }
        }
        this->open.push(i);
    }
};

/// Decides in integers of Words words. Candidates that need more words go to `open`, uncertain ones
/// to `left`.
template <class Pair, int Words>
struct integer_stage : exact_stage<Pair> {
    queue left;

    constexpr void operator()(std::uint32_t i) const {
        const auto query = this->query(i);
        const ccd::detail::integer_units units(query);
        if (units.bits() > ccd::detail::extent_limit(Words)) {
            this->open.push(i);
            return;
        }
        const outcome found =
            ccd::detail::decide_in_words<Words, ccd::detail::effort::limited>(query, units);
        this->answers[i] = found;
        if (found == outcome::uncertain) left.push(i);
    }
};

struct exact_counters {
    std::uint32_t coplanarity, inside, subdivision, one_word, two_words, left;
};

struct exact_memory {
    exact_counters* counters;
    scene_extent* scene;
    rounded_position* rows;
    std::uint32_t *first, *second;
    std::uint32_t* left;

    /// Braces fix the order in which memory is taken.
    exact_memory(arena& from, std::size_t vertices, std::size_t candidates)
        : exact_memory{from, from.take<scene_extent>(1), from.take<rounded_position>(2 * vertices),
                       candidates} {}
    exact_memory(arena& from, scene_extent* scene_, rounded_position* rows_, std::size_t candidates)
        : counters(from.take<exact_counters>(1)),
          scene(scene_),
          rows(rows_),
          first(from.take<std::uint32_t>(queue_items(candidates))),
          second(from.take<std::uint32_t>(queue_items(candidates))),
          left(from.take<std::uint32_t>(candidates)) {}

    /// The capacity of the first two queues, in indices: at least 64, since finish_left
    /// (ccd/cuda/pairs.hpp) uses their memory for queries of 192 bytes.
    static constexpr std::size_t queue_items(std::size_t candidates) {
        return candidates < 64 ? 64 : candidates;
    }
};

/// Queues all stages, in the order of ccd/exact/stages.cpp. Tests of coefficients use `p`. The host
/// decides the rest (ccd/cuda/pairs.hpp). Precondition: positions are rounded.
template <class Launcher, class Pair>
void run_exact_stages(Launcher& launcher, const positions& at, const candidates<Pair>& candidates,
                      outcome* answers, const exact_memory& memory, precision p) {
    launcher.set(memory.counters, exact_counters{});
    exact_counters& sizes = *memory.counters;
    const queue to_coplanarity{memory.first, &sizes.coplanarity};
    const queue to_inside{memory.second, &sizes.inside};
    const queue to_subdivision{memory.first, &sizes.subdivision};
    const queue to_one_word{memory.second, &sizes.one_word};
    const queue to_two_words{memory.first, &sizes.two_words};
    const queue left{memory.left, &sizes.left};
    const auto stage = [&](const queue& open) {
        return exact_stage<Pair>{at, candidates, answers, open};
    };
    launcher.for_each(candidates.count,
                      axes_stage<Pair>{stage(to_coplanarity), memory.scene, memory.rows});
    const auto coefficients = [&]<class Real>(Real) {
        const auto of = [&](const queue& open) {
            return coefficient_stage<Pair, Real>{stage(open), memory.scene};
        };
        launcher.for_each_queued(to_coplanarity, coplanarity_stage<Pair, Real>{of(to_inside)});
        launcher.for_each_queued(to_inside, inside_stage<Pair, Real>{of(to_subdivision)});
    };
    if (p == precision::float32)
        coefficients(0.0f);
    else
        coefficients(0.0);
    // Always in doubles: it tests the whole step again first.
    launcher.for_each_queued(to_subdivision, subdivision_stage<Pair>{stage(to_one_word)});
    launcher.for_each_queued(to_one_word, integer_stage<Pair, 1>{stage(to_two_words), left});
    launcher.for_each_queued(to_two_words, integer_stage<Pair, 2>{stage(left), left});
}

}  // namespace ccd::cuda::detail
