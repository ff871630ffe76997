// First times of a step's pairs, the earliest, and pairs that touch at the start. Internal.
#pragma once

#include <algorithm>
#include <ccd/cuda.hpp>
#include <ccd/kind.hpp>
#include <ccd/mesh.hpp>
#include <ccd/step.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "ccd/contact/time_bracket.hpp"
#include "ccd/cuda/pairs.hpp"
#include "ccd/cuda/step.hpp"
#include "ccd/cuda/time_stages.hpp"
#include "ccd/step/elements.hpp"

namespace ccd::cuda::detail {

struct is_in_time {
    const first_time* times;
    constexpr bool operator()(std::uint32_t i) const {
        return times[i].outcome == outcome::collides;
    }
};
struct is_at_start {
    const first_time* times;
    constexpr bool operator()(std::uint32_t i) const { return times[i].at_start(); }
};

/// For launcher.reduce: the earliest time that is not at the start; `separate` if there is none.
struct time_after_start {
    const first_time* times;
    constexpr first_time operator()(std::uint32_t i) const {
        const first_time& t = times[i];
        return t.outcome == outcome::collides && !t.at_start() ? t : first_time{outcome::separate};
    }
};
struct earlier_time {
    constexpr first_time operator()(const first_time& a, const first_time& b) const {
        if (a.outcome != outcome::collides) return b;
        if (b.outcome != outcome::collides) return a;
        const ccd::detail::time_bracket x{a.low, a.high}, y{b.low, b.high};
        return y < x ? b : a;
    }
};

constexpr bool needs_all_times(const mesh_step_options& options) {
    return options.times || options.t_max < 1;
}
constexpr bool needs_first_contact(const mesh_step_options& options) {
    return options.first_contact || needs_all_times(options);
}
constexpr bool needs_any_time(const mesh_step_options& options) {
    return options.initial_contact || needs_first_contact(options);
}

/// The first contact of a step without pairs: `separate`, or `uncertain` if the options do not
/// require it.
constexpr first_time no_contact(const mesh_step_options& options) {
    return {needs_first_contact(options) ? outcome::separate : outcome::uncertain};
}

template <class Pair>
struct pairs_and_times {
    std::span<const Pair> pairs;        ///< with a contact in [0, t_max]
    std::span<const first_time> times;  ///< of these pairs, with option `times`
    std::span<const Pair> touching_at_start;
};

template <class Launcher, class Pair>
class timed_pairs {
  public:
    template <class T>
    using buffer = typename Launcher::template buffer<T>;

    /// `find(candidates, times, request)` queues first times and returns the number found on the
    /// host, as find_times does. `first` is the earliest time found so far.
    template <class Find>
    std::size_t find_times(Launcher& launcher, std::span<const Pair> pairs,
                           const mesh_step_options& options, first_time& first, const Find& find) {
        found_ = {pairs, {}, {}};
        if (!needs_any_time(options)) return 0;
        times_.resize(launcher, pairs.size());
        if (!launcher.ok()) return 0;
        const auto all = candidates<Pair>::rows(pairs.data(), pairs.size());
        const std::size_t found_on_host =
            pairs.empty() ? 0 : find(all, times_.data(), request_of(options, first));
        found_.times = {times_.data(), pairs.size()};
        found_.touching_at_start =
            selected(launcher, is_at_start{times_.data()}, found_.pairs, touching_);
        if (needs_first_contact(options)) first = earliest(launcher, first);
        if (options.t_max < 1) drop_late(launcher);
        if (!options.times) found_.times = {};
        return found_on_host;
    }

    const pairs_and_times<Pair>& found() const { return found_; }

