// SafeCCD: cubic root finding whose tolerances absorb every rounding error, over any bound rule.
//
//   decide_safeccd<safe>    `safeccd`: tolerances from one uniform bound on all coordinates
//   decide_safeccd<tight>   `safeccd-tight`: tolerances from each variable's own bound
//
// docs/other-methods.md, "SafeCCD", shows that no contact is lost, and lists differences from the
// published method. Sources: Wang 2014, Defending continuous collision detection against errors;
// Wang, Tang, Tong, Manocha 2015, Section 6 (SafeCCD with TightBound).
#pragma once

#include <algorithm>
#include <array>
#include <ccd/methods/forms.hpp>
#include <ccd/methods/least_distance.hpp>
#include <ccd/methods/proximity.hpp>
#include <ccd/methods/safeccd_tolerances.hpp>
#include <ccd/methods/tracked_query.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/verdict.hpp>
#include <cmath>
#include <cstddef>
#include <errbound/roots/floating_roots.hpp>
#include <errbound/tracked.hpp>
#include <type_traits>

namespace ccd {
namespace safeccd {

using errbound::sign_type;

/// The value's sign, if a change of `drift` cannot reverse it.
template <class Scalar, class T>
constexpr sign_type sign_within(const Scalar& x, T drift) {
    const T e = x.error() + drift;
    if (x.value() > e) return sign_type::positive;
    return x.value() < -e ? sign_type::negative : sign_type::uncertain;
}

template <class Scalar>
constexpr auto upper_magnitude(const Scalar& x) {
    return number_traits<typename Scalar::value_type>::abs(x.value()) + x.error();
}

template <class T, class Rule, template <class> class Query>
class solver {
  public:
    using scalar = errbound::tracked<T, Rule>;
    using traits = number_traits<T>;

    explicit constexpr solver(const Query<scalar>& query)
        : query_(query), limits_(query), forms_(power_forms(query, limits_)) {}

    constexpr verdict decide() {
        if (!limits_.usable) return {outcome::uncertain, cause::range};
        const auto f = forms_.y();
        errbound::bernstein<T, 3> plain;
        for (int i = 0; i <= 3; ++i) {
            if (!traits::is_finite(f[i].error()) || !traits::is_finite(f[i].value()))
                return {outcome::uncertain, cause::range};
            plain[i] = f[i].value();
        }
        const auto slope = errbound::roots::power_derivative(f);
        const T vertex = errbound::roots::quadratic_roots(slope[0].value(), slope[1].value(),
                                                          slope[2].value())[2];
        const auto pieces = errbound::roots::monotone_pieces(plain);
        for (std::size_t i = 1; i < pieces.count; ++i) {
            const verdict found = on_piece(f, plain, slope, vertex, pieces.at[i - 1], pieces.at[i]);
            if (found.outcome != outcome::separate) return found;
        }
        if (!doubt_) return {outcome::separate, cause::none};
        return any_proximity() ? verdict{outcome::uncertain, cause::coplanarity}
                               : verdict{outcome::separate, cause::none};
    }

  private:
    using limits = tolerances<T, Rule>;

    /// q − p in power form: the position at t = 0, then the displacement.
    static constexpr vector_form<scalar, 1> motion(const moving_point<scalar>& q,
                                                   const moving_point<scalar>& p, const limits& l) {
        const auto along = [&](scalar point<scalar>::*axis) {
            return errbound::bernstein<scalar, 1>{
                {l.difference(q.t0.*axis, p.t0.*axis),
                 l.displacement(q.t1.*axis, q.t0.*axis) - l.displacement(p.t1.*axis, p.t0.*axis)}};
        };
        return {along(&point<scalar>::x), along(&point<scalar>::y), along(&point<scalar>::z)};
    }
    static constexpr auto power_forms(const vertex_face<scalar>& q, const limits& l) {
        return vertex_face_forms<scalar>(motion(q.f1, q.f0, l), motion(q.f2, q.f0, l),
                                         motion(q.v, q.f0, l));
    }
    static constexpr auto power_forms(const edge_edge<scalar>& q, const limits& l) {
        return edge_edge_forms<scalar>(motion(q.a1, q.a0, l), motion(q.b1, q.b0, l),
                                       motion(q.b0, q.a0, l));
    }

