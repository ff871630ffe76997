// The floating-point stages of `exact`: tests whose errors are bounded in advance.
//
// One template for one query (S = double) and for a pack of queries (S a SIMD batch, masks instead
// of bools): the pack's lanes compute what the scalar computes, bit for bit. Constants come from
// errbound::filters::error_count, run on the same forms.
//
// Sizes are measured after the subtraction of one point from the others, by axis: m_x, m_y, m_z
// bound the computed differences. Every term of Y has one factor from each axis, so Y's errors are
// in units of m_x·m_y·m_z; every term of a G_i has two factors from each of two axes, so theirs are
// in units of the largest (m_i·m_j)².
#pragma once

#include <algorithm>
#include <array>
#include <ccd/methods/forms.hpp>
#include <cmath>
#include <cstddef>
#include <errbound/filters/error_count.hpp>
#include <errbound/roots/control_values.hpp>
#include <tuple>
#include <type_traits>
#include <utility>

namespace ccd::static_filter {

/// How often the subdivision may halve.
inline constexpr std::size_t max_depth = 12;

/// From this depth on, a part where Y is as small as its error goes to exact arithmetic: its halves
/// would be no better. (Before it, halving may yet show that some G_i is negative everywhere.)
inline constexpr std::size_t patient_depth = 3;

/// Larger differences go to later stages: the forms of degree 4 stay far from overflow. (Floats are
/// for differences in units of a scene's size.)
template <class Real>
inline constexpr Real largest_difference = 0x1p200;
template <>
inline constexpr float largest_difference<float> = 4;

/// The number type whose roundings S makes: that of a pack is double.
template <class S>
struct real_of {
    using type = double;
};
template <>
struct real_of<float> {
    using type = float;
};

/// What a comparison of two S gives: bool, or a SIMD mask.
template <class S>
using mask = decltype(S() < S());

/// Constants of a form: |ĥ − h| <= relative·unit + absolute, for the control values of the form
/// times multiple(N), and what each halving of them adds.
template <class Real>
struct constants {
    Real relative;  ///< times the unit
    Real absolute;  ///< underflow
    Real halvings;  ///< times the largest control value, for max_depth halvings
};

namespace detail {

using errbound::bernstein;
using errbound::filters::basic_error_count;
using errbound::filters::error_count;
using errbound::roots::control_values;
using errbound::roots::control_values_of;

template <class Real, int N>
constexpr basic_error_count<Real> worst_of(const control_values<basic_error_count<Real>, N>& c) {
    basic_error_count<Real> w = c[0];
    for (int i = 1; i <= N; ++i) w = worst(w, c[i]);
    return w;
}

/// The error that max_depth halvings of control values of size at most 1 add. Which half is taken
/// each time is not known, so the worst error of a level is taken for all values of the next.
/// Proof: proofs/FilterStages.v, halving_error_enough.
template <int N>
constexpr double halving_error() {
    control_values<error_count, N> c;
    c.b.fill(error_count::exact());
    for (std::size_t d = 0; d < max_depth; ++d) {
        const auto [left, right] = halves(c);
        const double error = worst(worst_of(left), worst_of(right)).error;
        c.b.fill({1, error, 0});
    }
    return c[0].error;
}

/// The bounds are evaluated in a handful of rounded operations: one per cent is plenty.
inline constexpr double slack = 1.01;

/// Smaller than anything that matters, and larger than what the bounds' own evaluation loses to
/// underflow.
template <class Real>
inline constexpr double negligible = 0x1p-1000;
template <>
inline constexpr double negligible<float> = 0x1p-140;

/// Underflow happens in forms of at most degree `degree`, whose factors are at most
/// largest_difference.
template <class Real, int N>
constexpr constants<Real> constants_of(basic_error_count<Real> c, int degree) {
    using traits = errbound::number_traits<Real>;
    double absolute = c.underflow;
    for (int i = 1; i < degree; ++i) absolute *= double(largest_difference<Real>);
    absolute *= double(traits::underflow_unit());  // last: it would underflow
    constexpr double epsilon = traits::epsilon();
    return {Real(slack * c.error * epsilon), Real(slack * (absolute + negligible<Real>)),
            Real(slack * halving_error<N>() * epsilon)};
}

/// A difference of doubles that is rounded to Real, which floats may underflow in.
/// Proof: proofs/RoundedAxes.v, converted_difference_near.
template <class Real>
constexpr vector_form<basic_error_count<Real>, 1> any_difference() {
    auto d = basic_error_count<Real>::difference();
    if (sizeof(Real) < sizeof(double)) d.underflow = 1;
    return {{{d, d}}, {{d, d}}, {{d, d}}};
}

template <class Real, template <class> class Forms>
constexpr constants<Real> constants_of_y() {
    constexpr auto d = any_difference<Real>();
    const Forms<basic_error_count<Real>> forms(d, d, d);
    return constants_of<Real, 3>(worst_of(control_values_of(forms.y())), 3);
}
template <class Real, template <class> class Forms>
constexpr constants<Real> constants_of_g() {
    constexpr auto d = any_difference<Real>();
    const Forms<basic_error_count<Real>> forms(d, d, d);
    basic_error_count<Real> w;
    for (const auto& g : forms.inside()) w = worst(w, worst_of(control_values_of(g)));
    return constants_of<Real, 4>(w, 4);
}

}  // namespace detail

template <template <class> class Forms, class Real = double>
inline constexpr constants<Real> y_constants = detail::constants_of_y<Real, Forms>();
template <template <class> class Forms, class Real = double>
inline constexpr constants<Real> g_constants = detail::constants_of_g<Real, Forms>();

/// The sizes m_x, m_y, m_z of a query's differences, whose coordinates must be finite (differences
/// that overflow are infinite; only those of infinities are NaN, which the maximum may overlook).
template <class S>
struct sizes {
    using real = typename real_of<S>::type;
    S x, y, z;
    /// False if a difference is too large: then no test may be believed.
    mask<S> usable;

