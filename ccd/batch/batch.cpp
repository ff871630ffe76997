#include <ccd/batch.hpp>

#include "ccd/batch/chunks.hpp"

namespace ccd::detail {

template <class Item>
stage_report decide_items(const batch_input<Item>& queries, std::span<outcome> answers,
                          const batch_options& options, bool at_start) {
    const request test{at_start ? "ccd::touches_at_start_batch" : "ccd::decide_batch", at_start};
    return decide_chunks(batch_of(queries, test), answers, options, test);
}

template stage_report decide_items(const batch_input<vertex_face_pair>&, std::span<outcome>,
                                   const batch_options&, bool);
template stage_report decide_items(const batch_input<edge_edge_pair>&, std::span<outcome>,
                                   const batch_options&, bool);
template stage_report decide_items(const batch_input<vertex_edge_pair>&, std::span<outcome>,
                                   const batch_options&, bool);
template stage_report decide_items(const batch_input<vertex_vertex_pair>&, std::span<outcome>,
                                   const batch_options&, bool);
template stage_report decide_items(const batch_input<vertex_face<double>>&, std::span<outcome>,
                                   const batch_options&, bool);
template stage_report decide_items(const batch_input<edge_edge<double>>&, std::span<outcome>,
                                   const batch_options&, bool);
template stage_report decide_items(const batch_input<vertex_edge<double>>&, std::span<outcome>,
                                   const batch_options&, bool);
template stage_report decide_items(const batch_input<vertex_vertex<double>>&, std::span<outcome>,
                                   const batch_options&, bool);

}  // namespace ccd::detail