    template <int N>
    static constexpr scalar at(const errbound::bernstein<scalar, N>& p, T t) {
        return value_at(p, scalar(T(1)), scalar(t));
    }

    /// How far f may move against `direction` on [p, q]: the length times a bound on how far f'
    /// times direction falls below zero. Takes the better of two bounds on the least f'. One is the
    /// least of its Bernstein coefficients on [p, q], each certified. The other is the least
    /// computed f', at an end or at its vertex, minus errors: those of coefficients, of evaluation
    /// and of the vertex (second order). The true f' may have its vertex anywhere.
    constexpr T slack_of(const errbound::bernstein<scalar, 2>& slope, T vertex, T direction, T p,
                         T q) const {
        const auto low_end = [&](const scalar& x) { return direction * x.value() - x.error(); };
        const scalar at_p = at(slope, p), at_q = at(slope, q);
        const scalar half_length = (scalar(q) - scalar(p)) * scalar(T(0.5));
        const scalar middle = at_p + at(errbound::roots::power_derivative(slope), p) * half_length;
        const T hull = (std::min)({low_end(at_p), low_end(middle), low_end(at_q)});

        T least = (std::min)(direction * at_p.value(), direction * at_q.value());
        if (vertex > p && vertex < q)
            least = (std::min)(least, direction * at(slope, vertex).value());
        for (int i = 0; i <= 2; ++i)
            least -= slope[i].error() + 16 * traits::epsilon() * traits::abs(slope[i].value());

        const T low = (traits::max)(hull, least);
        // NaN is unbounded.
        return low >= 0 ? T(0) : low < 0 ? -low * (q - p) * (1 + T(0x1p-10)) : traits::infinity();
    }

    constexpr verdict on_piece(const errbound::bernstein<scalar, 3>& f,
                               const errbound::bernstein<T, 3>& plain,
                               const errbound::bernstein<scalar, 2>& slope, T vertex, T p, T q) {
        constexpr verdict none{outcome::separate, cause::none};
        const scalar at_p = at(f, p), at_q = at(f, q);
        const T direction = at_q.value() >= at_p.value() ? 1 : -1;
        const T slack = slack_of(slope, vertex, direction, p, q);
        const auto tolerance = [&](const scalar& x) {
            // A copy: nvcc has no device code for a reference to a static constexpr member.
            return (traits::max)(T(limits_.root), x.error()) + slack;
        };
        const T low = direction * at_p.value(), high = direction * at_q.value();
        if (low > tolerance(at_p) || high < -tolerance(at_q)) return none;

        T root = p;
        if (low < 0) root = high > 0 ? errbound::roots::guarded_newton(plain, p, q) : q;
        // True if the signs at its ends show that f rises (times direction) through the window.
        bool before = false, after = false, within = false;
        T left = p, right = q;
        for (T w = limits_.first_window; !within && w <= limits_.last_window;
             w *= limits_.window_growth) {
            left = (traits::max)(p, root - w), right = (std::min)(q, root + w);
            const scalar f_left = at(f, left), f_right = at(f, right);
            before = direction * f_left.value() < -(f_left.error() + slack);
            after = direction * f_right.value() > f_right.error() + slack;
            within = (before || left == p) && (after || right == q);
        }
        if (within) {
            const T w = (traits::max)(right - root, root - left) * (1 + traits::epsilon());
            const auto g = forms_at(forms_, scalar(T(1)), limits_.time(root, w)).inside();
            bool positive = true;
            for (const auto& form : g) {
                const sign_type s = sign_within(form[0], limits_.drift(w));
                if (s == sign_type::negative) return none;
                positive = positive && s == sign_type::positive;
            }
            if (positive && before && after) return {outcome::collides, cause::none};
        }
        return at_root(at(f, root), slack, root);
    }

