// decide_batch: checks, then chunks of queries on all threads.
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <ccd/batch.hpp>
#include <ccd/exact.hpp>
#include <ccd/first_times.hpp>
#include <ccd/kind.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "ccd/batch/batch_worker.hpp"
#include "ccd/batch/checks.hpp"
#include "ccd/batch/rounded_positions.hpp"
#include "ccd/batch/threads.hpp"
#include "ccd/exact/finite.hpp"

namespace ccd::detail {
namespace {

/// Queries that a thread takes at a time: enough to make the call cheap, few enough for the second
/// cache.
constexpr std::size_t chunk = 4096;

/// Calls decide(worker, first, count) for chunks of `count` queries. Returns what the stages did.
template <class Decide>
stage_report for_each_chunk(std::size_t count, const batch_options& options, const Decide& decide) {
    const batch_worker fresh(kernels_for(options.set), options.explain);
    if (options.threads == 1 || count <= chunk) {
        batch_worker worker = fresh;
        for (std::size_t first = 0; first < count; first += chunk)
            decide(worker, first, std::min(chunk, count - first));
        return worker.report();
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
    stage_report all;
    for (const batch_worker& worker : workers) all += worker.report();
    return all;
}

void check_lengths(const question& asked, std::size_t queries, std::size_t answers) {
    if (queries != answers)
        throw std::invalid_argument(std::string(asked.caller) + ": " + std::to_string(queries) +
                                    " queries, but room for " + std::to_string(answers) +
                                    " answers");
}

template <class Pair>
bool has_finite_vertices(const vertex_rows& rows, const Pair& pair) {
    return std::ranges::all_of(vertices_of(pair), [&rows](vertex_index v) {
        return all_finite(rows.before + 3 * std::size_t(v), 3) &&
               all_finite(rows.after + 3 * std::size_t(v), 3);
    });
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

template <class QueryOrPair>
constexpr bool has_kernels =
    kind_of<QueryOrPair> == kind::vertex_face || kind_of<QueryOrPair> == kind::edge_edge;

template <class Query>
Query without_motion(const Query& query) {
    constexpr std::size_t count = sizeof(Query) / sizeof(moving_point<double>);
    auto points = std::bit_cast<std::array<moving_point<double>, count>>(query);
    for (auto& p : points) p.t1 = p.t0;
    return std::bit_cast<Query>(points);
}

}  // namespace

template <class Pair>
stage_report decide_pairs(const vertex_rows& positions, std::span<const Pair> pairs,
                          std::span<outcome> answers, const batch_options& options,
                          const question& asked) {
    check_lengths(asked, pairs.size(), answers.size());
    vertex_rows rows = positions;
    if (asked.at_start) rows.after = rows.before;
    check_pointers(asked.caller, rows);
    // Work on every vertex pays only where there are queries enough: rounding one costs some 5 ns,
    // and saves some 10 ns a query.
    const bool many = has_kernels<Pair> && 2 * pairs.size() > rows.vertices;
    const bool all_are_finite = many && all_finite(rows.before, 3 * rows.vertices) &&
                                all_finite(rows.after, 3 * rows.vertices);
    std::optional<rounded_positions> rounded;
    if (all_are_finite) rounded.emplace(rows);
    const batch_positions at = rounded ? batch_positions(rows, *rounded) : batch_positions(rows);
    const double most = asked.within ? asked.within->most() : 0;
    const auto decide = [&](batch_worker& worker, std::span<const Pair> part, outcome* into) {
        if (asked.within)
            worker.decide_within(at, part, *asked.within, most, into);
        else if constexpr (has_kernels<Pair>)
            worker.decide(at, part, into);
        else
            std::ranges::transform(
                part, into, [&](const Pair& p) { return decide_exact(query_of(rows, p)).outcome; });
    };
    return for_each_chunk(pairs.size(), options,
                          [&](batch_worker& worker, std::size_t first, std::size_t count) {
                              const auto part = pairs.subspan(first, count);
                              check_indices(asked.caller, part, first, rows.vertices);
                              decide_finite(
                                  count, &answers[first], all_are_finite,
                                  [&](std::size_t i) { return has_finite_vertices(rows, part[i]); },
                                  [&](std::size_t i, std::size_t n) {
                                      decide(worker, part.subspan(i, n), &answers[first + i]);
                                  });
                          });
}

template <class Query>
stage_report decide_queries(std::span<const Query> queries, std::span<outcome> answers,
                            const batch_options& options, const question& asked) {
    check_lengths(asked, queries.size(), answers.size());
    constexpr std::size_t numbers = sizeof(Query) / sizeof(double);
    const auto decide = [](batch_worker& worker, std::span<const Query> part, outcome* into) {
        if constexpr (has_kernels<Query>)
            worker.decide(part, into);
        else
            std::ranges::transform(part, into,
                                   [](const Query& q) { return decide_exact(q).outcome; });
    };
    return for_each_chunk(
        queries.size(), options, [&](batch_worker& worker, std::size_t first, std::size_t count) {
            auto part = queries.subspan(first, count);
            std::vector<Query> still;
            if (asked.at_start) {
                still.resize(count);
                std::ranges::transform(part, still.begin(), without_motion<Query>);
                part = still;
            }
            const auto* at = reinterpret_cast<const double*>(part.data());
            decide_finite(
                count, &answers[first], all_finite(at, numbers * count),
                [&](std::size_t i) { return all_finite(at + numbers * i, numbers); },
                [&](std::size_t i, std::size_t n) {
                    decide(worker, part.subspan(i, n), &answers[first + i]);
                });
        });
}

template stage_report decide_pairs(const vertex_rows&, std::span<const vertex_face_pair>,
                                   std::span<outcome>, const batch_options&, const question&);
template stage_report decide_queries(std::span<const vertex_face<double>>, std::span<outcome>,
                                     const batch_options&, const question&);
template stage_report decide_pairs(const vertex_rows&, std::span<const edge_edge_pair>,
                                   std::span<outcome>, const batch_options&, const question&);
template stage_report decide_queries(std::span<const edge_edge<double>>, std::span<outcome>,
                                     const batch_options&, const question&);
template stage_report decide_pairs(const vertex_rows&, std::span<const vertex_edge_pair>,
                                   std::span<outcome>, const batch_options&, const question&);
template stage_report decide_queries(std::span<const vertex_edge<double>>, std::span<outcome>,
                                     const batch_options&, const question&);
template stage_report decide_pairs(const vertex_rows&, std::span<const vertex_vertex_pair>,
                                   std::span<outcome>, const batch_options&, const question&);
template stage_report decide_queries(std::span<const vertex_vertex<double>>, std::span<outcome>,
                                     const batch_options&, const question&);

}  // namespace ccd::detail
