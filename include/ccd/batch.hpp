// Decides a batch of queries, by SIMD kernels and threads:
//
//     const auto [answers, stages] = ccd::decide_batch(positions, pairs);  // pairs of vertices
//     const auto [answers, stages] = ccd::decide_batch(queries);           // queries by value
//
// answers[i] is the outcome of decide_exact(query i), for every instruction set and number of
// threads. Throws std::invalid_argument if an index is out of range, positions are null or the
// instruction set is not in instruction_sets(). Cost: ./run bench. Memory: some 300 KB of stack for
// each thread, and 32 bytes for each vertex if there are more than half as many queries as
// vertices.
#pragma once

#include <ccd/execution.hpp>
#include <ccd/explain.hpp>
#include <ccd/mesh.hpp>
#include <ccd/verdict.hpp>

namespace ccd {

struct batch_options {
    int threads = 0;                          ///< at most; 0: one per core
    std::optional<instruction_set> set = {};  ///< by default the strongest
    bool explain = false;                     ///< fill batch_result::stages: a few per cent slower
    stop_query stop = {};                     ///< ends the call by throwing ccd::stopped
};

struct batch_result {
    std::vector<outcome> answers;
    stage_report stages;  ///< of vertex/face and edge/edge queries, with batch_options::explain
};

/// Decides queries of one kind by `exact`. A query with a coordinate that is not finite is
/// `uncertain`. Vertex/edge and vertex/vertex queries are decided one by one.
template <pair_range Pairs>
batch_result decide_batch(const vertex_rows& positions, const Pairs& pairs,
                          const batch_options& options = {});
template <query_range Queries>
batch_result decide_batch(const Queries& queries, const batch_options& options = {});

namespace detail {

template <class Item>
stage_report decide_items(const batch_input<Item>& queries, std::span<outcome> answers,
                          const batch_options& options, bool at_start);

template <class Item>
batch_result decide_items(const batch_input<Item>& queries, const batch_options& options,
                          bool at_start) {
    batch_result result{std::vector<outcome>(queries.items.size()), {}};
    result.stages = decide_items(queries, std::span(result.answers), options, at_start);
    return result;
}

}  // namespace detail

template <pair_range Pairs>
batch_result decide_batch(const vertex_rows& positions, const Pairs& pairs,
                          const batch_options& options) {
    return detail::decide_items(detail::input_of(positions, pairs), options, false);
}
template <query_range Queries>
batch_result decide_batch(const Queries& queries, const batch_options& options) {
    return detail::decide_items(detail::input_of(queries), options, false);
}

/// Decides into `answers` and returns the stages' report. Throws std::invalid_argument also if the
/// numbers of queries and answers differ. After an exception `answers` is unspecified.
template <pair_range Pairs>
stage_report decide_batch(const vertex_rows& positions, const Pairs& pairs,
                          std::span<outcome> answers, const batch_options& options = {}) {
    return detail::decide_items(detail::input_of(positions, pairs), answers, options, false);
}
template <query_range Queries>
stage_report decide_batch(const Queries& queries, std::span<outcome> answers,
                          const batch_options& options = {}) {
    return detail::decide_items(detail::input_of(queries), answers, options, false);
}

/// Decides which queries touch at t = 0, as touches_at_start of ccd/exact.hpp. Reads positions at
/// t = 0 only; those at t = 1 may be null.
template <pair_range Pairs>
batch_result touches_at_start_batch(const vertex_rows& positions, const Pairs& pairs,
                                    const batch_options& options = {}) {
    return detail::decide_items(detail::input_of(positions, pairs), options, true);
}
template <query_range Queries>
batch_result touches_at_start_batch(const Queries& queries, const batch_options& options = {}) {
    return detail::decide_items(detail::input_of(queries), options, true);
}

}  // namespace ccd