    /// Step 3 of "SafeCCD" (docs/other-methods.md): reports the root or leaves it to the proximity
    /// tests.
    constexpr verdict at_root(const scalar& f, T slack, T root) {
        const auto now = forms_at(forms_, scalar(T(1)), scalar(root));
        const std::array<scalar, 3> n{now.n.x[0], now.n.y[0], now.n.z[0]};
        T longest = 0, error = 0;
        for (const scalar& x : n) {
            longest = (traits::max)(longest, traits::abs(x.value()));
            error = (traits::max)(error, x.error());
        }
        // A lower limit far below all sizes of the query keeps the quotients finite.
        const T mu = upper_magnitude(f) + slack + traits::smallest_normal();
        const T length = limits_.known_length(
            (traits::max)(least_distance(forms_.b).low, least_distance(forms_.c).low));
        const T nu = limits_.smallest_normal(mu, length);
        if (longest - error >= nu &&
            longest - error >= limits_.normal_per_length * longest_edge(now)) {
            bool inside = true;
            for (const auto& g : now.inside())
                inside = inside && sign_within(g[0], T(0)) != sign_type::negative;
            if (inside) return {outcome::uncertain, cause::inside};
        }
        const T wide = T(1.7320509) * (nu + 2 * error);  // bounds |N|₂ if |N|∞ may be below ν
        T radius = std::sqrt(wide) / 2;
        if (length > 0) radius = (std::min)(radius, wide / (2 * length));
        radius = (traits::max)(radius, T(0.8660255) * limits_.normal_per_length);
        doubt_ = true;
        const T reach = (mu / nu + radius) * (1 + T(0x1p-10));
        reach_ = reach <= traits::largest() ? (traits::max)(reach_, reach) : traits::infinity();
        return {outcome::separate, cause::none};
    }

    template <class Forms>
    static constexpr T longest_edge(const Forms& now) {
        T longest = 0;
        for (const auto* e : {&now.b, &now.c})
            for (const auto* x : {&e->x, &e->y, &e->z})
                longest = (traits::max)(longest, traits::abs((*x)[0].value()));
        return longest;
    }

    constexpr bool any_proximity() const {
        if (!traits::is_finite(reach_)) return true;
        for (const auto& edge : vertex_edge_queries(query_)) {
            const auto e = motion(edge.e1, edge.e0, limits_), w = motion(edge.v, edge.e0, limits_);
            if (proximity(e, w, motion(edge.v, edge.e1, limits_), reach_, limits_.off_line))
                return true;
        }
        return false;
    }

    Query<scalar> query_;
    [[no_unique_address]] limits limits_;  // GCC warns that an empty one is uninitialized
    decltype(power_forms(std::declval<const Query<scalar>&>(),
                         std::declval<const limits&>())) forms_;
    bool doubt_ = false;
    T reach_ = 0;
};

}  // namespace safeccd

/// Decides a query over tracked numbers near 1 in size (or 0).
template <class Rule, class T, template <class> class Query>
constexpr verdict decide_safeccd_of(const Query<errbound::tracked<T, Rule>>& query) {
    return safeccd::solver<T, Rule, Query>(query).decide();
}

/// Decides a vertex_face or edge_edge query. `separate` and `collides` are certain if signs under
/// Rule are. `collides` means that f changes its sign within a window in which all inside forms are
/// positive. Cost: bounded, no allocation, never throws; some microseconds with proximity tests.
template <class Rule, class T, template <class> class Query>
constexpr verdict decide_safeccd(const Query<T>& query) {
    const auto [scaled, finite] = tracked_query<Rule>(query);
    if (!finite) return {outcome::uncertain, cause::range};
    return decide_safeccd_of<Rule>(scaled);
}

}  // namespace ccd
