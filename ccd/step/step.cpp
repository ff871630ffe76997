// One step of a mesh: the broad phase hands its candidates to the narrow phase block by block.
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <ccd/batch.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "ccd/batch/batch_worker.hpp"
#include "ccd/batch/rounded_positions.hpp"
#include "ccd/batch/threads.hpp"
#include "ccd/step/broad_phase.hpp"
#include "ccd/step/step_frames.hpp"
#include "ccd/step/step_parts.hpp"

namespace ccd {
namespace {

/// Decides the candidates that it is given and keeps the pairs that may collide.
template <class Pair>
class narrow_phase {
  public:
    narrow_phase(const detail::batch_positions& positions, const step_options& options)
        : positions_(positions),
          method_(options.method),
          parts_(part{
              {}, detail::batch_worker(detail::kernels_for(options.set), options.explain), {}, 0}) {
    }

    /// From any thread.
    template <class Candidate>
    void operator()(std::span<const Candidate> candidates) const {
        stopwatch watch;
        part& local = parts_.local();
        if (method_ == method::exact) {
            local.answers.resize(candidates.size());
            local.worker.decide(positions_, candidates, local.answers.data());
            for (std::size_t i = 0; i < candidates.size(); ++i)
                if (local.answers[i] == outcome::collides)
                    local.pairs.push_back(canonical(candidates[i]));
        } else {
            for (const Candidate& c : candidates)
                if (may_collide(ccd::decide(method_, query_of(positions_.exact, c))))
                    local.pairs.push_back(canonical(c));
        }
        local.seconds += watch.lap();
    }

    /// What the stages of `exact` did, if that was asked for.
    stage_report report() const {
        stage_report sum;
        for (const part& p : parts_) sum += p.worker.report();
        return sum;
    }

    /// Of all threads together.
    double seconds() const {
        double sum = 0;
        for (const part& p : parts_) sum += p.seconds;
        return sum;
    }

    /// All pairs, sorted. Each thread's are released as they are taken.
    std::vector<Pair> take_sorted() {
        std::size_t count = 0;
        for (const part& p : parts_) count += p.pairs.size();
        std::vector<Pair> all;
        all.reserve(count);
        for (part& p : parts_) {
            all.insert(all.end(), p.pairs.begin(), p.pairs.end());
            p.pairs = {};
        }
        tbb::parallel_sort(all.begin(), all.end());
        return all;
    }

  private:
    struct part {
        std::vector<Pair> pairs;
        detail::batch_worker worker;
        std::vector<outcome> answers;
        double seconds = 0;
    };

    detail::batch_positions positions_;
    method method_;
    mutable tbb::enumerable_thread_specific<part> parts_;
};

step_result run_step(const mesh& before, const mesh& after, const step_options& options) {
    stopwatch total, watch;
    step_result result;
    check_step(before, after);
    std::vector<edge> edges = unique_edges(before.faces);
    const vertex_rows rows(before, after);
    const detail::rounded_positions rounded(rows);
    result.prepare_seconds = watch.lap();

    const step_frames frames(before, after);
    narrow_phase<vertex_face_pair> vertex_face({rows, rounded.data()}, options);
    narrow_phase<edge_edge_pair> edge_edge({rows, rounded.data()}, options);
    result.vertex_face_candidates =
        vertex_face_candidates(frames, before.faces, before.vertices.size(), vertex_face);
    result.edge_edge_candidates = edge_edge_candidates(frames, std::move(edges), edge_edge);
    result.narrow_phase_seconds =
        (vertex_face.seconds() + edge_edge.seconds()) / tbb::this_task_arena::max_concurrency();
    result.broad_phase_seconds = watch.lap() - result.narrow_phase_seconds;

    result.vertex_face = vertex_face.take_sorted();
    result.edge_edge = edge_edge.take_sorted();
    result.sort_seconds = watch.lap();
    result.stages = vertex_face.report();
    result.stages += edge_edge.report();
    result.total_seconds = total.lap();
    return result;
}

}  // namespace

step_result step(const mesh& before, const mesh& after, const step_options& options) {
    step_result result;
    const int threads =
        detail::on_threads(options.threads, [&] { result = run_step(before, after, options); });
    result.threads = threads;
    return result;
}

}  // namespace ccd
