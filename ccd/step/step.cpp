#include <algorithm>
#include <atomic>
#include <ccd/batch.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "ccd/batch/rounded_positions.hpp"
#include "ccd/batch/threads.hpp"
#include "ccd/step/candidate_blocks.hpp"
#include "ccd/step/candidate_search.hpp"
#include "ccd/step/checks.hpp"
#include "ccd/step/narrow_phase.hpp"
#include "ccd/step/rest/resting_pairs.hpp"
#include "ccd/step/short_steps.hpp"
#include "ccd/step/stopwatch.hpp"

namespace ccd {
namespace {

template <kind K>
using phase = detail::narrow_phase<K>;

by_kind<phase> phases_at(const detail::batch_positions& at, const step_options& options) {
    return {phase<kind::vertex_face>(at, options), phase<kind::edge_edge>(at, options),
            phase<kind::vertex_edge>(at, options), phase<kind::vertex_vertex>(at, options)};
}

/// Collects candidates from several threads, up to a number.
class candidate_store {
  public:
    explicit candidate_store(std::size_t most) : most_(most) {}

    /// Thread-safe.
    template <kind K>
    void add(std::span<const pair_of_kind<K>> block) {
        if ((count_ += block.size()) > most_) return;
        auto& pairs = lists_.of<K>().local().pairs;
        pairs.insert(pairs.end(), block.begin(), block.end());
    }
    /// True if all candidates were stored.
    bool is_complete() const { return count_ <= most_; }
    /// Unsorted.
    pair_lists take() {
        pair_lists all;
        for_each_kind([&]<kind K>() {
            for (const auto* list : lists_.of<K>().all())
                all.of<K>().insert(all.of<K>().end(), list->pairs.begin(), list->pairs.end());
        });
        return all;
    }

