// Decides blocks of candidates and keeps the pairs that may collide.
#pragma once

#include <algorithm>
#include <ccd/contact.hpp>
#include <ccd/exact.hpp>
#include <ccd/method.hpp>
#include <ccd/step.hpp>
#include <span>
#include <utility>
#include <vector>

#include "ccd/batch/batch_worker.hpp"
#include "ccd/batch/threads.hpp"
#include "ccd/step/elements.hpp"
#include "ccd/step/order/buckets.hpp"
#include "ccd/step/stopwatch.hpp"

namespace ccd::detail {

template <kind K>
struct pair_list_of_thread {
    std::vector<pair_of_kind<K>> pairs;
};
template <kind K>
using lists_of_threads = per_thread<pair_list_of_thread<K>>;

template <class Pair, class Parts>
std::vector<Pair> take_sorted(Parts& parts) {
    const auto vertex_of = [](const Pair& pair) { return vertices_of(pair)[0]; };
    std::vector<std::vector<Pair>*> lists;
    vertex_index last = 0;
    for (auto* p : parts.all()) {
        lists.push_back(&p->pairs);
        for (const Pair& pair : p->pairs) last = std::max(last, vertex_of(pair));
    }
    if (lists.empty()) return {};
    std::vector<Pair> all = sorted_by_vertex<Pair>(
        lists.size(), last,
        [&](std::size_t list, const auto& visit) {
            for (const Pair& pair : *lists[list]) visit(pair);
        },
        vertex_of);
    for (auto* list : lists) *list = {};
    return all;
}

template <kind K>
class narrow_phase {
  public:
    using pair = pair_of_kind<K>;

    narrow_phase(const batch_positions& positions, const step_options& options)
        : positions_(positions),
          method_(options.method),
          distances_(options.distances),
          max_distance_(options.distances.max_distance()),
          parts_([set = options.set, explain = options.explain] {
              return part{{}, batch_worker(kernels_for(set), explain), {}, 0};
          }) {}

    /// Thread-safe.
    void decide(std::span<const pair> candidates) {
        stopwatch watch;
        part& local = parts_.local();
        if (!distances_.is_contact()) {
            decide_block(local, candidates, [&](outcome* answers) {
                local.worker.decide_within(positions_, candidates, distances_, max_distance_,
                                           answers);
            });
        } else if constexpr (is_cubic(K)) {
            if (method_ == method::exact)
                decide_block(local, candidates, [&](outcome* answers) {
                    local.worker.decide(positions_, candidates, answers);
                });
            else
                keep(local, candidates,
                     [this](const auto& q, const pair&) { return ccd::decide(method_, q); });
        } else {
            keep(local, candidates, [](const auto& q, const pair&) { return decide_exact(q); });
        }
        local.seconds += watch.lap();
    }

    stage_report report() const {
        stage_report sum;
        for (const part* p : parts_.all()) sum += p->worker.report();
        return sum;
    }

    /// The sum over all threads.
    double seconds() const {
        double sum = 0;
        for (const part* p : parts_.all()) sum += p->seconds;
        return sum;
    }

    std::vector<pair> take_pairs() { return take_sorted<pair>(parts_); }

  private:
    struct part {
        std::vector<pair> pairs;
        batch_worker worker;
        std::vector<outcome> answers;
        double seconds = 0;
    };

    template <class Decide>
    void decide_block(part& local, std::span<const pair> candidates, const Decide& decide) {
        local.answers.resize(candidates.size());
        decide(local.answers.data());
        for (std::size_t i = 0; i < candidates.size(); ++i)
            if (local.answers[i] == outcome::collides)
                local.pairs.push_back(canonical(candidates[i]));
    }
    template <class Decide>
    void keep(part& local, std::span<const pair> candidates, const Decide& decide) {
        for (const pair& c : candidates)
            if (ccd::may_collide(decide(query_of(positions_.exact, c), c)))
                local.pairs.push_back(canonical(c));
    }

    batch_positions positions_;
    method method_;
    pair_distances distances_;
    double max_distance_;
    per_thread<part> parts_;
};

}  // namespace ccd::detail
