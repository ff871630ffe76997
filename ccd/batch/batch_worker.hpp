// The state of one thread of a batch or step, with functions that decide blocks of queries.
// Internal.
#pragma once

#include <algorithm>
#include <ccd/contact.hpp>
#include <ccd/explain.hpp>
#include <ccd/kind.hpp>
#include <ccd/verdict.hpp>
#include <optional>
#include <span>

#include "ccd/batch/batch_kernels.hpp"
#include "ccd/exact/stages.hpp"

namespace ccd::detail {

/// Returns `set`, by default the strongest. Throws std::invalid_argument if it is not in
/// instruction_sets().
instruction_set runnable(std::optional<instruction_set> set);

const batch_kernels& kernels_for(std::optional<instruction_set> set);

class batch_worker {
  public:
    batch_worker(const batch_kernels& kernels, bool counted)
        : kernels_(&kernels), counted_(counted) {}

    /// Decides with `exact`. Precondition for pairs: coordinates are finite and indices in range.
    /// Stored queries that are not finite are `uncertain`.
    template <cubic_pair Pair>
    void decide(const batch_positions& positions, std::span<const Pair> queries, outcome* answers) {
        kernels<Pair>().indexed(positions, queries.data(), queries.size(), {}, answers,
                                pauses<Pair>(), counts());
        decide_uncertain(
            queries.size(), [&](std::size_t i) { return query_of(positions.exact, queries[i]); },
            answers);
    }
    template <cubic_query Query>
    void decide(std::span<const Query> queries, outcome* answers) {
        kernels<Query>().stored(queries.data(), queries.size(), answers, pauses<Query>(), counts());
        decide_uncertain(
            queries.size(), [&](std::size_t i) { return queries[i]; }, answers);
    }

    /// Decides which pairs come within `distances`, none of which exceeds `max_distance`. Same
    /// preconditions as decide.
    template <any_pair Pair>
    void decide_within(const batch_positions& positions, std::span<const Pair> queries,
                       const pair_distances& distances, double max_distance, outcome* answers) {
        if constexpr (cubic_pair<Pair>) {
            const distance_request within{
                max_distance, rounded_axes::gaps_beyond(max_distance * positions.scale)};
            kernels<Pair>().indexed(positions, queries.data(), queries.size(), within, answers,
                                    pauses<Pair>(), nullptr);
        } else {
            std::fill_n(answers, queries.size(), outcome::uncertain);
        }
        for (std::size_t i = 0; i < queries.size(); ++i)
            if (answers[i] == outcome::uncertain)
                answers[i] = ccd::decide_within(query_of(positions.exact, queries[i]),
                                                distances.of(queries[i]))
                                 .outcome;
    }

    template <any_pair Pair>
    void find_times(const batch_positions& positions, std::span<const Pair> queries,
                    first_time* times) const {
        const auto query_at = [&](std::size_t i) { return query_of(positions.exact, queries[i]); };
        find_times_by<kind_of<Pair>>(
            queries.size(), query_at,
            [&](const auto& kernels, std::size_t first, std::size_t count, double* low,
                double* high) {
                kernels.indexed_times(positions, &queries[first], count, low, high);
            },
            times);
    }
    template <any_query Query>
    void find_times(std::span<const Query> queries, first_time* times) const {
        const auto query_at = [&](std::size_t i) { return queries[i]; };
        find_times_by<kind_of<Query>>(
            queries.size(), query_at,
            [&](const auto& kernels, std::size_t first, std::size_t count, double* low,
                double* high) { kernels.stored_times(&queries[first], count, low, high); },
            times);
    }

    const stage_report& report() const { return report_; }

  private:
    template <class QueryOrPair>
    const auto& kernels() const {
        return kernels_->of<kind_of<QueryOrPair>>();
    }
    template <class QueryOrPair>
    axes_pauses& pauses() {
        return kind_of<QueryOrPair> == kind::vertex_face ? vertex_face_pauses_ : edge_edge_pauses_;
    }
    stage_report* counts() { return counted_ ? &report_ : nullptr; }

    template <class QueryAt>
    void decide_uncertain(std::size_t count, const QueryAt& query_at, outcome* answers) {
        for (std::size_t i = 0; i < count; ++i) {
            if (answers[i] == outcome::uncertain)
                answers[i] = decide_with_integers(query_at(i), counts()).outcome;
        }
    }

    /// find(kernels, first, count, low, high) calls the kernels for a block of a cubic kind, and
    /// time_of_impact finds the times that they leave undecided.
    template <kind K, class QueryAt, class Find>
    void find_times_by(std::size_t count, const QueryAt& query_at, const Find& find,
                       first_time* times) const {
        if constexpr (is_cubic(K)) {
            constexpr std::size_t block = 256;
            double low[block], high[block];
            for (std::size_t first = 0; first < count; first += block) {
                const std::size_t size = std::min(count - first, block);
                find(kernels_->of<K>(), first, size, low, high);
                for (std::size_t i = 0; i < size; ++i)
                    times[first + i] = low[i] < high[i]
                                           ? first_time{outcome::collides, low[i], high[i]}
                                           : time_of_impact(query_at(first + i));
            }
        } else {
            for (std::size_t i = 0; i < count; ++i) times[i] = time_of_impact(query_at(i));
        }
    }

    const batch_kernels* kernels_;
    axes_pauses vertex_face_pauses_, edge_edge_pauses_;
    stage_report report_;
    bool counted_;
};

}  // namespace ccd::detail
