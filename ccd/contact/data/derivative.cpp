// The derivative of a first time, from the data of its contact.
//
// Points i with weights w_i (those of the second feature negative) meet at the first time t: the
// sum of w_i x_i(t) is 0. Let n be the normal, and g the component of this sum along n. If a
// position changes, the derivatives of weights move the sum along the features, so not along n, and
// that of n has the factor 0. So dg = n · (sum of w_i dx_i(t)) + v dt, where v is the normal
// velocity. Since g = 0 at contacts and x_i(t) = (1 − t) x_i(0) + t x_i(1),
//
//     dt/dx_i(0) = −w_i (1 − t) n/v,   dt/dx_i(1) = −w_i t n/v.
#include <algorithm>
#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <ccd/methods/transform.hpp>
#include <cmath>
#include <cstddef>

#include "ccd/contact/data/moment.hpp"
#include "ccd/contact/data/normal.hpp"

namespace ccd::detail {
namespace {

/// True if the first time is differentiable wherever the normal velocity is not 0. `contact` has
/// exact features. If they are the query's, all weights are positive and N (or the edge) is not 0.
/// After a small change the features then meet at the same root.
template <class Query>
bool may_be_differentiable(const Query& query, const first_contact& contact) {
    constexpr kind whole = kind_of<Query>;
    if (contact.time.outcome != outcome::collides || contact.time.at_start()) return false;
    if (contact.features.kind != whole) return false;
    if constexpr (is_cubic(whole)) return contact.normal_from == normal_source::cross_product;
    if constexpr (whole == kind::vertex_edge) {
        const double z = query.v.t0.z;
        bool in_plane = contact.normal_from == normal_source::nearest_points;
        for (const auto& p : points_of(query)) in_plane = in_plane && p.t0.z == z && p.t1.z == z;
        return in_plane;
    }
    return false;
}

}  // namespace
}  // namespace ccd::detail

namespace ccd {

template <any_query Query>
time_derivative derivative_of(const Query& query, const first_contact& contact) {
    using namespace detail;
    constexpr double infinity = errbound::number_traits<double>::infinity();
    time_derivative result;
    if (!may_be_differentiable(query, contact)) return result;
    const enclosure t = enclosed_time(contact.time), s = enclosure(1.0) - t;
    const auto v = enclosure::within(contact.normal_velocity, contact.normal_velocity_error);
    result.error = 0;
    const auto component = [&](const enclosure& factor, double normal) {
        const enclosure n = enclosure::within(normal, contact.normal_error);
        const auto [value, error] = nearest(factor * n);
        const bool known = std::isfinite(value) && error >= 0;
        result.error = std::max(result.error, known ? error : infinity);
        return value;
    };
    const auto vector = [&](const enclosure& factor) {
        const auto [x, y, z] = contact.normal;
        return point<double>{component(factor, x), component(factor, y), component(factor, z)};
    };
    constexpr std::size_t first = kind_traits<kind_of<Query>>::first_vertices;
    for (std::size_t i = 0; i < points_of(query).size(); ++i) {
        // The quotient's error is infinite if the root may be multiple.
        const auto weight = enclosure::within(contact.weights[i], contact.weight_error);
        const enclosure factor = (i < first ? -weight : weight) / v;
        result.by[i] = {vector(factor * s), vector(factor * t)};
    }
    return result.is_defined() ? result : time_derivative{};
}

template time_derivative derivative_of(const vertex_face<double>&, const first_contact&);
template time_derivative derivative_of(const edge_edge<double>&, const first_contact&);
template time_derivative derivative_of(const vertex_edge<double>&, const first_contact&);
template time_derivative derivative_of(const vertex_vertex<double>&, const first_contact&);

}  // namespace ccd
