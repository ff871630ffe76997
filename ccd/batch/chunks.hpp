// Batches of queries, by value or as pairs, in chunks that threads decide. Internal.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <ccd/batch.hpp>
#include <ccd/contact.hpp>
#include <ccd/exact.hpp>
#include <ccd/kind.hpp>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "ccd/batch/batch_worker.hpp"
#include "ccd/batch/checks.hpp"
#include "ccd/batch/rounded_positions.hpp"
#include "ccd/batch/threads.hpp"
#include "ccd/exact/finite.hpp"

namespace ccd::detail {

/// The most queries of a chunk. They fit in the second-level cache, and the cost of a call per
/// chunk is negligible.
constexpr std::size_t chunk_size = 4096;

/// Calls decide(worker, first, count) for chunks of at most `size` queries.
template <class Decide>
stage_report for_each_chunk(std::size_t count, std::size_t size, const batch_options& options,
                            const Decide& decide) {
    const batch_worker fresh(kernels_for(options.set), options.explain);
    if (options.threads == 1 || count <= size) {
        batch_worker worker = fresh;
        for (std::size_t first = 0; first < count; first += size) {
            stop_if_requested(options.stop);
            decide(worker, first, std::min(size, count - first));
        }
        return worker.report();
    }
    const auto another = [&fresh] { return fresh; };
    per_thread<batch_worker> workers(another);
    const std::size_t chunks = (count + size - 1) / size;
    on_threads(options.threads, [&] {
        for_each_range(chunks, 1, [&](std::size_t begin, std::size_t end) {
            batch_worker& worker = workers.local();
            for (std::size_t c = begin; c < end; ++c) {
                stop_if_requested(options.stop);
                decide(worker, c * size, std::min(size, count - c * size));
            }
        });
    });
    stage_report all;
    for (const batch_worker* worker : workers.all()) all += worker->report();
    return all;
}

template <class Pair>
bool has_finite_vertices(const vertex_rows& rows, const Pair& pair) {
    return std::ranges::all_of(vertices_of(pair), [&rows](vertex_index v) {
        return all_finite(rows.before + 3 * std::size_t(v), 3) &&
               all_finite(rows.after + 3 * std::size_t(v), 3);
    });
}

/// Calls decide(first, count) for each run of finite queries; other queries become `uncertain`.
template <class IsFinite, class Decide>
void decide_finite(std::size_t count, outcome* answers, bool all_are_finite,
                   const IsFinite& is_finite, const Decide& decide) {
    if (all_are_finite) {
        decide(std::size_t(0), count);
        return;
    }
    for (std::size_t first = 0, end = 0; first < count; first = end) {
        while (end < count && is_finite(end)) ++end;
        if (end > first) decide(first, end - first);
        if (end < count) answers[end++] = outcome::uncertain;
    }
}

/// The test to run, and the caller's name for error messages.
struct request {
    const char* caller = "ccd::decide_batch";
    bool at_start = false;                   ///< test contact at t = 0 only
    const pair_distances* within = nullptr;  ///< test a distance instead of contact
};

template <class Query>
Query without_motion(const Query& query) {
    constexpr std::size_t count = sizeof(Query) / sizeof(moving_point<double>);
    auto points = std::bit_cast<std::array<moving_point<double>, count>>(query);
    for (auto& p : points) p.t1 = p.t0;
    return std::bit_cast<Query>(points);
}

/// Throws std::invalid_argument, also from decide, with request::caller in the message.
template <class Pair>
class pair_batch {
  public:
    pair_batch(const vertex_rows& positions, std::span<const Pair> pairs, const request& test)
        : rows_(positions), pairs_(pairs), test_(test) {
        if (test.at_start) rows_.after = rows_.before;
        check_pointers(test.caller, rows_);
        if (test.within) max_distance_ = test.within->max_distance();
        // Rounding costs some 5 ns a vertex and saves some 10 ns a query.
        const bool many = cubic_pair<Pair> && 2 * pairs.size() > rows_.vertices;
        all_are_finite_ = many && all_finite(rows_.before, 3 * rows_.vertices) &&
                          all_finite(rows_.after, 3 * rows_.vertices);
        if (all_are_finite_) rounded_.emplace(rows_);
    }
    std::size_t size() const { return pairs_.size(); }

