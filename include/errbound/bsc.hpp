// Bernstein sign classification (BSC), over any scalar that has + − × and a sign. Start at
// root_with_nonnegative. Symbols: docs/notation.md.
//
// Derived anew after Tang, Tong, Wang, Manocha 2014 (TTWM14) and TightCCD (Wang, Tang, Tong,
// Manocha 2015, Section 5). Differences: an uncertain sign of Y at an end is followed as either
// sign (on_convex). Y is split exactly at its inflection (without_halving). `reduced` does not
// divide. Forms are in (s, t), s + t = 1: Y = (y0, y1, y2, y3), D = Y', l is linear with the root
// t_l. Inner means 0 < t < 1. A strict sign is not zero.
#pragma once

#include <array>
#include <cstdint>
#include <errbound/bernstein.hpp>
#include <optional>
#include <tuple>
#include <type_traits>
#include <utility>

namespace errbound {

/// The existence of a root. maybe_root: uncertain because of Y; maybe_inside: because of a G_i.
enum class existence : std::uint8_t { no, yes, maybe_root, maybe_inside };

namespace bsc {

inline constexpr int max_halvings = 6;  ///< of an interval with uncertain curvature sign

template <class S>
using cubic = bernstein<S, 3>;
template <class S, std::size_t M>
using quartics = std::array<bernstein<S, 4>, M>;

using sign_pair = std::array<sign_type, 2>;  ///< at the two inner roots of Y, in order of t

constexpr existence either(existence a, existence b) {
    if (a == existence::yes || b == existence::yes) return existence::yes;
    return a == existence::no ? b : a;
}

/// Verdict from the signs of all G_i at one root.
class conjunction {
  public:
    explicit constexpr conjunction(bool root_is_certain) : root_is_certain_(root_is_certain) {}

    constexpr void require_nonnegative(sign_type s) {
        if (s == sign_type::negative) excluded_ = true;
        // G = 0 satisfies G >= 0, but proves nothing: where the normal N is zero, all G are zero.
        if (s != sign_type::positive) all_positive_ = false;
    }
    constexpr bool excluded() const { return excluded_; }
    constexpr existence result() const {
        if (excluded_) return existence::no;
        if (!root_is_certain_) return existence::maybe_root;
        return all_positive_ ? existence::yes : existence::maybe_inside;
    }

  private:
    bool root_is_certain_;
    bool excluded_ = false;
    bool all_positive_ = true;
};

/// The root of a linear form L, (s, t) = (|L1|, |L0|), up to the factor 1/(|L0| + |L1|), which
/// would need a division. Precondition: L0 and L1 have opposite strict signs.
template <class S>
struct linear_root {
    S s, t;
    explicit constexpr linear_root(const bernstein<S, 1>& l)
        : s(sign_of(l[0]) == sign_type::positive ? S(-l[1]) : l[1]),
          t(sign_of(l[0]) == sign_type::positive ? l[0] : S(-l[0])) {}
};

struct linear_signs {
    sign_type at0, at1;

    template <class S>
    explicit constexpr linear_signs(const bernstein<S, 1>& l)
        : at0(sign_of(l[0])), at1(sign_of(l[1])) {}

