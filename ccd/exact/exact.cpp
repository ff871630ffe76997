#include <ccd/exact.hpp>
#include <ccd/methods/transform.hpp>

#include "ccd/exact/stages.hpp"

namespace ccd {

/// Proof: proofs/contact/Exact.v, exact_face_right, exact_edges_right.
template <any_query Query>
verdict decide_exact(const Query& query, stage_report* report) {
    if constexpr (cubic_query<Query>) {
        const verdict answer = detail::decide_in_floating_point(query, report);
        if (answer.outcome != outcome::uncertain) return answer;
    }
    return detail::decide_with_integers(query, report);
}

template <any_query Query>
verdict touches_at_start(const Query& query) {
    return decide_exact(transformed_motions(query, [](const moving_point<double>& p) {
        return moving_point<double>{p.t0, p.t0};
    }));
}

template verdict decide_exact(const vertex_face<double>&, stage_report*);
template verdict decide_exact(const edge_edge<double>&, stage_report*);
template verdict decide_exact(const vertex_edge<double>&, stage_report*);
template verdict decide_exact(const vertex_vertex<double>&, stage_report*);

template verdict touches_at_start(const vertex_face<double>&);
template verdict touches_at_start(const edge_edge<double>&);
template verdict touches_at_start(const vertex_edge<double>&);
template verdict touches_at_start(const vertex_vertex<double>&);

}  // namespace ccd
