// Work after a batch: finishes candidates on the host, and lists those that may collide. Internal.
#pragma once

#include <algorithm>
#include <ccd/batch.hpp>
#include <ccd/contact.hpp>
#include <ccd/cuda.hpp>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ccd/cuda/exact_stages.hpp"
#include "ccd/cuda/launch.hpp"
#include "ccd/cuda/queries.hpp"
#include "ccd/cuda/time_stages.hpp"

namespace ccd::cuda::detail {

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

template <class Answer>
struct scatter_answers {
    const std::uint32_t* numbers;
    const Answer* found;
    Answer* answers;

    constexpr void operator()(std::uint32_t k) const { answers[numbers[k]] = found[k]; }
};

/// Decides the candidates in memory.left by solve(queries) on the host, and waits until the answers
/// are written. Precondition: the stages no longer use `memory`.
template <class Launcher, class Pair, class Answer, class Memory, class Solve>
void finish_left(Launcher& launcher, const positions& at, const candidates<Pair>& candidates,
                 Answer* answers, const Memory& memory, std::size_t left, const Solve& solve) {
    using query = query_of_pair<Pair, double>;
    static_assert(sizeof(Answer) <= sizeof(query));
    // Reuses the queues' memory for queries, then for answers.
    const std::size_t at_once = std::max<std::size_t>(
        1, exact_memory::queue_items(candidates.count) * sizeof(std::uint32_t) / sizeof(query));
    auto* const staged = reinterpret_cast<query*>(memory.first);
    auto* const solved = reinterpret_cast<Answer*>(memory.second);
    std::vector<query> queries;
    for (std::size_t first = 0; first < left && launcher.ok(); first += at_once) {
        const std::size_t count = std::min(at_once, left - first);
        const std::uint32_t* numbers = memory.left + first;
        launcher.for_each(count, gather_queries<Pair>{at, candidates, numbers, staged});
        queries.resize(count);
        launcher.read(staged, count, queries.data());
        const std::vector<Answer> found = solve(std::span<const query>(queries));
        launcher.write(solved, count, found.data());
        launcher.for_each(count, scatter_answers<Answer>{numbers, solved, answers});
    }
    if (left > 0) launcher.wait();
}

/// Decides the undecided candidates of run_exact_stages on all threads of the host. Returns the
/// counters. Does nothing if the counters have more than all candidates left: then `memory` is not
/// that of their stages.
template <class Launcher, class Pair>
exact_counters finish_exact(Launcher& launcher, const positions& at,
                            const candidates<Pair>& candidates, outcome* answers,
                            const exact_memory& memory) {
    exact_counters counters{};
    launcher.read(memory.counters, 1, &counters);
    if (counters.left > candidates.count) return counters;
    finish_left(launcher, at, candidates, answers, memory, counters.left,
                [](const auto& queries) { return decide_batch(queries, {.threads = 0}).answers; });
    return counters;
}

/// Same as finish_exact, for run_time_stages.
template <class Launcher, class Pair>
time_counters finish_times(Launcher& launcher, const positions& at,
                           const candidates<Pair>& candidates, first_time* times,
                           const time_memory& memory) {
    time_counters counters{};
    launcher.read(memory.counters, 1, &counters);
    if (counters.left == 0 || counters.left > candidates.count) return counters;
    double t_max = 0;  // with `earliest`: the earliest time found on the device
    launcher.read(memory.t_max, 1, &t_max);
    finish_left(launcher, at, candidates, times, memory, counters.left, [&](const auto& queries) {
        return first_times(queries, {.t_max = t_max, .threads = 0});
    });
    return counters;
}

struct may_collide_at {
    const outcome* answers;
    constexpr bool operator()(std::uint32_t i) const { return answers[i] != outcome::separate; }
};

template <class IsSelected>
struct list_selected {
    IsSelected is_selected;
    const std::uint32_t* place;
    std::size_t items;
    vertex_index* found;
    std::size_t room;
    vertex_index* count;

    constexpr void operator()(std::uint32_t i) const {
        if (i == 0) *count = place[items];
        if (is_selected(i) && place[i] < room) found[place[i]] = i;
    }
};

/// Lists the items with is_selected(i). `place` has room for items + 1 numbers.
template <class Launcher, class IsSelected>
void run_select(Launcher& launcher, const IsSelected& is_selected, std::size_t items,
                vertex_index* found, std::size_t room, vertex_index* count, std::uint32_t* place) {
    launcher.set(count, vertex_index(0));
    launcher.exclusive_scan(is_selected, place, items);
    launcher.for_each(items,
                      list_selected<IsSelected>{is_selected, place, items, found, room, count});
}

template <class T>
struct copy_rows {
    const T* rows;
    const vertex_index* numbers;
    T* to;
    constexpr void operator()(std::uint32_t k) const { to[k] = rows[numbers[k]]; }
};

template <class Launcher>
class selection {
  public:
    template <class T>
    using buffer = typename Launcher::template buffer<T>;

    /// Waits until the list is complete.
    template <class IsSelected>
    selection& select(Launcher& launcher, const IsSelected& is_selected, std::size_t items) {
        place_.resize(launcher, items + 1);
        numbers_.resize(launcher, items);
        count_.resize(launcher, 1);
        if (!launcher.ok()) return *this;
        run_select(launcher, is_selected, items, numbers_.data(), items, count_.data(),
                   place_.data());
        selected_ = 0;
        launcher.read(count_.data(), 1, &selected_);
        return *this;
    }
    std::size_t size() const { return selected_; }
    const vertex_index* numbers() { return numbers_.data(); }

    /// Copies the rows of the selected items to `to`, after its first `after` rows.
    template <class T>
    void copy(Launcher& launcher, const T* rows, buffer<T>& to, std::size_t after = 0) {
        to.extend(launcher, after + selected_);
        launcher.for_each(selected_, copy_rows<T>{rows, numbers_.data(), to.data() + after});
    }

  private:
    buffer<std::uint32_t> place_;
    buffer<vertex_index> numbers_, count_;
    vertex_index selected_ = 0;
};

}  // namespace ccd::cuda::detail
