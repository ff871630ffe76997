// Motion along curves: see include/ccd/curves.hpp for what it promises. That there is a first time
// where there is any: proofs/Curves.v, face_curves_first, edges_curves_first, smooth_continuous.
#include <array>
#include <ccd/curves.hpp>
#include <ccd/kind.hpp>
#include <span>

#include "ccd/contact/first_times.hpp"

namespace ccd {
namespace {

template <kind K>
first_time first_within(std::span<const curve> points, separation d, double t_max) {
    return detail::first_within_of<K>(points, d, t_max, detail::arithmetic::floating_point_first);
}

verdict as_verdict(const first_time& found) {
    const bool certain = found.outcome != outcome::uncertain;
    return {found.outcome, certain ? cause::none : cause::range};
}

/// The query's curves, in the order of points_of.
std::array<curve, 4> curves_of(const vertex_face_curves& q) {
    return {q.v, q.f0, q.f1, q.f2};
}
std::array<curve, 4> curves_of(const edge_edge_curves& q) {
    return {q.a0, q.a1, q.b0, q.b1};
}
std::array<curve, 3> curves_of(const vertex_edge_curves& q) {
    return {q.v, q.e0, q.e1};
}
std::array<curve, 2> curves_of(const vertex_vertex_curves& q) {
    return {q.v, q.w};
}

}  // namespace

verdict decide_exact(const vertex_face_curves& q) {
    return as_verdict(time_of_impact(q));
}
verdict decide_exact(const edge_edge_curves& q) {
    return as_verdict(time_of_impact(q));
}
verdict decide_exact(const vertex_edge_curves& q) {
    return as_verdict(time_of_impact(q));
}
verdict decide_exact(const vertex_vertex_curves& q) {
    return as_verdict(time_of_impact(q));
}

first_time time_of_impact(const vertex_face_curves& q, double t_max) {
    return time_within(q, {}, t_max);
}
first_time time_of_impact(const edge_edge_curves& q, double t_max) {
    return time_within(q, {}, t_max);
}
first_time time_of_impact(const vertex_edge_curves& q, double t_max) {
    return time_within(q, {}, t_max);
}
first_time time_of_impact(const vertex_vertex_curves& q, double t_max) {
    return time_within(q, {}, t_max);
}

verdict decide_within(const vertex_face_curves& q, separation d) {
    return as_verdict(time_within(q, d));
}
verdict decide_within(const edge_edge_curves& q, separation d) {
    return as_verdict(time_within(q, d));
}
verdict decide_within(const vertex_edge_curves& q, separation d) {
    return as_verdict(time_within(q, d));
}
verdict decide_within(const vertex_vertex_curves& q, separation d) {
    return as_verdict(time_within(q, d));
}

first_time time_within(const vertex_face_curves& q, separation d, double t_max) {
    return first_within<kind::vertex_face>(curves_of(q), d, t_max);
}
first_time time_within(const edge_edge_curves& q, separation d, double t_max) {
    return first_within<kind::edge_edge>(curves_of(q), d, t_max);
}
first_time time_within(const vertex_edge_curves& q, separation d, double t_max) {
    return first_within<kind::vertex_edge>(curves_of(q), d, t_max);
}
first_time time_within(const vertex_vertex_curves& q, separation d, double t_max) {
    return first_within<kind::vertex_vertex>(curves_of(q), d, t_max);
}

}  // namespace ccd