    void decide(batch_worker& worker, std::size_t first, std::size_t count,
                outcome* answers) const {
        const auto part = pairs_.subspan(first, count);
        check_indices(test_.caller, part, first, rows_.vertices);
        decide_finite(
            count, answers, all_are_finite_,
            [&](std::size_t i) { return has_finite_vertices(rows_, part[i]); },
            [&](std::size_t i, std::size_t n) {
                decide_part(worker, part.subspan(i, n), answers + i);
            });
    }

    Pair item(std::size_t i) const { return pairs_[i]; }
    /// The times in [0, 1] of items that collide.
    void find_times(const batch_worker& worker, std::span<const Pair> some,
                    first_time* times) const {
        worker.find_times(positions(), some, times);
    }

  private:
    batch_positions positions() const {
        return rounded_ ? batch_positions(rows_, *rounded_) : batch_positions(rows_);
    }
    void decide_part(batch_worker& worker, std::span<const Pair> part, outcome* answers) const {
        if (test_.within)
            worker.decide_within(positions(), part, *test_.within, max_distance_, answers);
        else if constexpr (cubic_pair<Pair>)
            worker.decide(positions(), part, answers);
        else
            std::ranges::transform(part, answers, [&](const Pair& p) {
                return decide_exact(query_of(rows_, p)).outcome;
            });
    }

    vertex_rows rows_;
    std::span<const Pair> pairs_;
    request test_;
    double max_distance_ = 0;
    bool all_are_finite_;
    std::optional<rounded_positions> rounded_;
};

/// Queries by value; distances are not supported.
template <class Query>
class query_batch {
  public:
    query_batch(std::span<const Query> queries, const request& test)
        : queries_(queries), at_start_(test.at_start) {}
    std::size_t size() const { return queries_.size(); }

    void decide(batch_worker& worker, std::size_t first, std::size_t count,
                outcome* answers) const {
        auto part = queries_.subspan(first, count);
        std::vector<Query> still;
        if (at_start_) {
            still.resize(count);
            std::ranges::transform(part, still.begin(), without_motion<Query>);
            part = still;
        }
        if constexpr (cubic_query<Query>)
            worker.decide(part, answers);
        else
            std::ranges::transform(part, answers,
                                   [](const Query& q) { return decide_exact(q).outcome; });
    }

    const Query& item(std::size_t i) const { return queries_[i]; }
    /// The times in [0, 1] of items that collide.
    void find_times(const batch_worker& worker, std::span<const Query> some,
                    first_time* times) const {
        worker.find_times(some, times);
    }

  private:
    std::span<const Query> queries_;
    bool at_start_;
};

template <class Item>
auto batch_of(const batch_input<Item>& input, const request& test) {
    if constexpr (any_pair<Item>)
        return pair_batch<Item>(input.positions, input.items, test);
    else
        return query_batch<Item>(input.items, test);
}

template <class Batch>
stage_report decide_chunks(const Batch& batch, std::span<outcome> answers,
                           const batch_options& options, const request& test) {
    if (batch.size() != answers.size())
        throw std::invalid_argument(std::string(test.caller) + ": number of answers is " +
                                    std::to_string(answers.size()) + "; expected " +
                                    std::to_string(batch.size()) + ", one for each query");
    return for_each_chunk(batch.size(), chunk_size, options,
                          [&](batch_worker& worker, std::size_t first, std::size_t count) {
                              batch.decide(worker, first, count, &answers[first]);
                          });
}

}  // namespace ccd::detail
