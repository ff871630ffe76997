// Exact decisions of one query: see include/ccd/exact.hpp for what they promise.
#include <ccd/exact.hpp>
#include <ccd/methods/transform.hpp>

#include "ccd/exact/stages.hpp"

namespace ccd {
namespace {

/// Proof: proofs/Exact.v, exact_face_right, exact_edges_right.
template <class Query>
verdict decide_by_stages(const Query& query, stage_report* report) {
    const verdict answer = detail::decide_in_floating_point(query, report);
    return answer.outcome == outcome::uncertain ? detail::decide_exactly(query, report) : answer;
}

/// The query without motion, decided.
template <class Query>
verdict decide_at_start(const Query& query) {
    return decide_exact(transformed_motions(query, [](const moving_point<double>& p) {
        return moving_point<double>{p.t0, p.t0};
    }));
}

}  // namespace

verdict decide_exact(const vertex_face<double>& query, stage_report* report) {
    return decide_by_stages(query, report);
}
verdict decide_exact(const edge_edge<double>& query, stage_report* report) {
    return decide_by_stages(query, report);
}
verdict decide_exact(const vertex_edge<double>& query) {
    return detail::decide_exactly(query, nullptr);
}
verdict decide_exact(const vertex_vertex<double>& query) {
    return detail::decide_exactly(query, nullptr);
}

verdict touches_at_start(const vertex_face<double>& query) {
    return decide_at_start(query);
}
verdict touches_at_start(const edge_edge<double>& query) {
    return decide_at_start(query);
}
verdict touches_at_start(const vertex_edge<double>& query) {
    return decide_at_start(query);
}
verdict touches_at_start(const vertex_vertex<double>& query) {
    return decide_at_start(query);
}

}  // namespace ccd