  private:
    std::size_t most_;
    std::atomic<std::size_t> count_ = 0;
    by_kind<detail::lists_of_threads> lists_;
};

/// Thread-safe. Decides candidates in blocks.
template <kind K>
void decide_all(phase<K>& by, std::span<const pair_of_kind<K>> candidates, const stop_query& stop) {
    constexpr std::size_t block = 2048;
    detail::for_each_range(candidates.size(), block, [&](std::size_t begin, std::size_t end) {
        detail::stop_if_requested(stop);
        by.decide(candidates.subspan(begin, end - begin));
    });
}

detail::wanted_candidates candidates_for(const step_options& options, bool spare) {
    if (options.count_candidates || options.explain || options.method != method::exact) return {};
    return {.close = options.distances.is_contact(), .t_max = options.t_max, .spare = spare};
}

void find_start(detail::candidate_search& search, std::optional<detail::vertex_fans>& fans,
                const vertex_rows& positions, const step_options& options,
                const detail::batch_positions& at, step_result& result) {
    const intersection_options at_start{
        .segments = false, .set = options.set, .stop = options.stop, .filter = options.filter};
    result.intersections_at_start =
        detail::find_intersections(search, fans, positions, at_start, &at).pairs;
}

/// True if pairs at rest are those of any other step.
bool keeps_rest(const step_options& options) {
    return options.method == method::exact && options.distances.is_contact() &&
           detail::lets_all_through(options.filter);
}

/// Runs a step, except first times and contacts at the start. With a store, the search includes
/// ways that short_way's `spare` covers. Pairs that `resting` keeps are not searched for, if
/// `is_listed`: its moving vertices are those of this step.
step_result run_step(detail::candidate_search& search, std::optional<detail::vertex_fans>& fans,
                     const vertex_rows& positions, const step_options& options,
                     candidate_store* store, detail::resting_pairs& resting, bool is_listed) {
    detail::stopwatch watch;
    step_result result;
    detail::kept_positions& kept = resting.positions();
    is_listed ? kept.round_active(positions) : kept.round_all(positions);
    const detail::batch_positions at(positions, kept.rounded());
    result.prepare_seconds = watch.lap();

    by_kind<phase> phases = phases_at(at, options);
    candidate_visitor visitor;
    for_each_kind([&]<kind K>() {
        visitor.of<K>() = [&](std::span<const pair_of_kind<K>> block) {
            phases.of<K>().decide(block);
            if (store != nullptr) store->add<K>(block);
        };
    });
    const bool counted = options.count_candidates || options.explain;
    detail::wanted_candidates wanted = candidates_for(options, store != nullptr);
    if (is_listed) wanted.kept = &kept;
    const pair_counts counts = search.find(at, options, visitor, wanted);
    if (search.skipped_rest()) {
        decide_all<kind::vertex_face>(phases.vertex_face, resting.at_rest<kind::vertex_face>(),
                                      options.stop);
        decide_all<kind::edge_edge>(phases.edge_edge, resting.at_rest<kind::edge_edge>(),
                                    options.stop);
    } else {
        kept.forget_rounded();
    }
    if (counted) result.candidates = counts;
    for_each_kind([&]<kind K>() { result.narrow_phase_seconds += phases.of<K>().seconds(); });
    result.narrow_phase_seconds /= static_cast<double>(detail::threads_here());
    result.broad_phase_seconds = watch.lap() - result.narrow_phase_seconds;

    for_each_kind([&]<kind K>() {
        result.pairs.of<K>() = phases.of<K>().take_pairs();
        result.stages += phases.of<K>().report();
    });
    if (keeps_rest(options) && options.t_max >= 1 && store == nullptr)
        resting.keep(positions, result.pairs);
    result.sort_seconds = watch.lap();

    if (options.check_start) {
        find_start(search, fans, positions, options, at, result);
        result.start_seconds = watch.lap();
    }
    return result;
}

template <class Item, class IsWanted>
std::vector<Item> selected(const std::vector<Item>& items, const IsWanted& is_wanted) {
    std::vector<Item> wanted;
    for (std::size_t i = 0; i < items.size(); ++i)
        if (is_wanted(i)) wanted.push_back(items[i]);
    return wanted;
}

/// Computes the time of each reported pair. Drops pairs whose time is after t_max.
template <kind K>
void find_times(const vertex_rows& positions, const time_options& options, bool keep_times,
                step_result& result) {
    auto& pairs = result.pairs.of<K>();
    std::vector<first_time> times = first_times(positions, pairs, options);
    const auto in_time = [&](std::size_t i) { return times[i].outcome == outcome::collides; };
    pairs = selected(pairs, in_time);
    times = selected(times, in_time);
    result.touching_at_start.of<K>() =
        selected(pairs, [&](std::size_t i) { return times[i].at_start(); });
    for (std::size_t i = 0; i < times.size(); ++i)
        if (!times[i].at_start()) detail::add_first(times[i], pairs[i], result);
    if (keep_times) result.times.of<K>() = std::move(times);
}

time_options timing_of(const step_options& options) {
    return {options.t_max, options.distances, options.threads, options.set, options.stop};
}

template <kind K>
void find_first(const vertex_rows& positions, time_options options, step_result& result) {
    const auto& pairs = result.pairs.of<K>();
    if (result.first_contact.outcome == outcome::collides)
        options.t_max = std::min(options.t_max, result.first_contact.high);
    const earliest_time found = earliest(positions, pairs, options);
    for (const std::size_t i : found.queries) detail::add_first(found.time, pairs[i], result);
    for (const std::size_t i : found.at_start) result.touching_at_start.of<K>().push_back(pairs[i]);
}

template <kind K>
void find_touching_at_start(const vertex_rows& positions, time_options options,
                            step_result& result) {
    const auto& pairs = result.pairs.of<K>();
    options.t_max = 0;
    std::vector<outcome> answers;
    if (options.distances.is_contact())
        answers = touches_at_start_batch(
                      positions, pairs,
                      {.threads = options.threads, .set = options.set, .stop = options.stop})
                      .answers;
    else
        for (const first_time& time : first_times(positions, pairs, options))
            answers.push_back(time.outcome);
    result.touching_at_start.of<K>() =
        selected(pairs, [&](std::size_t i) { return answers[i] == outcome::collides; });
}

void find_pair_times(const vertex_rows& positions, const step_options& options,
                     step_result& result) {
    const time_options timing = timing_of(options);
    if (options.times || options.first_contact || options.t_max < 1)
        result.first_contact = {outcome::separate};
    for_each_kind([&]<kind K>() {
        if (options.times || options.t_max < 1)
            find_times<K>(positions, timing, options.times, result);
        else if (options.first_contact)
            find_first<K>(positions, timing, result);
        else if (options.initial_contact)
            find_touching_at_start<K>(positions, timing, result);
    });
}

}  // namespace

struct mesh_steps::state {
    detail::candidate_search search;
    std::optional<detail::vertex_fans> fans = {};
    detail::resting_pairs resting = {};

