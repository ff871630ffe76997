// First times on the device: the stages of ccd/contact/time_of_impact.cpp as kernel bodies.
//
// Floating point finds the interval of the first contact, and integers of fixed width isolate the
// root of Y in it. If floating point is uncertain, integers do both. Queues are as in
// ccd/cuda/exact_stages.hpp. Internal.
#pragma once

#include <ccd/cuda.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <cstdint>

#include "ccd/contact/integer_first_contact.hpp"
#include "ccd/cuda/exact_stages.hpp"
#include "ccd/cuda/launch.hpp"
#include "ccd/cuda/queries.hpp"
#include "ccd/exact/integer_decision.hpp"
#include "ccd/exact/static_filter/subdivision.hpp"
#include "ccd/exact/static_filter/whole_step.hpp"

namespace ccd::cuda::detail {

struct times_request {
    double t_max;
    bool earliest;  ///< find only times at the start, and the earliest of the others
};

template <class Pair>
struct time_stage {
    positions at;
    cuda::candidates<Pair> candidates;
    first_time* times;
    bool earliest;
    shared_time t_max;  ///< later times are not needed
    queue open;
    queue left;  ///< candidates for the host

    constexpr query_of_pair<Pair, double> query(std::uint32_t i) const {
        return query_at<double>(at, pair_at(candidates, i));
    }
    constexpr void answer(std::uint32_t i, const ccd::detail::found_time& found) const {
        if (found.outcome == outcome::uncertain) {
            left.push(i);
            return;
        }
        const bool in_time = found.outcome == outcome::collides && found.time.high <= t_max.get();
        if (!in_time) {
            times[i] = {outcome::separate};
            return;
        }
        times[i] = {outcome::collides, found.time.low, found.time.high};
        if (earliest && !times[i].at_start()) t_max.lower(found.time.high);
    }
};

/// If floating point finds an interval with one root of Y, integers of Words words isolate it.
/// Candidates that need more words go to `wider`.
template <class Pair, int Words>
struct root_stage : time_stage<Pair> {
    queue wider;

    constexpr void operator()(std::uint32_t i) const {
        const auto query = this->query(i);
        const ccd::detail::integer_units units(query);
        if (!units.finite()) {
            this->times[i] = {};
            return;
        }
        if (units.bits() > ccd::detail::extent_limit(Words)) {
            wider.push(i);
            return;
        }
        static_filter::contact_interval part;
        const outcome found = part_of_contact(query, part);
        if (found == outcome::separate || part.low > this->t_max.get())
            this->answer(i, outcome::separate);
        else if (found == outcome::collides && part.one_root)
            this->answer(i, ccd::detail::root_in_words<Words>(query, units, part));
        else
            this->open.push(i);
    }

  private:
    template <class S>
    using forms = linear_forms<kind_of<Pair>, S>;

    static constexpr outcome part_of_contact(const query_of_pair<Pair, double>& query,
                                             static_filter::contact_interval& part) {
        const forms<double> f(query);
        const static_filter::difference_extents<double> extents(f);
        if (!extents.usable) return outcome::uncertain;
        const static_filter::whole_step<double, forms> whole(f, extents);
        return static_filter::subdivide(whole, &part, static_filter::halvings_for_times);
    }
};

template <class Pair, int Words>
struct integer_time_stage : time_stage<Pair> {
    constexpr void operator()(std::uint32_t i) const {
        const auto query = this->query(i);
        const ccd::detail::integer_units units(query);
        this->answer(i, ccd::detail::first_contact_in_words<Words, ccd::detail::effort::limited>(
                            query, units));
    }
};

struct time_counters {
    std::uint32_t one_word, roots_in_two_words, two_words, left;
};

struct time_memory {
    time_counters* counters;
    double* t_max;
    std::uint32_t *first, *second;
    std::uint32_t* left;

    time_memory(arena& from, std::size_t candidates)
        : counters(from.take<time_counters>(1)),
          t_max(from.take<double>(1)),
          first(from.take<std::uint32_t>(exact_memory::queue_items(candidates))),
          second(from.take<std::uint32_t>(exact_memory::queue_items(candidates))),
          left(from.take<std::uint32_t>(candidates)) {}
};

/// Queues all stages. The host decides the rest (ccd/cuda/pairs.hpp).
template <class Launcher, class Pair>
void run_time_stages(Launcher& launcher, const positions& at, const candidates<Pair>& candidates,
                     first_time* times, const time_memory& memory, const times_request& request) {
    launcher.set(memory.counters, time_counters{});
    launcher.set(memory.t_max, request.t_max);
    time_counters& sizes = *memory.counters;
    const queue to_one_word{memory.first, &sizes.one_word};
    const queue to_roots_in_two_words{memory.second, &sizes.roots_in_two_words};
    const queue to_two_words{memory.first, &sizes.two_words};
    const queue left{memory.left, &sizes.left};
    const auto stage = [&](const queue& open) {
        return time_stage<Pair>{
            at, candidates, times, request.earliest, shared_time(memory.t_max), open, left};
    };
    launcher.for_each(candidates.count,
                      root_stage<Pair, 1>{stage(to_one_word), to_roots_in_two_words});
    launcher.for_each_queued(to_one_word, integer_time_stage<Pair, 1>{stage(left)});
    launcher.for_each_queued(to_roots_in_two_words, root_stage<Pair, 2>{stage(to_two_words), left});
    launcher.for_each_queued(to_two_words, integer_time_stage<Pair, 2>{stage(left)});
}

}  // namespace ccd::cuda::detail
