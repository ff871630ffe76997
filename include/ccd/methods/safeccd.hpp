// SafeCCD: cubic root finding whose tolerances absorb every rounding error (Wang 2014), once over
// any bound rule.
//
//   decide_safeccd<safe>    `safeccd`: tolerances from one uniform bound on all coordinates
//   decide_safeccd<tight>   `safeccd-tight`: tolerances from each variable's own bound
//
// As published: the coplanarity cubic f in power form, by differences to one vertex; a root in each
// monotone piece of [0, 1] by Newton's method guarded by bisection; at the root t̂, the normal and
// the inside tests; and where one of them is too close to tell, tests for PROXIMITY of vertices and
// edges (ccd/methods/proximity.hpp), whose reach makes up for the doubt. All that can be wrong is a
// reported contact that is none.
//
// Why no contact is lost. Let the features be in contact at t*; then f(t*) = 0.
//  1. Pieces. The critical points that part [0, 1] are only approximate, so a piece [p, q] rises or
//     falls but for `slack`: the length of the piece times the most that f' goes the wrong way,
//     from its certified values at p, q and the vertex. A piece is passed over only if f is
//     certainly beyond slack (and beyond the published threshold μ) at the end nearer to zero. So
//     t* lies in a piece where a root t̂ is looked for, and between t* and t̂ |f| is at most |f̂(t̂)| +
//     its error + slack =: μ.
//  2. Window. If f is certainly beyond slack and of opposite signs at t̂ ± w, or the piece ends
//     before, t* lies within the window. If some inside form G_i is certainly negative in all of
//     it, t* is no contact: at a contact all G_i >= 0, and all are zero where the normal N
//     vanishes.
//  3. Else t̂ is reported if |N(t̂)|∞ >= ν for a chosen ν and no G_i(t̂) is certainly negative.
//  4. Else go from t* to t̂. At t* the features touch; if |N(t*)|∞ <= ν, the touching point is
//     within r of an edge (VF) or of an end of the other edge (EE), measured in the plane, where r
//     is derived below. Otherwise the projection is inside, and leaves the inside through the
//     border, or |N|∞ falls to ν with the projection inside, or t̂ is reached with both right, which
//     step 3 would have reported. In each case the height over the plane is at most μ/|N| <= μ/ν.
//     So at some time a vertex is within reach = μ/ν + r of an edge, and the proximity tests find
//     it.
//  r: the inradius of a triangle with |N|₂ = 2·area is at most |N|₂/(2L) and 0.31·√|N|₂, L its
//     longest edge. For edges a, b that cross at the angle θ, the end nearest to the crossing is at
//     most min(|a|, |b|)/2 from it, so within sin θ times that of the other edge: at most
//     |N|₂/(2L), and √|N|₂/2. With |N|₂ <= √3·|N|∞ both have r <= min(√(√3·ν)/2, √3·ν/(2L)).
//
// Changed against the published method, each because the tests lost a collision or the proof did
// not close: the pieces' slack and the windows are certified instead of assumed from 0.001 and the
// constant 746·B³ε; the drift of the inside forms within a window is bounded by 48·B³·2V instead of
// 10·B⁴; the reach of the proximity tests is derived from μ and ν as above (3·6.3 instead of
// 18·B·ε^(1/4)); the normal is not asked where a negative G_i rejects.
//
// Sources: Wang 2014, Defending continuous collision detection against errors; Wang, Tang, Manocha,
// Tong 2015, Section 6 (SafeCCD with TightBound).
#pragma once

#include <algorithm>
#include <array>
#include <ccd/methods/bsc.hpp>
#include <ccd/methods/forms.hpp>
#include <ccd/methods/proximity.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/verdict.hpp>
#include <cmath>
#include <cstddef>
#include <errbound/roots/floating_roots.hpp>
#include <errbound/rules/safe.hpp>
#include <errbound/tracked.hpp>
#include <type_traits>