    /// Lists the moving vertices if `lists_moving`, and returns true if they were listed.
    bool check(const vertex_rows& positions, const step_options& options, const std::string& caller,
               bool lists_moving = false) {
        detail::check_rows(positions, search.vertices(), caller);
        const bool is_listed = lists_moving && resting.find_moving(positions, options.filter);
        // Kept positions are finite.
        if (!is_listed || !detail::are_finite(positions, resting.positions().moving()))
            detail::check_positions(positions, search.vertices(), caller);
        if (search.is_in_plane()) detail::check_plane(positions, caller);
        detail::check_options(options, search.vertices(), caller);
        return is_listed;
    }
};

mesh_steps::mesh_steps(std::span<const face> faces, std::span<const edge> edges,
                       std::size_t vertices) {
    detail::check_elements(faces, edges, vertices, "ccd::mesh_steps");
    state_ = std::make_unique<state>(state{{faces, edges, vertices}});
}
mesh_steps::mesh_steps(std::unique_ptr<state> whole) : state_(std::move(whole)) {}
mesh_steps mesh_steps::in_plane(std::span<const edge> edges, std::size_t vertices) {
    detail::check_elements({}, edges, vertices, "ccd::mesh_steps");
    return mesh_steps(
        std::make_unique<state>(state{detail::candidate_search::in_plane(edges, vertices)}));
}
mesh_steps::mesh_steps(const mesh& mesh)
    : mesh_steps(mesh.faces, mesh.edges, mesh.vertices.size()) {}
mesh_steps::~mesh_steps() = default;
mesh_steps::mesh_steps(mesh_steps&&) noexcept = default;
mesh_steps& mesh_steps::operator=(mesh_steps&&) noexcept = default;

step_result mesh_steps::run(const vertex_rows& positions, const step_options& options) {
    detail::stopwatch total, watch;
    const bool is_listed = state_->check(positions, options, "ccd::step", keeps_rest(options));
    const double check_seconds = watch.lap();
    step_result result;
    const int threads = detail::on_threads(options.threads, [&] {
        result = run_step(state_->search, state_->fans, positions, options, nullptr,
                          state_->resting, is_listed);
    });
    result.threads = threads;
    result.prepare_seconds += check_seconds;
    watch.lap();
    find_pair_times(positions, options, result);
    result.contact_seconds = watch.lap();
    result.total_seconds = total.lap();
    return result;
}

intersection_result mesh_steps::intersections(const vertex_rows& positions,
                                              const intersection_options& options) {
    detail::stopwatch watch;
    auto& search = state_->search;
    detail::check_at_rest(positions, search.vertices(), options.filter, search.is_in_plane());
    intersection_result result;
    detail::on_threads(options.threads, [&] {
        result = detail::find_intersections(search, state_->fans, positions, options);
    });
    result.seconds = watch.lap();
    return result;
}

namespace detail {

void short_steps::check(const vertex_rows& way, const step_options& options,
                        const std::string& caller) const {
    steps_.state_->check(way, options, caller);
}

first_time short_steps::first_of_sample(const vertex_rows& way, const step_options& options) {
    mesh_steps::state& state = *steps_.state_;
    state.check(way, options, "ccd::step");
    candidate_store found(std::numeric_limits<std::size_t>::max());
    on_threads(options.threads, [&] {
        const rounded_positions rounded(way);
        candidate_visitor visitor;
        visitor.edge_edge = [&](auto block) { found.add<kind::edge_edge>(block); };
        state.search.find({way, rounded}, options, visitor, {.close = true, .sample = true});
    });
    return earliest(way, found.take().edge_edge, timing_of(options)).time;
}

step_result short_steps::run(const vertex_rows& way, const step_options& options) {
    mesh_steps::state& state = *steps_.state_;
    state.check(way, options, "ccd::step");
    constexpr std::size_t for_each_vertex = 16;
    candidate_store store(for_each_vertex * way.vertices);
    step_result result;
    on_threads(options.threads, [&] {
        result = run_step(state.search, state.fans, way, options, &store, state.resting, false);
    });
    result.first_contact = {outcome::separate};
    for_each_kind([&]<kind K>() { find_first<K>(way, timing_of(options), result); });
    has_candidates_ = store.is_complete();
    candidates_ = has_candidates_ ? store.take() : pair_lists();
    return result;
}

pair_lists short_steps::pairs_on(const vertex_rows& way, const step_options& options) {
    steps_.state_->check(way, options, "ccd::step");
    pair_lists pairs;
    on_threads(options.threads, [&] {
        const rounded_positions rounded(way);
        by_kind<phase> phases = phases_at({way, rounded}, options);
        for_each_kind([&]<kind K>() {
            decide_all<K>(phases.of<K>(), candidates_.of<K>(), options.stop);
            pairs.of<K>() = phases.of<K>().take_pairs();
        });
    });
    return pairs;
}

}  // namespace detail

pair_counts mesh_steps::for_each_candidate(const vertex_rows& positions,
                                           const candidate_visitor& visitor,
                                           const step_options& options) {
    state_->check(positions, options, "ccd::step");
    pair_counts counts;
    detail::on_threads(options.threads, [&] {
        const detail::rounded_positions rounded(positions);
        counts = state_->search.find({positions, rounded}, options, visitor);
    });
    return counts;
}

pair_lists mesh_steps::candidates(const vertex_rows& positions, const step_options& options) {
    by_kind<detail::lists_of_threads> found;
    candidate_visitor visitor;
    for_each_kind([&]<kind K>() {
        visitor.of<K>() = [&](std::span<const pair_of_kind<K>> block) {
            auto& pairs = found.of<K>().local().pairs;
            pairs.insert(pairs.end(), block.begin(), block.end());
        };
    });
    for_each_candidate(positions, visitor, options);
    pair_lists sorted;
    detail::on_threads(options.threads, [&] {
        for_each_kind([&]<kind K>() {
            sorted.of<K>() = detail::take_sorted<pair_of_kind<K>>(found.of<K>());
        });
    });
    return sorted;
}

namespace {

/// For a single call, with at most its number of threads.
mesh_steps steps_once(std::span<const face> faces, std::span<const edge> edges,
                      std::size_t vertices, int threads) {
    std::optional<mesh_steps> steps;
    detail::on_threads(threads, [&] { steps.emplace(faces, edges, vertices); });
    return std::move(*steps);
}

}  // namespace

step_result step(std::span<const face> faces, std::span<const edge> edges,
                 const vertex_rows& positions, const step_options& options) {
    detail::stopwatch watch;
    mesh_steps steps = steps_once(faces, edges, positions.vertices, options.threads);
    const double seconds = watch.lap();
    step_result result = steps.run(positions, options);
    result.prepare_seconds += seconds;
    result.total_seconds += seconds;
    return result;
}
step_result step(const mesh& before, const mesh& after, const step_options& options) {
    detail::check_frames(before, after, "ccd::step");
    return step(before.faces, before.edges, vertex_rows(before, after), options);
}

pair_lists candidates(std::span<const face> faces, std::span<const edge> edges,
                      const vertex_rows& positions, const step_options& options) {
    return steps_once(faces, edges, positions.vertices, options.threads)
        .candidates(positions, options);
}
pair_lists candidates(const mesh& before, const mesh& after, const step_options& options) {
    detail::check_frames(before, after, "ccd::candidates");
    return candidates(before.faces, before.edges, vertex_rows(before, after), options);
}

}  // namespace ccd