    explicit constexpr sizes(const coplanarity_forms<S>& f) {
        using std::abs, std::max;
        const auto largest = [](const auto& b, const auto& c, const auto& p) {
            S m = abs(b[0]);
            for (const S& d : {b[1], c[0], c[1], p[0], p[1]}) m = max(m, S(abs(d)));
            return m;
        };
        x = largest(f.b.x, f.c.x, f.p.x);
        y = largest(f.b.y, f.c.y, f.p.y);
        z = largest(f.b.z, f.c.z, f.p.z);
        usable = max(max(x, y), z) <= S(largest_difference<real>);
    }

    /// Bounds |ĥ − h| of the control values of Y, and of every G_i. Proofs are of double.
    /// Proof: proofs/CcdFilter.v, error_of_y_sound.
    /// Proof: proofs/CcdFilter.v, error_of_vertex_face_sound.
    /// Proof: proofs/CcdFilter.v, error_of_edge_edge_sound.
    template <template <class> class Forms>
    constexpr S error_of_y() const {
        return x * y * z * S(y_constants<Forms, real>.relative) +
               S(y_constants<Forms, real>.absolute);
    }
    template <template <class> class Forms>
    constexpr S error_of_g() const {
        using std::max;
        const S area = max(max(x * y, y * z), z * x);
        return area * area * S(g_constants<Forms, real>.relative) +
               S(g_constants<Forms, real>.absolute);
    }
};

namespace detail {

/// Whether the projections part the features the same way at both ends of the step; `project`
/// takes a difference and an end, and is off by at most margin/2.
template <class S, class Project>
constexpr mask<S> separated_along(const vertex_face_forms<S>& f, const S& margin,
                                  const Project& project) {
    using std::max, std::min;
    const auto at = [&](int end) {
        const S b = project(f.b, end), c = project(f.c, end), v = project(f.p, end);
        const S zero(0.0);
        return std::pair<mask<S>, mask<S>>(v > max(max(b, c), zero) + margin,
                                           v < min(min(b, c), zero) - margin);
    };
    const auto start = at(0), end = at(1);
    return (start.first & end.first) | (start.second & end.second);
}
template <class S, class Project>
constexpr mask<S> separated_along(const edge_edge_forms<S>& f, const S& margin,
                                  const Project& project) {
    using std::max, std::min;
    const auto at = [&](int end) {
        const S a1 = project(f.b, end), b0 = project(f.p, end), b1 = b0 + project(f.c, end);
        const S zero(0.0);
        return std::pair<mask<S>, mask<S>>(min(b0, b1) > max(a1, zero) + margin,
                                           max(b0, b1) < min(a1, zero) - margin);
    };
    const auto start = at(0), end = at(1);
    return (start.first & end.first) | (start.second & end.second);
}

/// See `separated`. Not for floats, whose differences may underflow.
inline constexpr double margin = 9.2 * errbound::number_traits<double>::epsilon();

}  // namespace detail

/// The first three axes of `separated`.
template <class S, class Forms>
constexpr mask<S> separated_by_coordinates(const Forms& f, const sizes<S>& m) {
    static_assert(std::is_same_v<typename sizes<S>::real, double>);
    const auto along = [&](const S& size, const auto& project) {
        return detail::separated_along<S>(f, size * S(detail::margin), project);
    };
    const mask<S> x = along(m.x, [](const auto& d, int end) { return d.x[end]; });
    const mask<S> y = along(m.y, [](const auto& d, int end) { return d.y[end]; });
    const mask<S> z = along(m.z, [](const auto& d, int end) { return d.z[end]; });
    return x | y | z;
}

/// The other six.
template <class S, class Forms>
constexpr mask<S> separated_by_diagonals(const Forms& f, const sizes<S>& m) {
    static_assert(std::is_same_v<typename sizes<S>::real, double>);
    const auto along = [&](const S& size, const auto& u, const auto& v) {
        const S e = size * S(detail::margin);
        const mask<S> sum = detail::separated_along<S>(
            f, e, [&](const auto& d, int end) { return S(u(d)[end] + v(d)[end]); });
        const mask<S> difference = detail::separated_along<S>(
            f, e, [&](const auto& d, int end) { return S(u(d)[end] - v(d)[end]); });
        return mask<S>(sum | difference);
    };
    const auto x = [](const auto& d) -> const auto& {
        return d.x;
    };
    const auto y = [](const auto& d) -> const auto& {
        return d.y;
    };
    const auto z = [](const auto& d) -> const auto& {
        return d.z;
    };
    const mask<S> xy = along(m.x + m.y, x, y);
    const mask<S> yz = along(m.y + m.z, y, z);
    const mask<S> zx = along(m.z + m.x, z, x);
    return xy | yz | zx;
}

/// Whether one of nine fixed axes (x, y, z, x ± y, y ± z, z ± x) parts the features the same way
/// at both ends of the step. The motion is linear, so it then parts them throughout.
/// Proof: proofs/Decisions.v, face_separated, edges_separated.
/// Proof of the margin: proofs/SeparatingAxis.v, separated_face_separate, separated_edges_separate.
///
/// Margins: a difference d̂ is off by at most ε·m, a sum of two axes by 2ε(1 + ε)(m_x + m_y), so two
/// compared projections together by 4ε(1 + ε)(m_x + m_y); an edge's far end is a sum of two such,
/// rounded once more, of twice the size: 8ε(1 + ε)(m_x + m_y). The bound's own addition rounds too,
/// by ε(m_x + m_y): 9.2ε serves all. Sums lose nothing to underflow.
template <class S, class Forms>
constexpr mask<S> separated(const Forms& f, const sizes<S>& m) {
    return separated_by_coordinates<S>(f, m) | separated_by_diagonals<S>(f, m);
}

/// All control values certainly positive (`above`), or negative (`below`).
template <class S, int N>
constexpr mask<S> above(const errbound::roots::control_values<S, N>& c, const S& error) {
    using std::min;
    S least = c[0];
    for (int i = 1; i <= N; ++i) least = min(least, c[i]);
    return least > error;
}
template <class S, int N>
constexpr mask<S> below(const errbound::roots::control_values<S, N>& c, const S& error) {
    using std::max;
    S greatest = c[0];
    for (int i = 1; i <= N; ++i) greatest = max(greatest, c[i]);
    return greatest < -error;
}

/// The largest control value's size.
template <class S, int N>
constexpr S size_of(const errbound::roots::control_values<S, N>& c) {
    using std::abs, std::max;
    S size = abs(c[0]);
    for (int i = 1; i <= N; ++i) size = max(size, abs(c[i]));
    return size;
}

/// The end values certainly differ in sign: a root is certain.
template <class S, int N>
constexpr mask<S> changes_sign(const errbound::roots::control_values<S, N>& c, const S& error) {
    const S& start = c[0];
    const S& end = c[N];
    const mask<S> starts_above = start > error, starts_below = start < -error;
    const mask<S> ends_above = end > error, ends_below = end < -error;
    return (starts_above & ends_below) | (starts_below & ends_above);
}

/// No control value has a certain sign, nor will any of a part's.
template <class S, int N>
constexpr mask<S> within_error(const errbound::roots::control_values<S, N>& c, const S& error) {
    return size_of(c) <= error;
}

/// Y and G_i on a part of the step.
template <class S, std::size_t Constraints>
struct part_forms {
    errbound::roots::control_values<S, 3> y;
    std::array<errbound::roots::control_values<S, 4>, Constraints> g;
};

/// The errors of all control values after up to max_depth halvings.
template <class S>
struct form_errors {
    S y, g;
};

/// The forms over the whole step, with the errors that all their parts share.
template <class S, template <class> class Forms>
struct whole_step {
    static constexpr std::size_t constraints =
        std::tuple_size_v<decltype(std::declval<Forms<S>>().inside())>;

    part_forms<S, constraints> forms;
    form_errors<S> errors;

    constexpr whole_step(const Forms<S>& f, const sizes<S>& m) {
        using std::max;
        const S y_error = m.template error_of_y<Forms>();
        const S g_error = m.template error_of_g<Forms>();
        forms.y = errbound::roots::control_values_of(f.y());
        const auto g = f.inside();
        S largest(0.0);
        for (std::size_t i = 0; i < constraints; ++i) {
            forms.g[i] = errbound::roots::control_values_of(g[i]);
            largest = max(largest, size_of(forms.g[i]));
        }
        using real = typename real_of<S>::type;
        errors = {y_error + size_of(forms.y) * S(y_constants<Forms, real>.halvings),
                  g_error + largest * S(g_constants<Forms, real>.halvings)};
    }

    /// Some G_i is certainly negative throughout.
    constexpr mask<S> outside() const {
        mask<S> found = below(forms.g[0], errors.g);
        for (std::size_t i = 1; i < constraints; ++i) found = found | below(forms.g[i], errors.g);
        return found;
    }
};

}  // namespace ccd::static_filter
