// Steps of a mesh: the search hands its candidates to the narrow phase block by block.
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <ccd/batch.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ccd/batch/rounded_positions.hpp"
#include "ccd/batch/threads.hpp"
#include "ccd/step/candidate_search.hpp"
#include "ccd/step/checks.hpp"
#include "ccd/step/narrow_phase.hpp"
#include "ccd/step/stopwatch.hpp"

namespace ccd {
namespace {

template <kind K>
using phase = detail::narrow_phase<K>;

/// All but touching_at_start, on the threads of the arena.
step_result run_step(detail::candidate_search& search, const vertex_rows& positions,
                     const step_options& options) {
    detail::stopwatch watch;
    step_result result;
    const detail::rounded_positions rounded(positions);
    const detail::batch_positions at{positions, rounded.data()};
    result.prepare_seconds = watch.lap();

    by_kind<phase> phases{
        phase<kind::vertex_face>(at, options), phase<kind::edge_edge>(at, options),
        phase<kind::vertex_edge>(at, options), phase<kind::vertex_vertex>(at, options)};
    candidate_visitor visitor;
    for_each_kind([&]<kind K>() {
        visitor.of<K>() = [&](std::span<const pair_of_kind<K>> block) {
            phases.of<K>().decide(block);
        };
    });
    result.candidates = search.find(at, options.filter, visitor);
    for_each_kind([&]<kind K>() { result.narrow_phase_seconds += phases.of<K>().seconds(); });
    result.narrow_phase_seconds /= tbb::this_task_arena::max_concurrency();
    result.broad_phase_seconds = watch.lap() - result.narrow_phase_seconds;

    for_each_kind([&]<kind K>() {
        result.pairs.of<K>() = phases.of<K>().take_pairs();
        result.stages += phases.of<K>().report();
    });
    result.sort_seconds = watch.lap();
    return result;
}

template <class Pair>
std::vector<Pair> touching_at_start(const vertex_rows& positions, const std::vector<Pair>& pairs,
                                    const batch_options& options) {
    const auto answers = touches_at_start_batch(positions, pairs, options).answers;
    std::vector<Pair> found;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (answers[i] == outcome::collides) found.push_back(pairs[i]);
    return found;
}

}  // namespace

struct mesh_steps::state {
    detail::candidate_search search;

    void check(const vertex_rows& positions, const step_options& options) const {
        detail::check_positions(positions, search.vertices());
        detail::check_options(options, search.vertices());
    }
};

mesh_steps::mesh_steps(std::span<const face> faces, std::span<const edge> edges,
                       std::size_t vertices) {
    detail::check_elements(faces, edges, vertices, "ccd::mesh_steps");
    state_ = std::make_unique<state>(state{{faces, edges, vertices}});
}
mesh_steps::mesh_steps(const mesh& mesh)
    : mesh_steps(mesh.faces, mesh.edges, mesh.vertices.size()) {}
mesh_steps::~mesh_steps() = default;
mesh_steps::mesh_steps(mesh_steps&&) noexcept = default;
mesh_steps& mesh_steps::operator=(mesh_steps&&) noexcept = default;

step_result mesh_steps::run(const vertex_rows& positions, const step_options& options) {
    detail::stopwatch total, watch;
    state_->check(positions, options);
    const double check_seconds = watch.lap();
    step_result result;
    const int threads = detail::on_threads(
        options.threads, [&] { result = run_step(state_->search, positions, options); });
    result.threads = threads;
    result.prepare_seconds += check_seconds;
    if (options.initial_contact) {
        watch.lap();
        for_each_kind([&]<kind K>() {
            result.touching_at_start.of<K>() = touching_at_start(
                positions, result.pairs.of<K>(), {.threads = options.threads, .set = options.set});
        });
        result.initial_contact_seconds = watch.lap();
    }
    result.total_seconds = total.lap();
    return result;
}

pair_counts mesh_steps::for_each_candidate(const vertex_rows& positions,
                                           const candidate_visitor& visitor,
                                           const step_options& options) {
    state_->check(positions, options);
    pair_counts counts;
    detail::on_threads(options.threads, [&] {
        const detail::rounded_positions rounded(positions);
        counts = state_->search.find({positions, rounded.data()}, options.filter, visitor);
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

/// For one call alone, with no more threads than it has.
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
    detail::check_frames(before, after);
    return step(before.faces, before.edges, vertex_rows(before, after), options);
}

pair_lists candidates(std::span<const face> faces, std::span<const edge> edges,
                      const vertex_rows& positions, const step_options& options) {
    return steps_once(faces, edges, positions.vertices, options.threads)
        .candidates(positions, options);
}
pair_lists candidates(const mesh& before, const mesh& after, const step_options& options) {
    detail::check_frames(before, after);
    return candidates(before.faces, before.edges, vertex_rows(before, after), options);
}

}  // namespace ccd