namespace ccd {
namespace safeccd {

using errbound::number_traits;
using errbound::sign_type;

/// About x^(2/3), by operations that every machine rounds alike (std::cbrt is not among them).
template <class T>
constexpr T two_thirds_power(const T& x) {
    using traits = number_traits<T>;
    if (!(x > 0) || !traits::is_finite(x)) return x;
    const int e = traits::exponent(x), third = (e < 0 ? e - 2 : e) / 3;  // rounded down
    const T m = traits::scale(x, -3 * third);                            // in [1/2, 4)
    T root = (2 + m) / 3;
    for (int i = 0; i < 5; ++i) root = (2 * root + m / (root * root)) / 3;  // Newton's
    return traits::scale(root * root, 2 * third);
}

/// What counts as too close to tell, from each variable's own bound.
template <class T, class Rule>
struct tolerances {
    using scalar = errbound::tracked<T, Rule>;

    template <class Query>
    explicit constexpr tolerances(const Query&) {}

    /// False if the tolerances do not hold for this query.
    static constexpr bool usable = true;
    /// |f| up to this counts as a root, beside its certified error.
    static constexpr T root = 0;
    /// Half widths w of the windows that are tried: from the first to the last, times the growth.
    static constexpr T first_window = 64 * number_traits<T>::epsilon(), last_window = T(0x1p-8),
                       window_growth = 64;
    /// The normal must be so much longer than the longest edge.
    static constexpr T normal_per_length = 0;
    /// Added to what counts as touching the line of an edge: |E × W|.
    static constexpr T off_line = 0;

    /// a − b at the start of the step; of one point's positions, its displacement.
    static constexpr scalar difference(const scalar& a, const scalar& b) { return a - b; }
    static constexpr scalar displacement(const scalar& a, const scalar& b) { return a - b; }

    /// The time t, or all of [t − w, t + w].
    static constexpr scalar time(T t, T w) { return scalar::within(t, w); }
    /// What the inside forms may change by within w, beside what time(t, w) says.
    static constexpr T drift(T) { return 0; }

    /// ν for the bound μ of |f| and edges at least `length` long: minimises μ/ν + r.
    static constexpr T smallest_normal(T mu, T length) {
        const T for_any = two_thirds_power(mu);
        const T for_long = std::sqrt(mu * length);
        return length > 0 && mu / for_long < mu / for_any ? for_long : for_any;
    }
    /// A lower bound of the longest edge's length, if it may be used.
    static constexpr T known_length(T length) { return length; }
};

/// What counts as too close to tell, from one bound B on all coordinate differences during the step
/// and the bound V on displacements: Wang 2014, with e = ε + 2σ/B where coordinates are known to
/// within σ.
template <class T>
struct tolerances<T, errbound::safe> {
    using scalar = errbound::tracked<T, errbound::safe>;
    using traits = number_traits<T>;

    bool usable;
    T root, normal_per_length, off_line;
    static constexpr T first_window = T(0.001), last_window = T(0.001), window_growth = 2;

