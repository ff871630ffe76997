#include <algorithm>
#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <ccd/methods/transform.hpp>
#include <cmath>
#include <cstddef>
#include <optional>

#include "ccd/contact/data/meeting.hpp"
#include "ccd/contact/data/moment.hpp"
#include "ccd/contact/data/normal.hpp"
#include "ccd/contact/data/state.hpp"

namespace ccd::detail {
namespace {

using errbound::sign_type;
using traits = errbound::number_traits<double>;

/// Clamps to [0, most]; NaN becomes 0.
double clamped(double weight, double most) {
    return weight > 0 ? std::min(weight, most) : 0;
}

/// Sets the weights of one feature. From the last on, each is clamped to what the later ones leave
/// of 1; the first gets the remainder. True weights are in [0, 1] and add up to 1, so clamping adds
/// no error. The error of the first is at most the sum of the others' errors. At most two
/// differences, of size up to 1, add ε/4 each; the bound includes three roundings of this sum.
/// Proof: proofs/times/ContactWeights.v, weights_right.
void set_weights(const contact_state& state, const point_numbers& points, std::size_t first,
                 std::size_t count, first_contact& into) {
    double left = 1, error = 0;
    for (std::size_t i = first + count; --i > first;) {
        const auto [value, off] = nearest(state.weights[i]);
        const double weight = clamped(value, left);
        left -= weight;
        error += off;
        into.weights[points[i]] = weight;
    }
    into.weights[points[first]] = left;
    if (count > 1) error = (error + traits::epsilon() / 2) * (1 + 4 * traits::epsilon());
    if (!(error < 1)) error = traits::infinity();
    into.weight_error = std::max(into.weight_error, error);
}

void set_weights(const contact_state& state, const meeting_features& features,
                 first_contact& into) {
    into.weight_error = 0;
    visit_kind(features.kind, [&]<kind K>() {
        constexpr auto first = kind_traits<K>::first_vertices;
        set_weights(state, features.points, 0, first, into);
        set_weights(state, features.points, first, kind_traits<K>::second_vertices, into);
    });
}

void set_normal(const direction& along, normal_source source, bool sided, first_contact& into) {
    into.normal = along.unit;
    into.normal_error = along.error;
    into.normal_from = source;
    into.sided = sided;
}

/// Returns 1 if N points to the side on which the first feature was before the contact, −1 if −N
/// does, nothing if it had no side. `velocity` is relative to the second feature. Y = N·P is 0 at
/// the contact, where its derivative is N times the velocity of P's end. If the derivative has a
/// certain sign, Y had the opposite sign before.
template <class Query>
std::optional<int> side_of(const Query& query, const first_time& time, const enclosed_vector& n,
                           const enclosed_vector& velocity) {
    const sign_type approach = sign_of(dot(n, velocity)[0]);
    if (approach == sign_type::negative) return 1;
    if (approach == sign_type::positive) return -1;
    const sign_type side = side_before(query, time);
    if (side == sign_type::zero) return std::nullopt;
    // P is the vertex relative to the face, or the second edge relative to the first.
    constexpr bool towards_first = kind_of<Query> == kind::vertex_face;
    return (side == sign_type::positive) == towards_first ? 1 : -1;
}

/// Sets the cross product as normal if its side is known, or if there is none to know. Returns true
/// if it did.
template <class Query>
bool set_cross_product(const Query& query, const enclosed_vector& n,
                       const enclosed_vector& velocity, first_contact& into) {
    const bool inside = into.features.kind == kind_of<Query>;
    const auto along = direction_of(n);
    if (!along || !(inside || is_known(*along))) return false;
    const bool start = into.time.at_start();
    // Contacts inside at the start have no side, nor do slivers, whose direction is unknown.
    if (inside && (start || !is_known(*along))) {
        set_normal(*along, normal_source::cross_product, false, into);
        return true;
    }
    const auto side = side_of(query, into.time, n, velocity);
    if (!side) return false;
    set_normal(!start && *side < 0 ? -*along : *along, normal_source::cross_product, !start, into);
    return true;
}

/// Sets the normal opposite to the velocity without its component along the edge that meets. If
/// this vector has no known direction, uses `cross_product` if its direction is known, else the
/// whole velocity.
void set_substitute_normal(const contact_state& state, const enclosed_vector& velocity,
                           const enclosed_vector* cross_product, first_contact& into) {
    const auto set = [&](const enclosed_vector& p, normal_source source, bool sided) {
        const auto along = direction_of(p);
        const bool known = along && is_known(*along);
        if (known) set_normal(*along, source, sided, into);
        return known;
    };
    const bool before = !into.time.at_start();
    enclosed_vector off_edge = -velocity;
    if (into.features.kind == kind::vertex_edge)
        off_edge = cross(state.across, cross(state.across, velocity));
    if (set(off_edge, normal_source::nearest_points, before)) return;
    if (cross_product && set(*cross_product, normal_source::cross_product, false)) return;
    set(-velocity, normal_source::relative_velocity, before);
}

void set_normal_velocity(const enclosed_vector& velocity, int exponent, first_contact& into) {
    const auto component = [&](double x) { return enclosure::within(x, into.normal_error); };
    if (into.normal_from == normal_source::none) return;
    const auto [x, y, z] = into.normal;
    const enclosed_vector n{{{component(x)}}, {{component(y)}}, {{component(z)}}};
    const auto [value, error] = nearest(scale(dot(n, velocity)[0], exponent));
    into.normal_velocity = std::isfinite(value) ? value : 0;
    into.normal_velocity_error = std::isfinite(value) && error >= 0 ? error : traits::infinity();
}

/// True if contact is impossible. In a contact all weights are in [0, 1], those of a feature add up
/// to 1, and both points are equal.
bool certainly_apart(const contact_state& state) {
    const auto is_negative = [](const enclosure& w) { return sign_of(w) == sign_type::negative; };
    return std::ranges::any_of(state.weights, is_negative) ||
           certainly_not_zero(state.motion.position);
}

}  // namespace
}  // namespace ccd::detail

namespace ccd {

template <any_query Query>
first_contact contact_at(const Query& query, const first_time& time) {
    using namespace detail;
    constexpr kind whole = kind_of<Query>;
    first_contact result;
    result.time = time;
    if (time.outcome != outcome::collides) return result;
    const contact_moment at(query, time);
    const contact_state inside = state_inside<whole>(at, whole_query<whole>().points);
    result.features = features_at(query, time, inside.weights);
    const kind met = result.features.kind;
    const contact_state state = met == whole ? inside : visit_kind(met, [&]<kind K>() {
        return state_inside<K>(at, result.features.points);
    });
    if (certainly_apart(state)) {
        result.features = {};
        return result;
    }
    set_weights(state, result.features, result);

    const bool from_second = result.features.points[0] >= kind_traits<whole>::first_vertices;
    const auto velocity = from_second ? -state.motion.velocity : state.motion.velocity;
    if constexpr (is_cubic(whole)) {
        if (!set_cross_product(query, inside.across, velocity, result))
            set_substitute_normal(state, velocity, &inside.across, result);
    } else {
        set_substitute_normal(state, velocity, nullptr, result);
    }
    set_normal_velocity(velocity, at.exponent(), result);
    return result;
}

template first_contact contact_at(const vertex_face<double>&, const first_time&);
template first_contact contact_at(const edge_edge<double>&, const first_time&);
template first_contact contact_at(const vertex_edge<double>&, const first_time&);
template first_contact contact_at(const vertex_vertex<double>&, const first_time&);

}  // namespace ccd
