// Proximity of a moving vertex and a moving edge: certainly never within reach, or perhaps.
//
// After the vertex/edge and vertex/vertex tests of SafeCCD (Wang 2014), whose thresholds are
// derived here from any reach. Let E(t) be the edge's vector and W(t) the vertex's place relative
// to its first end, both linear, and let the vertex be within `reach` of the segment at some t°.
//  1. There |E × W|₂ <= reach·|E|₂, so with |x|₁ <= √3·|x|₂ <= 3·|x|∞
//         h(t) = |E × W|₁ − 3·reach·|E|∞ <= 0.
//  2. h is a sum of sizes of quadratics, less a convex function. So its least value on the
//  component
//     of {h <= 0} that holds t° is at 0 or 1, at a root of a component of E × W, or where a signed
//     sum ±q_x ± q_y ± q_z ∓ 3·reach·E_j has its minimum: the CANDIDATES. Rounded ones are exact
//     for quadratics that are off by a few ε times their coefficients (floating_roots.hpp), so
//     that h <= τ at one of those computed, with the τ below. (A rounded minimum
//     of a signed sum may lie beyond a root of one of its terms; by convexity that root will do.)
//  3. If, at that candidate, the edge is longer than λ and the foot of W is on it: proximity.
//  4. Else, between t° and the candidate, either the foot left the edge while the vertex was within
//     d = 3·reach + τ/λ of its line, so that it was within d of an end; or the edge shrank to λ
//     with the foot on it, and the vertex was within √(d² + λ²/4) =: D of an end. The least
//     distances from both ends are compared with D, which is smallest about λ² = 3·τ; λ² is at
//     least four times what its comparison may be off by, and a quarter more in D pays for that.
#pragma once

#include <array>
#include <ccd/methods/forms.hpp>
#include <cmath>
#include <errbound/number_traits.hpp>
#include <errbound/roots/floating_roots.hpp>

namespace ccd {

/// Bounds on the least distance from the origin during the step.
template <class T>
struct distance_bounds {
    T low, high;
};

/// |w(t)|₂ is least where w·w' = 0; a rounded place costs a few ε of the sizes. `w` in power form.
template <class Scalar>
constexpr auto least_distance(const vector_form<Scalar, 1>& w) {
    using T = typename Scalar::value_type;
    using traits = errbound::number_traits<T>;
    T along = 0, speed = 0, size = 0, error = 0;
    for (const auto* x : {&w.x, &w.y, &w.z}) {
        const T at0 = (*x)[0].value(), change = (*x)[1].value();
        along -= at0 * change;
        speed += change * change;
        size += traits::abs(at0) + traits::abs(change);
        error += (*x)[0].error() + (*x)[1].error();
    }
    T t = along / speed;
    if (!(t > 0)) t = 0;  // also NaN: it does not move
    if (t > 1) t = 1;
    T square = 0;
    for (const auto* x : {&w.x, &w.y, &w.z}) {
        const T at_t = (*x)[0].value() + t * (*x)[1].value();
        square += at_t * at_t;
    }
    const T distance = std::sqrt(square);
    // The last term is above whatever squares lose to underflow.
    const T doubt =
        error + 32 * traits::epsilon() * size + std::sqrt(traits::smallest_normal()) * 256;
    return distance_bounds<T>{distance - doubt, distance + doubt};
}

namespace detail {

/// A linear or quadratic polynomial in power form, in plain numbers, and what its values on [0, 1]
/// may be off by.
template <class T, int N>
struct plain_form {
    errbound::bernstein<T, N> p;
    T error = 0;  ///< of any value on [0, 1]
    T size = 0;   ///< the sum of the coefficients' sizes