  private:
    static times_request request_of(const mesh_step_options& options, const first_time& first) {
        if (needs_all_times(options)) return {options.t_max, false};
        if (!options.first_contact) return {0, false};
        return {first.outcome == outcome::collides ? first.high : options.t_max, true};
    }
    template <class IsSelected, class T>
    std::span<const T> selected(Launcher& launcher, const IsSelected& is_selected,
                                std::span<const T> of, buffer<T>& to) {
        selection_.select(launcher, is_selected, times_.size());
        selection_.copy(launcher, of.data(), to);
        return {to.data(), selection_.size()};
    }
    first_time earliest(Launcher& launcher, const first_time& known) {
        earliest_.resize(launcher, 1);
        if (!launcher.ok()) return known;
        launcher.reduce(times_.size(), time_after_start{times_.data()}, earlier_time{}, known,
                        earliest_.data());
        first_time found;
        launcher.read(earliest_.data(), 1, &found);
        return found;
    }
    void drop_late(Launcher& launcher) {
        const is_in_time in_time{times_.data()};
        found_.pairs = selected(launcher, in_time, found_.pairs, pairs_in_time_);
        found_.times = selected(launcher, in_time, found_.times, times_in_time_);
    }

    pairs_and_times<Pair> found_;
    buffer<first_time> times_, times_in_time_, earliest_;
    buffer<Pair> pairs_in_time_, touching_;
    selection<Launcher> selection_;
};

template <class Launcher>
class timed_steps {
  public:
    explicit timed_steps(std::size_t block = step_memory<Launcher>::default_block)
        : memory_(block) {}

    void set_mesh(Launcher& launcher, std::size_t vertices, std::span<const face> faces,
                  std::span<const edge> edges) {
        memory_.set_mesh(launcher, vertices, faces, edges);
    }

    /// `decide`: as in step_memory::run; `find`: as in timed_pairs::find_times.
    template <class Decide, class Find>
    found_pairs run(Launcher& launcher, const positions& at, const mesh_step_options& options,
                    const Decide& decide, const Find& find) {
        found_pairs found = memory_.run(launcher, at, decide);
        first_contact_ = no_contact(options);
        const auto find_times = [&](auto& of_kind, const auto* pairs, std::size_t count) {
            found.finished_on_host += of_kind.find_times(launcher, std::span(pairs, count), options,
                                                         first_contact_, find);
        };
        find_times(vertex_face_, memory_.vertex_face().data(), found.vertex_face);
        find_times(edge_edge_, memory_.edge_edge().data(), found.edge_edge);
        launcher.wait();
        return found;
    }

    const auto& vertex_face() const { return vertex_face_.found(); }
    const auto& edge_edge() const { return edge_edge_.found(); }
    const first_time& first_contact() const { return first_contact_; }

  private:
    step_memory<Launcher> memory_;
    timed_pairs<Launcher, vertex_face_pair> vertex_face_;
    timed_pairs<Launcher, edge_edge_pair> edge_edge_;
    first_time first_contact_;
};

/// Copies a step's lists of one kind to the host, where pairs are in canonical form and order.
template <kind K, class Launcher>
void read_lists(Launcher& launcher, const pairs_and_times<pair_of_kind<K>>& lists,
                ccd::step_result& result) {
    const auto read = [&](const auto& from, auto& to) {
        to.resize(from.size());
        launcher.read(from.data(), from.size(), to.data());
    };
    auto& found = result.pairs.of<K>();
    auto& found_times = result.times.of<K>();
    auto& touching = result.touching_at_start.of<K>();
    read(lists.pairs, found);
    read(lists.times, found_times);
    read(lists.touching_at_start, touching);
    for (auto* const list : {&found, &touching})
        for (auto& pair : *list) pair = ccd::detail::canonical(pair);
    std::ranges::sort(touching);
    if (found_times.empty()) {
        std::ranges::sort(found);
        return;
    }
    std::vector<std::size_t> order(found.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::ranges::sort(
        order, {}, [&](std::size_t i) -> const auto& { return found[i]; });
    const auto reorder = [&](auto& list) {
        auto sorted = list;
        std::ranges::transform(order, sorted.begin(), [&](std::size_t i) { return list[i]; });
        list = std::move(sorted);
    };
    reorder(found_times);
    reorder(found);
}

}  // namespace ccd::cuda::detail
