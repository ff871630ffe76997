// What follows a batch: candidates that are finished on the host, and the list of those that may
// collide. Internal.
#pragma once

#include <algorithm>
#include <ccd/batch.hpp>
#include <ccd/cuda.hpp>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ccd/cuda/exact_stages.hpp"
#include "ccd/cuda/launch.hpp"
#include "ccd/cuda/queries.hpp"

namespace ccd::cuda::detail {

/// Copies the queries of listed candidates.
template <class Pair>
struct gather_queries {
    positions at;
    cuda::candidates<Pair> candidates;
    const std::uint32_t* numbers;
    query_of_pair<Pair, double>* queries;

    constexpr void operator()(std::uint32_t k) const {
        queries[k] = query_at<double>(at, pair_at(candidates, numbers[k]));
    }
};

struct scatter_answers {
    const std::uint32_t* numbers;
    const outcome* found;
    outcome* answers;

    constexpr void operator()(std::uint32_t k) const { answers[numbers[k]] = found[k]; }
};

/// Decides on the host, by all its threads, what run_exact_stages left open; waits until the
/// answers are written. Returns the counters; if more candidates were left than there are, the
/// memory is not that of these candidates, and nothing is done.
template <class Launcher, class Pair>
exact_counters finish_exact(Launcher& launcher, const positions& at,
                            const candidates<Pair>& candidates, outcome* answers,
                            const exact_memory& memory) {
    using query = query_of_pair<Pair, double>;
    exact_counters counters{};
    launcher.read(memory.counters, 1, &counters);
    if (counters.left > candidates.count) return counters;
    // The queues' memory is free again: for queries on the way out, for answers on the way back.
    const std::size_t at_once = std::max<std::size_t>(
        1, exact_memory::queue_items(candidates.count) * sizeof(std::uint32_t) / sizeof(query));
    auto* const staged = reinterpret_cast<query*>(memory.first);
    auto* const decided = reinterpret_cast<outcome*>(memory.second);
    std::vector<query> queries;
    std::vector<outcome> found;
    for (std::size_t first = 0; first < counters.left && launcher.ok(); first += at_once) {
        const std::size_t count = std::min(at_once, counters.left - first);
        const std::uint32_t* numbers = memory.left + first;
        launcher.for_each(count, gather_queries<Pair>{at, candidates, numbers, staged});
        queries.resize(count);
        launcher.read(staged, count, queries.data());
        found.resize(count);
        decide_batch(std::span<const query>(queries), std::span(found), {.threads = 0});
        launcher.write(decided, count, found.data());
        launcher.for_each(count, scatter_answers{numbers, decided, answers});
    }
    if (counters.left > 0) launcher.wait();
    return counters;
}

/// 1 for an answer other than `separate`.
struct may_collide_at {
    const outcome* answers;
    constexpr std::uint32_t operator()(std::uint32_t i) const {
        return answers[i] != outcome::separate;
    }
};

/// Puts the numbers of such answers where they belong.
struct list_colliding {
    const outcome* answers;
    const std::uint32_t* place;
    std::size_t answer_count;
    vertex_index* found;
    std::size_t room;
    vertex_index* count;

    constexpr void operator()(std::uint32_t i) const {
        if (i == 0) *count = place[answer_count];
        if (answers[i] != outcome::separate && place[i] < room) found[place[i]] = i;
    }
};

/// `place` has room for one number more than there are answers.
template <class Launcher>
void run_select(Launcher& launcher, const outcome* answers, std::size_t answer_count,
                vertex_index* found, std::size_t room, vertex_index* count, std::uint32_t* place) {
    launcher.set(count, vertex_index(0));
    launcher.exclusive_scan(may_collide_at{answers}, place, answer_count);
    launcher.for_each(answer_count,
                      list_colliding{answers, place, answer_count, found, room, count});
}

}  // namespace ccd::cuda::detail