    /// B = E + 2V, E the largest difference of coordinates at t = 0.
    template <class Query>
    explicit constexpr tolerances(const Query& query) {
        point<T> low, high;
        bool first = true;
        T displacement = 0;
        const auto widen = [&](T& l, T& h, const scalar& x0, const scalar& x1) {
            sigma_ = traits::max(sigma_, traits::max(x0.error(), x1.error()));
            l = first ? x0.value() : std::min(l, x0.value());
            h = first ? x0.value() : std::max(h, x0.value());
            displacement = traits::max(displacement, traits::abs(x1.value() - x0.value()));
        };
        for (const auto& p : points_of(query)) {
            widen(low.x, high.x, p.t0.x, p.t1.x);
            widen(low.y, high.y, p.t0.y, p.t1.y);
            widen(low.z, high.z, p.t0.z, p.t1.z);
            first = false;
        }
        const T extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
        // One part in a million pays for the roundings here and for coordinates that underflowed
        // when the query was scaled, unless all differences are of their size.
        constexpr T enlarged = 1 + T(0x1p-20);
        v_ = (displacement + 2 * sigma_) * enlarged;
        b_ = (extent + 2 * displacement + 6 * sigma_) * enlarged;
        usable = b_ >= std::sqrt(traits::smallest_normal());
        const T root_e = std::sqrt(traits::epsilon() + 2 * sigma_ / b_),
                fourth_root_e = std::sqrt(root_e);
        root = 64 * b_ * b_ * b_ * root_e * fourth_root_e;
        normal_ = 64 * b_ * b_ * root_e;
        normal_per_length = 4 * b_ * fourth_root_e;
        off_line = 725 * b_ * b_ * root_e;
    }

    /// Rounded once, so off by at most εB, beside what the coordinates are off by.
    constexpr scalar difference(const scalar& a, const scalar& b) const {
        return scalar::within(a.value() - b.value(), traits::epsilon() * b_ + 2 * sigma_);
    }
    constexpr scalar displacement(const scalar& a, const scalar& b) const {
        return scalar::within(a.value() - b.value(), traits::epsilon() * v_ + 2 * sigma_);
    }

    static constexpr scalar time(T t, T) { return scalar(t); }
    /// An inside form is the scalar product of two cross products of differences, each of size at
    /// most B and speed at most 2V: 12 terms of four factors.
    constexpr T drift(T w) const { return 48 * b_ * b_ * b_ * 2 * v_ * w; }

    constexpr T smallest_normal(T, T) const { return normal_; }
    static constexpr T known_length(T) { return 0; }

  private:
    T b_, v_, normal_, sigma_ = 0;
};

/// The value's sign if it holds within `drift` too.
template <class Scalar, class T>
constexpr sign_type sign_within(const Scalar& x, T drift) {
    const T e = x.error() + drift;
    if (x.value() > e) return sign_type::positive;
    return x.value() < -e ? sign_type::negative : sign_type::uncertain;
}

/// A bound on |x|.
template <class Scalar>
constexpr auto upper_magnitude(const Scalar& x) {
    return number_traits<typename Scalar::value_type>::abs(x.value()) + x.error();
}

/// One query under way.
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

    /// q − p in power form: the position at t = 0 and the displacement.
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

    /// How far f may move against `direction` on [p, q]: the length times a bound of how far f'
    /// falls below zero, times direction. The better of two bounds on the least f': that of its
    /// Bernstein coefficients on [p, q], certified one by one; and the least value of the computed
    /// f', at an end or at its vertex, less all errors of its coefficients and what evaluation and
    /// the vertex' own rounding (second order) can add. The true f' may have its vertex anywhere.
    constexpr T slack_of(const errbound::bernstein<scalar, 2>& slope, T vertex, T direction, T p,
                         T q) const {
        const auto low_end = [&](const scalar& x) { return direction * x.value() - x.error(); };
        const scalar at_p = at(slope, p), at_q = at(slope, q);
        const scalar half_length = (scalar(q) - scalar(p)) * scalar(T(0.5));
        const scalar middle = at_p + at(errbound::roots::power_derivative(slope), p) * half_length;
        const T hull = std::min({low_end(at_p), low_end(middle), low_end(at_q)});

        T least = std::min(direction * at_p.value(), direction * at_q.value());
        if (vertex > p && vertex < q)
            least = std::min(least, direction * at(slope, vertex).value());
        for (int i = 0; i <= 2; ++i)
            least -= slope[i].error() + 16 * traits::epsilon() * traits::abs(slope[i].value());

        const T low = traits::max(hull, least);
        // NaN counts as unbounded.
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
            return traits::max(limits_.root, x.error()) + slack;
        };
        const T low = direction * at_p.value(), high = direction * at_q.value();
        if (low > tolerance(at_p) || high < -tolerance(at_q)) return none;

