// The float methods on the device: their stages as kernel bodies, and their order. Internal.
//
// With float32, floats run first, and doubles decide uncertain candidates. In BSC, a separate stage
// for Y's coefficients decides most candidates with a fraction of the cost and registers.
#pragma once

#include <ccd/cuda.hpp>
#include <ccd/methods/bsc.hpp>
#include <ccd/methods/safeccd.hpp>
#include <ccd/methods/single_precision.hpp>
#include <ccd/methods/tracked_query.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "ccd/cuda/launch.hpp"
#include "ccd/cuda/queries.hpp"

namespace ccd::cuda::detail {

/// Calls f(query, finite) with a candidate's query over tracked numbers of T.
template <class Rule, class T, class Pair, class F>
constexpr auto with_tracked_query(const positions& at, const Pair& pair, const F& f) {
    const auto apply = [&](const auto& converted) { return f(converted.first, converted.second); };
    if constexpr (std::is_same_v<T, double>) {
        return apply(tracked_query<Rule>(query_at<double>(at, pair)));
    } else {
        return apply(at.in_floats ? tracked_query<Rule>(query_at<float>(at, pair))
                                  : single_precision_query<Rule>(query_at<double>(at, pair)));
    }
}

template <class R>
struct bsc_method {
    using rule = R;
    static constexpr bool coplanarity_first = true;

    template <class Query>
    static constexpr outcome decide(const Query& query) {
        return decide_bsc_of(query).outcome;
    }
};
template <class R>
struct safeccd_method {
    using rule = R;
    static constexpr bool coplanarity_first = false;

    template <class Query>
    static constexpr outcome decide(const Query& query) {
        return decide_safeccd_of<R>(query).outcome;
    }
};

template <class Pair>
struct method_stage {
    positions at;
    cuda::candidates<Pair> candidates;
    outcome* answers;
    queue open;
};

/// Answers `separate` if Y's coefficients in T prove it. Other candidates stay undecided.
template <class Method, class T, class Pair>
struct never_coplanar_stage : method_stage<Pair> {
    constexpr void operator()(std::uint32_t i) const {
        const auto pair = pair_at(this->candidates, i);
        const bool separate = with_tracked_query<typename Method::rule, T>(
            this->at, pair,
            [](const auto& query, bool finite) { return finite && never_coplanar(query); });
        if (separate)
            this->answers[i] = outcome::separate;
        else
            this->open.push(i);
    }
};

/// Stores the method's answer in T. Pushes uncertain candidates to the queue, if there is one.
template <class Method, class T, class Pair>
struct decision_stage : method_stage<Pair> {
    constexpr void operator()(std::uint32_t i) const {
        const auto pair = pair_at(this->candidates, i);
        const outcome found = with_tracked_query<typename Method::rule, T>(
            this->at, pair, [](const auto& query, bool finite) {
                return finite ? Method::decide(query) : outcome::uncertain;
            });
        this->answers[i] = found;
        if (this->open.items != nullptr && found == outcome::uncertain) this->open.push(i);
    }
};

struct method_counters {
    std::uint32_t roots, in_doubles;
};

struct method_memory {
    method_counters* counters;
    std::uint32_t *first, *second;

    method_memory(arena& from, std::size_t candidates)
        : counters(from.take<method_counters>(1)),
          first(from.take<std::uint32_t>(candidates)),
          second(from.take<std::uint32_t>(candidates)) {}
};

/// Queues all stages, with T = float or double first.
template <class Method, class T, class Launcher, class Pair>
void run_method(Launcher& launcher, const positions& at, const candidates<Pair>& candidates,
                outcome* answers, const method_memory& memory) {
    launcher.set(memory.counters, method_counters{});
    const queue none{nullptr, nullptr};
    const queue after_coplanarity{memory.first, &memory.counters->roots};
    const queue after_floats{memory.second, &memory.counters->in_doubles};
    const auto stage = [&](const queue& open) {
        return method_stage<Pair>{at, candidates, answers, open};
    };
    // `none` is uncertain only if its numbers overflow.
    constexpr bool doubles_follow =
        !std::is_same_v<T, double> && !std::is_same_v<typename Method::rule, errbound::none>;
    const decision_stage<Method, T, Pair> decision{stage(doubles_follow ? after_floats : none)};
    if constexpr (Method::coplanarity_first) {
        launcher.for_each(candidates.count,
                          never_coplanar_stage<Method, T, Pair>{stage(after_coplanarity)});
        launcher.for_each_queued(after_coplanarity, decision);
    } else {
        launcher.for_each(candidates.count, decision);
    }
    if constexpr (doubles_follow)
        launcher.for_each_queued(after_floats, decision_stage<Method, double, Pair>{stage(none)});
}

}  // namespace ccd::cuda::detail
