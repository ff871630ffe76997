// One thread's part of a batch or a step: blocks of queries, decided as they come. Internal.
#pragma once

#include <algorithm>
#include <ccd/batch.hpp>
#include <ccd/contact.hpp>
#include <ccd/explain.hpp>
#include <ccd/first_times.hpp>
#include <ccd/kind.hpp>
#include <ccd/separation.hpp>
#include <ccd/verdict.hpp>
#include <span>

#include "ccd/batch/batch_kernels.hpp"

namespace ccd::detail {

/// `set`, which must be one of instruction_sets(); by default the strongest. Throws
/// std::invalid_argument otherwise.
instruction_set runnable(std::optional<instruction_set> set);

/// The kernels for runnable(set).
const batch_kernels& kernels_for(std::optional<instruction_set> set);

class batch_worker {
  public:
    /// `counted`: fill report().
    batch_worker(const batch_kernels& kernels, bool counted)
        : kernels_(&kernels), counted_(counted) {}

    /// Decides by `exact`. Indexed coordinates must be finite and indices in range; stored queries
    /// that are not finite are uncertain.
    void decide(const batch_positions& positions, std::span<const vertex_face_pair> queries,
                outcome* answers);
    void decide(const batch_positions& positions, std::span<const edge_edge_pair> queries,
                outcome* answers);
    void decide(std::span<const vertex_face<double>> queries, outcome* answers);
    void decide(std::span<const edge_edge<double>> queries, outcome* answers);

    /// Whether pairs come within those distances. The same conditions; `distance` is at least every
    /// pair's.
    template <class Pair>
    void decide_within(const batch_positions& positions, std::span<const Pair> queries,
                       const pair_distances& distances, double distance, outcome* answers) {
        decide_by_floats(positions, queries, distance, answers);
        for (std::size_t i = 0; i < queries.size(); ++i)
            if (answers[i] == outcome::uncertain)
                answers[i] = ccd::decide_within(query_of(positions.exact, queries[i]),
                                                distances.of(queries[i]))
                                 .outcome;
    }

    /// The first times of queries that collide, t in [0, 1]. The same conditions.
    void find_times(const batch_positions& positions, std::span<const vertex_face_pair> queries,
                    first_time* times) const;
    void find_times(const batch_positions& positions, std::span<const edge_edge_pair> queries,
                    first_time* times) const;
    void find_times(std::span<const vertex_face<double>> queries, first_time* times) const;
    void find_times(std::span<const edge_edge<double>> queries, first_time* times) const;
    /// Those of the other kinds one by one.
    template <class Pair>
    void find_times(const batch_positions& positions, std::span<const Pair> queries,
                    first_time* times) const {
        for (const Pair& query : queries)
            *times++ = time_of_impact(query_of(positions.exact, query));
    }
    template <class Query>
    void find_times(std::span<const Query> queries, first_time* times) const {
        for (const Query& query : queries) *times++ = time_of_impact(query);
    }

    const stage_report& report() const { return report_; }

  private:
    void decide_by_floats(const batch_positions& positions,
                          std::span<const vertex_face_pair> queries, double distance,
                          outcome* answers);
    void decide_by_floats(const batch_positions& positions, std::span<const edge_edge_pair> queries,
                          double distance, outcome* answers);
    template <class Pair>
    void decide_by_floats(const batch_positions&, std::span<const Pair> queries, double,
                          outcome* answers) {
        std::fill_n(answers, queries.size(), outcome::uncertain);
    }

    stage_report* counts() { return counted_ ? &report_ : nullptr; }

    const batch_kernels* kernels_;
    axes_pauses vertex_face_pauses_, edge_edge_pauses_;
    stage_report report_;
    bool counted_;
};

}  // namespace ccd::detail