        T root = p;
        if (low < 0) root = high > 0 ? errbound::roots::guarded_newton(plain, p, q) : q;
        // f rises (times direction) through the window, if its ends tell.
        bool before = false, after = false, within = false;
        T left = p, right = q;
        for (T w = limits_.first_window; !within && w <= limits_.last_window;
             w *= limits_.window_growth) {
            left = traits::max(p, root - w), right = std::min(q, root + w);
            const scalar f_left = at(f, left), f_right = at(f, right);
            before = direction * f_left.value() < -(f_left.error() + slack);
            after = direction * f_right.value() > f_right.error() + slack;
            within = (before || left == p) && (after || right == q);
        }
        if (within) {
            const T w = traits::max(right - root, root - left) * (1 + traits::epsilon());
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

    /// Step 3 of the proof: reports the root, or leaves it to the proximity tests.
    constexpr verdict at_root(const scalar& f, T slack, T root) {
        const auto now = forms_at(forms_, scalar(T(1)), scalar(root));
        const std::array<scalar, 3> n{now.n.x[0], now.n.y[0], now.n.z[0]};
        T longest = 0, error = 0;
        for (const scalar& x : n) {
            longest = traits::max(longest, traits::abs(x.value()));
            error = traits::max(error, x.error());
        }
        // A floor keeps the quotients finite; it is far below anything that the query holds.
        const T mu = upper_magnitude(f) + slack + traits::smallest_normal();
        const T length = limits_.known_length(
            traits::max(least_distance(forms_.b).low, least_distance(forms_.c).low));
        const T nu = limits_.smallest_normal(mu, length);
        if (longest - error >= nu &&
            longest - error >= limits_.normal_per_length * longest_edge(now)) {
            bool inside = true;
            for (const auto& g : now.inside())
                inside = inside && sign_within(g[0], T(0)) != sign_type::negative;
            if (inside) return {outcome::uncertain, cause::inside};
        }
        const T wide = T(1.7320509) * (nu + 2 * error);  // |N|₂ where |N|∞ may be below ν
        T radius = std::sqrt(wide) / 2;
        if (length > 0) radius = std::min(radius, wide / (2 * length));
        radius = traits::max(radius, T(0.8660255) * limits_.normal_per_length);
        doubt_ = true;
        const T reach = (mu / nu + radius) * (1 + T(0x1p-10));
        reach_ = reach <= traits::largest() ? traits::max(reach_, reach) : traits::infinity();
        return {outcome::separate, cause::none};
    }

    /// The longer of b and c at one time, in the largest coordinate.
    template <class Forms>
    static constexpr T longest_edge(const Forms& now) {
        T longest = 0;
        for (const auto* e : {&now.b, &now.c})
            for (const auto* x : {&e->x, &e->y, &e->z})
                longest = traits::max(longest, traits::abs((*x)[0].value()));
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

/// Decides a vertex_face or edge_edge query over tracked numbers near 1 in size (or 0).
template <class Rule, class T, template <class> class Query>
constexpr verdict decide_safeccd_of(const Query<errbound::tracked<T, Rule>>& query) {
    return safeccd::solver<T, Rule, Query>(query).decide();
}

/// Decides a vertex_face or edge_edge query. `separate` is certain whenever signs under Rule are,
/// and `collides`: then f changes its sign within a window in which all inside forms are positive.
/// Cost: bounded, no allocation, never throws; some microseconds where it comes to proximity.
template <class Rule, class T, template <class> class Query>
constexpr verdict decide_safeccd(const Query<T>& query) {
    const auto [scaled, finite] = tracked_query<Rule>(query);
    if (!finite) return {outcome::uncertain, cause::range};
    return decide_safeccd_of<Rule>(scaled);
}

}  // namespace ccd
