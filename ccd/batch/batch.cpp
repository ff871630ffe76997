// decide_batch: checks, then chunks of queries on all threads.
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <ccd/batch.hpp>
#include <stdexcept>
#include <string>

#include "ccd/batch/batch_worker.hpp"
#include "ccd/batch/rounded_positions.hpp"
#include "ccd/batch/threads.hpp"
#include "ccd/exact/finite.hpp"

namespace ccd {
namespace detail {
namespace {

/// Queries that a thread takes at a time: enough to make the call cheap, few enough for the second
/// cache.
constexpr std::size_t chunk = 4096;

/// Calls decide(worker, first, count) for chunks of `count` queries.
template <class Decide>
void for_each_chunk(std::size_t count, const batch_options& options, const Decide& decide) {
    const batch_worker fresh(kernels_for(options.set), options.report != nullptr);
    if (options.threads == 1 || count <= chunk) {
        batch_worker worker = fresh;
        for (std::size_t first = 0; first < count; first += chunk)
            decide(worker, first, std::min(chunk, count - first));
        if (options.report != nullptr) *options.report += worker.report();
        return;
    }
    tbb::enumerable_thread_specific<batch_worker> workers(fresh);
    const std::size_t chunks = (count + chunk - 1) / chunk;
    on_threads(options.threads, [&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, chunks),
                          [&](const tbb::blocked_range<std::size_t>& range) {
                              batch_worker& worker = workers.local();
                              for (std::size_t c = range.begin(); c < range.end(); ++c)
                                  decide(worker, c * chunk, std::min(chunk, count - c * chunk));
                          });
    });
    if (options.report != nullptr)
        for (const batch_worker& worker : workers) *options.report += worker.report();
}

void check_lengths(std::size_t queries, std::size_t answers) {
    if (queries != answers)
        throw std::invalid_argument("ccd::decide_batch: " + std::to_string(queries) +
                                    " queries, but room for " + std::to_string(answers) +
                                    " answers");
}

template <class Pair>
void check_indices(std::span<const Pair> queries, std::size_t first, std::size_t vertices) {
    index largest = 0;
    for (const Pair& q : queries)
        for (const index v : vertices_of(q)) largest = std::max(largest, v);
    if (largest < vertices) return;
    for (std::size_t i = 0; i < queries.size(); ++i)
        for (const index v : vertices_of(queries[i]))
            if (v >= vertices)
                throw std::invalid_argument("ccd::decide_batch: query " +
                                            std::to_string(first + i) + " names vertex " +
                                            std::to_string(v) + " of " + std::to_string(vertices));
}

/// Calls decide(first, count) for the runs of finite queries; the others are uncertain.
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

template <class Pair>
void decide_indexed(const vertex_rows& rows, std::span<const Pair> queries,
                    std::span<outcome> answers, const batch_options& options) {
    check_lengths(queries.size(), answers.size());
    // Work on every vertex pays only where there are queries enough: rounding one costs some 5 ns,
    // and saves some 10 ns a query.
    const bool many = 2 * queries.size() > rows.vertices;
    const bool all_are_finite = many && all_finite(rows.before, 3 * rows.vertices) &&
                                all_finite(rows.after, 3 * rows.vertices);
    std::optional<rounded_positions> rounded;
    if (all_are_finite) rounded.emplace(rows);
    const batch_positions positions{rows, rounded ? rounded->data() : nullptr};
    const auto finite_vertex = [&](index v) {
        return all_finite(rows.before + 3 * std::size_t(v), 3) &&
               all_finite(rows.after + 3 * std::size_t(v), 3);
    };
    for_each_chunk(queries.size(), options,
                   [&](batch_worker& worker, std::size_t first, std::size_t count) {
                       const auto part = queries.subspan(first, count);
                       check_indices(part, first, rows.vertices);
                       decide_finite(
                           count, &answers[first], all_are_finite,
                           [&](std::size_t i) {
                               return std::ranges::all_of(vertices_of(part[i]), finite_vertex);
                           },
                           [&](std::size_t i, std::size_t n) {
                               worker.decide(positions, part.subspan(i, n), &answers[first + i]);
                           });
                   });
}

template <class Query>
void decide_stored(std::span<const Query> queries, std::span<outcome> answers,
                   const batch_options& options) {
    check_lengths(queries.size(), answers.size());
    constexpr std::size_t numbers = sizeof(Query) / sizeof(double);
    for_each_chunk(queries.size(), options,
                   [&](batch_worker& worker, std::size_t first, std::size_t count) {
                       const auto part = queries.subspan(first, count);
                       const auto* at = reinterpret_cast<const double*>(part.data());
                       decide_finite(
                           count, &answers[first], all_finite(at, numbers * count),
                           [&](std::size_t i) { return all_finite(at + numbers * i, numbers); },
                           [&](std::size_t i, std::size_t n) {
                               worker.decide(part.subspan(i, n), &answers[first + i]);
                           });
                   });
}

}  // namespace
}  // namespace detail

void decide_batch(const vertex_rows& positions, std::span<const vertex_face_pair> queries,
                  std::span<outcome> answers, const batch_options& options) {
    detail::decide_indexed(positions, queries, answers, options);
}
void decide_batch(const vertex_rows& positions, std::span<const edge_edge_pair> queries,
                  std::span<outcome> answers, const batch_options& options) {
    detail::decide_indexed(positions, queries, answers, options);
}
void decide_batch(std::span<const vertex_face<double>> queries, std::span<outcome> answers,
                  const batch_options& options) {
    detail::decide_stored(queries, answers, options);
}
void decide_batch(std::span<const edge_edge<double>> queries, std::span<outcome> answers,
                  const batch_options& options) {
    detail::decide_stored(queries, answers, options);
}

}  // namespace ccd