    template <class Scalar>
    explicit constexpr plain_form(const errbound::bernstein<Scalar, N>& form) {
        using traits = errbound::number_traits<T>;
        for (int i = 0; i <= N; ++i) {
            p[i] = form[i].value();
            size += traits::abs(p[i]);
            error += form[i].error();
        }
        error += 8 * traits::epsilon() * size;
    }
    constexpr T operator()(T t) const {
        T value = p[N];
        for (int i = N - 1; i >= 0; --i) value = value * t + p[i];
        return value;
    }
};

}  // namespace detail

/// False only if the vertex is never within `reach` of the edge. `e`: from the edge's first end to
/// its second; `w0`, `w1`: from each end to the vertex; all in power form. `off_line` raises τ.
template <class Scalar, class T = typename Scalar::value_type>
constexpr bool proximity(const vector_form<Scalar, 1>& e, const vector_form<Scalar, 1>& w0,
                         const vector_form<Scalar, 1>& w1, T reach, T off_line) {
    using traits = errbound::number_traits<T>;
    using quadratic = detail::plain_form<T, 2>;
    using linear = detail::plain_form<T, 1>;
    const auto product = cross(e, w0);
    const std::array<quadratic, 3> q{quadratic(product.x), quadratic(product.y),
                                     quadratic(product.z)};
    const std::array<linear, 3> edge{linear(e.x), linear(e.y), linear(e.z)};
    const std::array<linear, 3> place{linear(w0.x), linear(w0.y), linear(w0.z)};
    const T slope = 3 * reach;

    T error = 0, sizes = 0, edge_error = 0, edge_size = 0, place_error = 0, place_size = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        error += q[i].error, sizes += q[i].size;
        edge_error += edge[i].error, edge_size += edge[i].size;
        place_error += place[i].error, place_size += place[i].size;
    }
    const T tau = traits::max(off_line, error + slope * edge_error +
                                            512 * traits::epsilon() * (sizes + slope * edge_size));
    if (!traits::is_finite(tau)) return true;
    const T doubt = 8 * (edge_error * (edge_size + place_size) + place_error * edge_size) +
                    16 * traits::epsilon() * edge_size * (edge_size + place_size);
    const T lambda_squared = traits::max(3 * tau, 4 * doubt);
    const T line_distance = slope + (tau > 0 ? tau / std::sqrt(lambda_squared) : T(0));
    const T end_distance =
        std::sqrt(line_distance * line_distance + lambda_squared * T(0.3125)) * (1 + T(0x1p-10)) +
        reach;
    if (!(least_distance(w0).low > end_distance && least_distance(w1).low > end_distance))
        return true;

    const auto touches = [&](T t) {
        if (!(t >= 0 && t <= 1)) return false;
        std::array<T, 3> at_e, at_w;
        T off = 0, longest = 0, length_squared = 0, foot = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            off += traits::abs(q[i](t));
            at_e[i] = edge[i](t), at_w[i] = place[i](t);
            longest = traits::max(longest, traits::abs(at_e[i]));
            length_squared += at_e[i] * at_e[i];
            foot += at_e[i] * at_w[i];
        }
        if (off > slope * longest + tau) return false;
        return length_squared > lambda_squared && foot >= -doubt && foot <= length_squared + doubt;
    };
    if (touches(T(0)) || touches(T(1))) return true;
    for (const quadratic& f : q)
        for (const T t : errbound::roots::quadratic_roots(f.p[0], f.p[1], f.p[2]))
            if (touches(t)) return true;
    // Signed sums: the signs of q_y and q_z relative to q_x, and which ±E_j is subtracted.
    for (int signs = 0; signs < 4; ++signs) {
        const T sy = signs & 1 ? -1 : 1, sz = signs & 2 ? -1 : 1;
        const T c1 = q[0].p[1] + sy * q[1].p[1] + sz * q[2].p[1];
        const T c2 = q[0].p[2] + sy * q[1].p[2] + sz * q[2].p[2];
        for (const linear& l : edge)
            for (const T change : {slope * l.p[1], -slope * l.p[1]})
                if (touches(-(c1 + change) / (2 * c2))) return true;
    }
    return false;
}

}  // namespace ccd