    constexpr bool opposite() const {
        return certain(at0) && certain(at1) && at0 * at1 == sign_type::negative;
    }
    /// The sign on (0, 1) unless opposite().
    constexpr sign_type inside() const {
        if (!certain(at0) || !certain(at1)) return sign_type::uncertain;
        return at0 == sign_type::zero ? at1 : at0;
    }
};

/// Sign determination I (TTWM14): the sign of l at the only inner root of Y, where Y changes from
/// the strict sign `before` to its opposite. If Y(t_l) has the sign `before`, the root is right of
/// t_l. Proof: proofs/bsc/BscSigns.v, sign_determination_1.
template <class S>
constexpr sign_type sign_at_crossing(const cubic<S>& y, sign_type before,
                                     const bernstein<S, 1>& l) {
    const linear_signs ends(l);
    if (!ends.opposite()) return ends.inside();
    const linear_root<S> r(l);
    const sign_type at_r = sign_of(value_at(y, r.s, r.t));
    if (!certain(at_r)) return sign_type::uncertain;
    if (at_r == sign_type::zero) return sign_type::zero;
    return at_r == before ? ends.at1 : ends.at0;
}

/// Sign determination II (TTWM14): the signs of l at the two inner roots t0 <= t1 of a CONVEX Y > 0
/// at both ends; d = Y'. If Y(t_l) < 0, t0 < t_l < t1. If Y(t_l) > 0, t_l < t0 if d(t_l) < 0 and
/// t_l > t1 if d(t_l) > 0. If only d(t_l) has a certain sign, it gives the sign at t1 or t0. Proof:
/// proofs/bsc/BscSigns.v, sign_determination_2.
template <class S>
constexpr sign_pair signs_at_pair(const cubic<S>& y, const bernstein<S, 2>& d,
                                  const bernstein<S, 1>& l) {
    const linear_signs ends(l);
    if (!ends.opposite()) return {ends.inside(), ends.inside()};
    const linear_root<S> r(l);
    const sign_type at_r = sign_of(value_at(y, r.s, r.t));
    if (at_r == sign_type::negative) return {ends.at0, ends.at1};
    const sign_type slope = sign_of(value_at(d, r.s, r.t));
    const sign_type nearer = at_r == sign_type::zero ? sign_type::zero : sign_type::uncertain;
    switch (slope) {
        case sign_type::negative:
            return {at_r == sign_type::positive ? ends.at1 : nearer, ends.at1};
        case sign_type::positive:
            return {ends.at0, at_r == sign_type::positive ? ends.at0 : nearer};
        default:
            if (slope == sign_type::zero && at_r == sign_type::zero)
                return {sign_type::zero, sign_type::zero};
            return {sign_type::uncertain, sign_type::uncertain};
    }
}

/// The quadratic J: y0·y3·G = s·t·J + (a form)·Y. y0·G − g0·s·Y = t·E cancels s⁴; y3·E − e3·Y = s·J
/// cancels t³. At inner roots of Y, sign G = sign(y0·y3)·sign J. If y0 or y3 is zero but its
/// uncertain sign is followed as strict, J = 0 at these roots. Proof: proofs/bsc/BscSigns.v,
/// reduction.
template <class S>
constexpr bernstein<S, 2> reduced(const cubic<S>& y, const bernstein<S, 4>& g) {
    const std::array<S, 4> e{y[0] * g[1] - g[0] * y[1], y[0] * g[2] - g[0] * y[2],
                             y[0] * g[3] - g[0] * y[3], y[0] * g[4]};
    return normalized(bernstein<S, 2>{
        {y[3] * e[0] - e[3] * y[0], y[3] * e[1] - e[3] * y[1], y[3] * e[2] - e[3] * y[2]}});
}

/// Polynomial decomposition: j0·j2·Y = M·J + s·t·R with M, R linear. At an inner root of Y with M
/// not zero, sign J = −sign M · sign R. Proof: proofs/bsc/BscSigns.v, polynomial_decomposition.
template <class S>
struct decomposition {
    bernstein<S, 1> m, r;
    constexpr decomposition(const cubic<S>& y, const bernstein<S, 2>& j)
        : m(normalized(bernstein<S, 1>{{y[0] * j[2], y[3] * j[0]}})) {
        const S jj = j[0] * j[2];
        const S m0 = y[0] * j[2], m1 = y[3] * j[0];  // the identity needs m before normalisation
        r = normalized(bernstein<S, 1>{
            {jj * y[1] - m0 * j[1] - m1 * j[0], jj * y[2] - m0 * j[2] - m1 * j[1]}});
    }
};

/// The sign of J at a root of Y, from the signs m and r of M and R there. If M is zero, returns the
/// sign of J at the root of M (Proof: proofs/bsc/Published.v, decomposition_zero).
template <class S>
constexpr sign_type combined(sign_type m, sign_type r, const bernstein<S, 1>& m_form,
                             const bernstein<S, 2>& j) {
    if (m != sign_type::zero) return -(m * r);
    if (!linear_signs(m_form).opposite()) return sign_type::uncertain;
    const linear_root<S> root(m_form);
    return sign_of(value_at(j, root.s, root.t));
}

/// The sign of the quartic g at the only inner root of Y; `before` as for a linear form.
template <class S>
constexpr sign_type sign_at_crossing(const cubic<S>& y, sign_type before,
                                     const bernstein<S, 4>& g) {
    const sign_type hull = sign_inside(g);
    if (certain(hull)) return hull;
    const bernstein<S, 2> j = reduced(y, g);
    const sign_type hull_j = sign_inside(j);
    if (certain(hull_j)) return -hull_j;  // y0·y3 < 0
    const decomposition<S> parts(y, j);
    return -combined(sign_at_crossing(y, before, parts.m), sign_at_crossing(y, before, parts.r),
                     parts.m, j);
}

template <class S>
constexpr sign_pair signs_at_pair(const cubic<S>& y, const bernstein<S, 2>& d,
                                  const bernstein<S, 4>& g) {
    const sign_type hull = sign_inside(g);
    if (certain(hull)) return {hull, hull};
    const bernstein<S, 2> j = reduced(y, g);
    const sign_type hull_j = sign_inside(j);
    if (certain(hull_j)) return {hull_j, hull_j};  // y0·y3 > 0
    const decomposition<S> parts(y, j);
    const sign_pair m = signs_at_pair(y, d, parts.m), r = signs_at_pair(y, d, parts.r);
    return {combined(m[0], r[0], parts.m, j), combined(m[1], r[1], parts.m, j)};
}

/// The sign of Y at its only inner extremum t_ex, for convex Y (assumes d0 < 0 < d2). Euler's
/// identity gives Y = A + t·D/3 = B − s·D/3, A and B quadratic. D(t_ex) = 0, so d0·A − y0·D = t·P
/// gives d0·Y = t·P there, and d2·B − y3·D = s·Q gives d2·Y = s·Q; P and Q are linear. Proof:
/// proofs/bsc/BscSigns.v, root_finding.
template <class S>
constexpr sign_type sign_at_extremum(const cubic<S>& y, const bernstein<S, 2>& d) {
    // The sign of l at t_ex: d increases, so d(t_l) < 0 puts t_ex right of t_l.
    const auto sign_at = [&d](const bernstein<S, 1>& form) {
        const bernstein<S, 1> l = normalized(form);
        const linear_signs ends(l);
        if (!ends.opposite()) return ends.inside();
        const linear_root<S> r(l);
        switch (sign_of(value_at(d, r.s, r.t))) {
            case sign_type::negative:
                return ends.at1;
            case sign_type::positive:
                return ends.at0;
            case sign_type::zero:
                return sign_type::zero;
            default:
                return sign_type::uncertain;
        }
    };
    const S three(3), two(2);
    // 3·(d0·A − y0·D)/t with 3A = (3y0, 2y1, y2).
    const sign_type from_left = -sign_at(bernstein<S, 1>{
        {two * (d[0] * y[1]) - three * (y[0] * d[1]), d[0] * y[2] - three * (y[0] * d[2])}});
    if (certain(from_left)) return from_left;
    // 3·(d2·B − y3·D)/s with 3B = (y1, 2y2, 3y3).
    return sign_at(bernstein<S, 1>{
        {d[2] * y[1] - three * (y[3] * d[0]), two * (d[2] * y[2]) - three * (y[3] * d[1])}});
}

template <class S, std::size_t M>
constexpr existence at_end(sign_type y_end, const quartics<S, M>& g, int coefficient) {
    if (!possibly_zero(y_end)) return existence::no;
    conjunction all(y_end == sign_type::zero);
    for (std::size_t i = 0; i < M && !all.excluded(); ++i)
        all.require_nonnegative(sign_of(g[i][coefficient]));
    return all.result();
}

template <class S, std::size_t M>
[[gnu::noinline]] constexpr existence at_crossing(const cubic<S>& y, sign_type before,
                                                  bool root_is_certain, const quartics<S, M>& g) {
    conjunction all(root_is_certain);
    for (std::size_t i = 0; i < M && !all.excluded(); ++i)
        all.require_nonnegative(sign_at_crossing(y, before, g[i]));
    return all.result();
}

/// Two inner roots, or a double one, of a convex Y that is positive at both ends.
template <class S, std::size_t M>
[[gnu::noinline]] constexpr existence at_pair(const cubic<S>& y, const bernstein<S, 2>& d,
                                              bool ends_are_certain, const quartics<S, M>& g) {
    const sign_type d0 = sign_of(d[0]), d2 = sign_of(d[2]);
    if (certainly_nonnegative(d0) || certainly_nonpositive(d2)) return existence::no;  // monotone
    // If d0 or d2 is uncertain, Y is monotone and has no root, or d0 < 0 < d2, as assumed here.
    const sign_type lowest = sign_at_extremum(y, d);
    if (lowest == sign_type::positive) return existence::no;
    const bool roots_are_certain =
        ends_are_certain && certain(d0) && certain(d2) && certain(lowest);
    std::array<conjunction, 2> all{conjunction(roots_are_certain), conjunction(roots_are_certain)};
    for (std::size_t i = 0; i < M && !(all[0].excluded() && all[1].excluded()); ++i) {
        const sign_pair signs = signs_at_pair(y, d, g[i]);
        all[0].require_nonnegative(signs[0]);
        all[1].require_nonnegative(signs[1]);
    }
    return either(all[0].result(), all[1].result());
}

/// Y strictly increasing on (0, 1): at most one root, at an end or inner.
template <class S, std::size_t M>
constexpr existence on_increasing(const cubic<S>& y, const quartics<S, M>& g) {
    const sign_type y0 = sign_of(y[0]), y3 = sign_of(y[3]);
    existence found = either(at_end(y0, g, 0), at_end(y3, g, 4));
    if (possibly_negative(y0) && possibly_positive(y3))
        found = either(found, at_crossing(y, sign_type::negative, certain(y0) && certain(y3), g));
    return found;
}

/// Y convex and not constant on [0, 1]. Every strict sign that Y may have at an end is followed;
/// the answer is "no" if all answers are. (The paper sets an uncertain sign to one value.)
template <class S, std::size_t M>
[[gnu::noinline]] constexpr existence on_convex(const cubic<S>& y, const bernstein<S, 2>& d,
                                                const quartics<S, M>& g) {
    const sign_type y0 = sign_of(y[0]), y3 = sign_of(y[3]);
    const bool ends_are_certain = certain(y0) && certain(y3);
    existence found = either(at_end(y0, g, 0), at_end(y3, g, 4));
    // If Y(0) is exactly zero, Y = t·q, q quadratic. The cubic (s + t)·q has only the inner roots
    // of Y: one if Y falls at 0 and Y(1) > 0, otherwise none. Y(1) = 0 is the mirror image.
    if (y0 == sign_type::zero) {
        const sign_type slope = sign_of(y[1]);
        if (possibly_negative(slope) && possibly_positive(y3))
            found = either(found,
                           at_crossing(elevated(bernstein<S, 2>{{y[1], y[2], y[3]}}),
                                       sign_type::negative, ends_are_certain && certain(slope), g));
    } else if (possibly_negative(y0) && possibly_positive(y3)) {
        found = either(found, at_crossing(y, sign_type::negative, ends_are_certain, g));
    }
    if (possibly_positive(y0)) {
        if (y3 == sign_type::zero) {
            const sign_type slope = -sign_of(y[2]);
            if (possibly_positive(slope))
                found = either(
                    found, at_crossing(elevated(bernstein<S, 2>{{y[0], y[1], y[2]}}),
                                       sign_type::positive, ends_are_certain && certain(slope), g));
        } else if (possibly_negative(y3)) {
            found = either(found, at_crossing(y, sign_type::positive, ends_are_certain, g));
        }
        if (possibly_positive(y3)) found = either(found, at_pair(y, d, ends_are_certain, g));
    }
    return found;
}

template <class S, std::size_t M>
constexpr bool excluded_by_hull(const cubic<S>& y, const quartics<S, M>& g) {
    if (certainly_rootless(y)) return true;
    for (const bernstein<S, 4>& form : g)
        if (sign_throughout(form) == sign_type::negative) return true;
    return false;
}

template <class S, std::size_t M>
struct part {
    cubic<S> y;
    quartics<S, M> g;
};

/// The answer if it does not depend on the sign of Y'', otherwise nothing. d = Y'.
template <class S, std::size_t M>
constexpr std::optional<existence> without_curvature(const part<S, M>& p,
                                                     const bernstein<S, 2>& d) {
    if (excluded_by_hull(p.y, p.g)) return existence::no;
    switch (sign_inside(d)) {
        case sign_type::positive:
            return on_increasing(p.y, p.g);
        case sign_type::negative:
            return on_increasing(-p.y, p.g);
        case sign_type::zero:  // Y is constant
            return possibly_zero(sign_of(p.y[0])) ? existence::maybe_root : existence::no;
        default:
            return {};
    }
}

template <class S, std::size_t M>
constexpr existence of_curvature(const part<S, M>& p, const bernstein<S, 2>& d,
                                 sign_type curvature) {
    return curvature == sign_type::positive ? on_convex(p.y, d, p.g) : on_convex(-p.y, -d, p.g);
}

template <class S, std::size_t M, class PartsOf>
constexpr std::pair<part<S, M>, part<S, M>> divided(const part<S, M>& p, const PartsOf& parts_of) {
    std::pair<part<S, M>, part<S, M>> parts;
    const auto parts_of_y = parts_of(p.y);
    parts.first.y = normalized(parts_of_y.first);
    parts.second.y = normalized(parts_of_y.second);
    for (std::size_t i = 0; i < M; ++i) {
        const auto parts_of_g = parts_of(p.g[i]);
        parts.first.g[i] = normalized(parts_of_g.first);
        parts.second.g[i] = normalized(parts_of_g.second);
    }
    return parts;
}

/// The answer on the interval, split at the exact inflection if it has one; nothing if it depends
/// on an uncertain sign of Y''. After a rounded split, an inflection may remain near an end, and
/// signs at ends miss roots (Proof: proofs/bsc/Published.v, inflection_loses_roots).
template <class S, std::size_t M>
[[gnu::noinline]] constexpr std::optional<existence> without_halving(const part<S, M>& p) {
    const bernstein<S, 2> d = derivative(p.y);
    if (const auto known = without_curvature(p, d)) return known;
    const bernstein<S, 1> second = derivative(d);
    const linear_signs ends(second);
    if (!ends.opposite()) {
        const sign_type curvature = ends.inside();
        if (curvature == sign_type::positive || curvature == sign_type::negative)
            return of_curvature(p, d, curvature);
        return {};
    }
    const linear_root<S> inflection(second);
    const auto parts =
        divided(p, [&](const auto& form) { return split(form, inflection.s, inflection.t); });
    const auto on_side = [](const part<S, M>& side, sign_type curvature) {
        const bernstein<S, 2> slope = derivative(side.y);
        const auto known = without_curvature(side, slope);
        return known ? *known : of_curvature(side, slope, curvature);
    };
    const existence left = on_side(parts.first, ends.at0);
    if (left == existence::yes) return left;
    return either(left, on_side(parts.second, ends.at1));
}

template <class S, std::size_t M>
[[gnu::noinline]] constexpr existence by_halving(const part<S, M>& whole) {
    std::array<part<S, M>, max_halvings + 1> waiting;  // the earliest last
    std::array<int, max_halvings + 1> halvings;        // halvings that led to each
    std::size_t count = 1;
    waiting[0] = whole;
    halvings[0] = 0;
    while (count > 0) {
        const std::size_t last = count - 1;
        if (const auto found = without_halving(waiting[last])) {
            // A "maybe" ends the search; otherwise a query might visit all 2^max_halvings parts.
            if (*found != existence::no) return *found;
            --count;
            continue;
        }
        if (halvings[last] == max_halvings) return existence::maybe_root;
        const auto parts = divided(waiting[last], [](const auto& form) { return halves(form); });
        waiting[last] = parts.second;
        waiting[count] = parts.first;
        halvings[count] = ++halvings[last];
        ++count;
    }
    return existence::no;
}

}  // namespace bsc

/// Decides if some t in [0, 1] has y(t) = 0 and every g_i(t) >= 0. `make_g()` returns the g_i as a
/// std::array; it is called only if y may have a root.
///
/// If the scalar's certain signs are right, so is `no`, and `yes` proves a root with every g_i > 0.
/// Proof: proofs/bsc/Bsc.v, bsc_no, bsc_yes. Y ≡ 0 gives `no` or `maybe_root`. If no sign is
/// uncertain, `maybe_root` means Y ≡ 0, and `maybe_inside` means that some root has every g_i >= 0
/// but none has every g_i > 0. Proof: proofs/bsc/BscExact.v, bsc_exact_root, bsc_exact_inside.
/// Cost: some hundred operations of S in common cases, at most a few thousand.
template <class S, class MakeConstraints>
constexpr existence root_with_nonnegative(const bernstein<S, 3>& y, const MakeConstraints& make_g) {
    const bsc::cubic<S> cubic = normalized(y);
    if (certainly_rootless(cubic)) return existence::no;
    const auto g = make_g();
    // Assigned, not part{cubic, {}}: nvcc 13 cannot construct nested arrays of a class on devices.
    bsc::part<S, std::tuple_size_v<std::remove_cvref_t<decltype(g)>>> whole;
    whole.y = cubic;
    for (std::size_t i = 0; i < g.size(); ++i) whole.g[i] = normalized(g[i]);
    const auto found = bsc::without_halving(whole);
    return found ? *found : bsc::by_halving(whole);
}

}  // namespace errbound
