// The constants of the static filters' error bounds, computed by evaluating the forms.
//
// Errors of Y are in units of m_x·m_y·m_z, since each of its terms has one factor from each axis.
// Errors of a G_i are in units of the largest (m_i·m_j)², since each term has two factors from each
// of two axes. The m are a query's difference_extents.
#pragma once

#include <ccd/methods/forms.hpp>
#include <cstddef>
#include <errbound/filters/error_count.hpp>
#include <errbound/number_traits.hpp>
#include <errbound/roots/control_values.hpp>

namespace ccd::static_filter {

inline constexpr std::size_t max_depth = 12;

/// From this depth on, a part where Y is within its error goes to exact arithmetic. (At smaller
/// depths, halving may still show that some G_i is negative everywhere.)
inline constexpr std::size_t patient_depth = 3;

/// Larger differences go to later stages, so that forms of degree 4 stay far from overflow. (Floats
/// are in units of a scene's size.)
template <class Real>
inline constexpr Real largest_difference = 0x1p200;
template <>
inline constexpr float largest_difference<float> = 4;

/// |ĉ − c| <= relative·unit + absolute, where c = multiple(n)·b for a control value b of a form of
/// degree n, as errbound/roots/control_values.hpp stores it. The head of this file defines the
/// unit.
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

/// The error that max_depth halvings add to control values of size at most 1. Each level takes the
/// previous one's worst error for all values, so it holds for either half. Proof:
/// proofs/filters/FilterStages.v, halving_error_enough.
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

/// Covers the roundings of the bounds' own evaluation.
inline constexpr double slack = 1.01;

/// Covers the underflow of the bounds' own evaluation, and is far below any bound that matters.
template <class Real>
inline constexpr double negligible = 0x1p-1000;
template <>
inline constexpr double negligible<float> = 0x1p-140;

/// Returns the constants of a form of this degree from its counted errors. Underflow may be
/// multiplied by degree − 1 differences of up to largest_difference (error_count.hpp).
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

/// A difference of doubles, rounded to Real. Floats may underflow. Proof:
/// proofs/filters/RoundedAxes.v, converted_difference_near.
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

}  // namespace ccd::static_filter
