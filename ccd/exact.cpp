// Exact decisions: integers of fixed width, then the reference where those do not tell.
#include <ccd/exact.hpp>
#include <ccd/reference.hpp>

#include "ccd/integers.hpp"

namespace ccd {
namespace {

template <class Query>
verdict decide_either(const Query& query) {
    const verdict fast = decide_integers(query);
    return fast.outcome == outcome::uncertain ? decide_reference(query) : fast;
}

template <class... Points>
void freeze(Points&... points) {
    ((points.t1 = points.t0), ...);
}

}  // namespace

verdict decide_exact(const vertex_face<double>& q) {
    return decide_either(q);
}
verdict decide_exact(const edge_edge<double>& q) {
    return decide_either(q);
}
verdict decide_exact(const vertex_edge<double>& q) {
    return decide_either(q);
}
verdict decide_exact(const vertex_vertex<double>& q) {
    return decide_either(q);
}

// The query without motion, decided.
verdict touches_at_start(const vertex_face<double>& q) {
    auto still = q;
    freeze(still.v, still.f0, still.f1, still.f2);
    return decide_either(still);
}
verdict touches_at_start(const edge_edge<double>& q) {
    auto still = q;
    freeze(still.a0, still.a1, still.b0, still.b1);
    return decide_either(still);
}
verdict touches_at_start(const vertex_edge<double>& q) {
    auto still = q;
    freeze(still.v, still.e0, still.e1);
    return decide_either(still);
}
verdict touches_at_start(const vertex_vertex<double>& q) {
    auto still = q;
    freeze(still.v, still.w);
    return decide_either(still);
}

}  // namespace ccd
