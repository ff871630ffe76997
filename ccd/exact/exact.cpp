// Exact decisions: the cascade, and its exact stages.
#include <ccd/exact.hpp>
#include <ccd/reference.hpp>

#include "ccd/exact/cascade.hpp"
#include "ccd/exact/integers.hpp"
#include "ccd/exact/stage_timer.hpp"

namespace ccd {
namespace {

template <class Query>
verdict settle_any(const Query& query, stage_report* report) {
    const auto counted = [&](stage s, const auto& decide) {
        stage_timer turn(report, s);
        const verdict answer = decide(query);
        turn.count(1, answer.outcome == outcome::separate, answer.outcome == outcome::collides);
        return answer;
    };
    const verdict fast =
        counted(stage::integers, [](const Query& q) { return decide_integers(q); });
    if (fast.outcome != outcome::uncertain) return fast;
    return counted(stage::unbounded, [](const Query& q) { return decide_reference(q); });
}

template <class Query>
verdict run_cascade(const Query& query, stage_report* report) {
    const verdict filtered = filter(query, report);
    return filtered.outcome == outcome::uncertain ? settle(query, report) : filtered;
}

template <class... Points>
void freeze(Points&... points) {
    ((points.t1 = points.t0), ...);
}

}  // namespace

verdict settle(const vertex_face<double>& query, stage_report* report) {
    return settle_any(query, report);
}
verdict settle(const edge_edge<double>& query, stage_report* report) {
    return settle_any(query, report);
}

verdict decide_exact(const vertex_face<double>& q, stage_report* report) {
    return run_cascade(q, report);
}
verdict decide_exact(const edge_edge<double>& q, stage_report* report) {
    return run_cascade(q, report);
}
verdict decide_exact(const vertex_edge<double>& q) {
    return settle_any(q, nullptr);
}
verdict decide_exact(const vertex_vertex<double>& q) {
    return settle_any(q, nullptr);
}

// The query without motion, decided.
verdict touches_at_start(const vertex_face<double>& q) {
    auto still = q;
    freeze(still.v, still.f0, still.f1, still.f2);
    return decide_exact(still);
}
verdict touches_at_start(const edge_edge<double>& q) {
    auto still = q;
    freeze(still.a0, still.a1, still.b0, still.b1);
    return decide_exact(still);
}
verdict touches_at_start(const vertex_edge<double>& q) {
    auto still = q;
    freeze(still.v, still.e0, still.e1);
    return decide_exact(still);
}
verdict touches_at_start(const vertex_vertex<double>& q) {
    auto still = q;
    freeze(still.v, still.w);
    return decide_exact(still);
}

}  // namespace ccd
