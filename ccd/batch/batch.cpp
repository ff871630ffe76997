// decide_batch: see include/ccd/batch.hpp.
#include <ccd/batch.hpp>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>

#include "ccd/batch/batch_worker.hpp"
#include "ccd/batch/chunks.hpp"

namespace ccd::detail {
namespace {

template <class Batch>
stage_report decide_chunks(const Batch& batch, std::span<outcome> answers,
                           const batch_options& options, const question& asked) {
    if (batch.size() != answers.size())
        throw std::invalid_argument(std::string(asked.caller) + ": " +
                                    std::to_string(batch.size()) + " queries, but room for " +
                                    std::to_string(answers.size()) + " answers");
    return for_each_chunk(batch.size(), chunk_size, options,
                          [&](batch_worker& worker, std::size_t first, std::size_t count) {
                              batch.decide(worker, first, count, &answers[first]);
                          });
}

}  // namespace

template <class Pair>
stage_report decide_pairs(const vertex_rows& positions, std::span<const Pair> pairs,
                          std::span<outcome> answers, const batch_options& options,
                          const question& asked) {
    return decide_chunks(pair_batch(positions, pairs, asked), answers, options, asked);
}

template <class Query>
stage_report decide_queries(std::span<const Query> queries, std::span<outcome> answers,
                            const batch_options& options, const question& asked) {
    return decide_chunks(query_batch(queries, asked), answers, options, asked);
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
