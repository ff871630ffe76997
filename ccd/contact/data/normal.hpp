// The direction of a contact's normal, and its side. Internal.
#pragma once

#include <algorithm>
#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <ccd/methods/forms.hpp>
#include <ccd/query.hpp>
#include <cmath>
#include <errbound/bernstein.hpp>
#include <errbound/number_traits.hpp>
#include <errbound/sign.hpp>
#include <optional>

#include "ccd/contact/data/moment.hpp"
#include "ccd/exact/unbounded_integers.hpp"

namespace ccd::detail {

struct estimate {
    double value, error;
};

/// Returns the double nearest to the middle of an enclosure, up to errors of second order. Its
/// `error` bounds the distance to the exact number. (The bound includes the rounding u|value| of
/// the sum and its own four roundings.)
inline estimate nearest(const enclosure& x) {
    using traits = errbound::number_traits<double>;
    const auto [correction, remainder] = x.bound();
    const double value = x.value() + correction;
    const double error =
        (remainder + (std::abs(value) * traits::unit_roundoff() + traits::underflow_unit())) *
        (1 + 4 * traits::epsilon());
    return correction == 0 && remainder == 0 ? estimate{value, 0} : estimate{value, error};
}

struct direction {
    point<double> unit;
    double error;
};
inline direction operator-(const direction& d) {
    return {{-d.unit.x, -d.unit.y, -d.unit.z}, d.error};
}
/// True if the exact direction certainly lies on one side of some plane.
inline bool is_known(const direction& d) {
    return d.error < 1;
}

/// Returns p/|p|; nothing if p's middle is zero or not finite. For vectors p and q, p/|p| and q/|q|
/// are at most |p − q|/m apart, where m is the lesser length. (Dunkl and Williams 1964 have the
/// mean of the lengths for m.) The length has a relative error below 3u, so the quotients have one
/// below 4u. Scaling to sizes near 1 prevents underflow.
inline std::optional<direction> direction_of(const enclosed_vector& p) {
    using traits = errbound::number_traits<double>;
    const int e = excess_exponent(size(p), 0);
    const enclosed_vector moderate = scaled(p, -e);
    const auto [x, y, z] = components(moderate);
    const estimate a = nearest(x), b = nearest(y), c = nearest(z);
    const double length = std::sqrt(a.value * a.value + b.value * b.value + c.value * c.value);
    if (!(length > 0) || !traits::is_finite(length)) return std::nullopt;
    const double off = std::sqrt(a.error * a.error + b.error * b.error + c.error * c.error);
    const double distance =
        length * (1 - 4 * traits::epsilon()) - off * (1 + 8 * traits::epsilon());
    const double error = distance > 0
                             ? off / distance * (1 + 16 * traits::epsilon()) + 2 * traits::epsilon()
                             : traits::infinity();
    return direction{{a.value / length, b.value / length, c.value / length}, error};
}

/// The sign of f just before or just after t/(s + t); zero if f ≡ 0. If f is zero there, its first
/// nonzero derivative determines the sign.
template <int N>
errbound::sign_type sign_beside(const errbound::bernstein<integer, N>& f, const integer& s,
                                const integer& t, bool before) {
    const errbound::sign_type here = errbound::sign_of(value_at(f, s, t));
    if (here != errbound::sign_type::zero) return here;
    if constexpr (N == 0) {
        return here;
    } else {
        const auto slope = sign_beside(derivative(f), s, t, before);
        return before ? -slope : slope;
    }
}

/// The sign of f just before or just after the time t. Exact, in unbounded integers; allocates.
template <int N>
errbound::sign_type sign_beside(const errbound::bernstein<integer, N>& f, double t, bool before) {
    const auto at = errbound::dyadic<integer>::from(t);
    const int unit = std::min(at.exponent(), 0);
    const integer weight = at.in_units(unit);
    const integer rest = errbound::dyadic<integer>::power_of_two(0).in_units(unit) - weight;
    return sign_beside(f, rest, weight, before);
}

/// The sign of Y before the contact: at `low`, if that is not the contact's time. Zero if the
/// motion is planar. Exact, in unbounded integers; allocates.
template <class Query>
errbound::sign_type side_before(const Query& query, const first_time& time) {
    return sign_beside(forms_of(to_integers(query)).y(), time.low, time.low == time.high);
}

}  // namespace ccd::detail
