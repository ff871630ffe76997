// The scalar of static filters holds an expression's value and size; its type has the number of
// roundings. A sign is certain if |value| exceeds a constant times the size.
//
// Notation: docs/notation.md; rounding is to nearest. A number x is computed as x̂. Its size S is
// the expression with all terms positive: magnitudes of coordinates and of their differences, + for
// −, and τ = 4·smallest_normal/u added to each product. After k roundings (counted by `filtered`)
// |x̂ − x| <= ((1 + u)^k − 1)·S. Proof, without contraction: proofs/filters/StaticFilter.v,
// filter_error. The counts k − 1 of orient2d, orient3d and incircle are 3, 7 and 10, as in the
// A-filters of Shewchuk 1997, Adaptive Precision Floating-Point Arithmetic; insphere has 15 instead
// of 16.
#pragma once

#include <concepts>
#include <errbound/detail/rounded.hpp>
#include <errbound/number_traits.hpp>
#include <errbound/sign.hpp>
#include <type_traits>

namespace errbound::filters {

/// constant(k) = ku(1 + (4k + 8)u), so that constant(k)·Ŝ bounds the error after k roundings, where
/// Ŝ is the computed size. At most 2k + 2 roundings reduce Ŝ, by a factor of at least 1 − u each.
/// Half of each τ covers underflow in x̂ (below), the other half covers underflow in Ŝ. So |x̂ − x|
/// <= ku(1 + ku)·(1 + (2k + 5)u)·Ŝ < constant(k)·Ŝ. The slack of at least 3u covers rounding the
/// constant and the bound. Since uτ is a normal number, the
/// bound does not underflow.
template <std::floating_point T>
constexpr T filter_constant(int k) {
    constexpr T u = number_traits<T>::unit_roundoff();
    return T(k) * u * (1 + T(4 * k + 8) * u);
}

/// An intermediate result. Roundings is k, Products counts the τ still to be added to the size, and
/// Plain is true if size = |value|. Induction for the error bound:
/// - a coordinate: k = 0, S is its magnitude. A difference d of two: k = 1, S = |d̂| as computed,
///   and |d̂ − d| <= u|d̂|.
/// - x ± y: k = max(k_x, k_y) + 1, S = S_x + S_y. Before rounding, the computed sum is at most (1 +
///   u)^max(k_x, k_y)·S in magnitude.
/// - x·y: k = k_x + k_y + 1, S = S_x·S_y + τ. |x̂·ŷ − x·y| <= ((1 + u)^(k_x + k_y) − 1)·S_x·S_y.
///   Rounding adds at most u·|x̂·ŷ|, underflow at most η/2 < uτ/2.
///
/// Rounding is monotone, so Ŝ >= |x̂|. If an operand is infinite or NaN, so is the size, and no
/// sign is certain. Proof: proofs/filters/StaticFilter.v, overflow_uncertain. With contraction a
/// value can overflow where its size does not, so sign_of also tests the value.
template <std::floating_point T, int Roundings, int Products, bool Plain>
struct filtered {
    static_assert(Roundings < 1000, "errbound: the constant holds for fewer than 1000 roundings");
    using value_type = T;
    static constexpr int roundings = Roundings, products = Products;
    static constexpr bool plain = Plain;
    static constexpr T allowance =
        4 * number_traits<T>::smallest_normal() / number_traits<T>::unit_roundoff();  ///< τ

    T value;
    T size;  ///< without Products·τ

    constexpr T full_size() const { return Products == 0 ? size : size + T(Products) * allowance; }
    constexpr filtered operator-() const { return {-value, size}; }

    /// The sign is uncertain if the value is not finite or |value| <= bound(), except for an exact
    /// zero. The last rounding keeps signs, so constant(k − 1) suffices. Proof:
    /// proofs/filters/StaticFilter.v, filter_bound.
    constexpr T bound() const {
        if constexpr (Roundings <= 1) return T(0);
        return filter_constant<T>(Roundings - 1) *
               (size + T(Products == 0 ? 1 : Products) * allowance);
    }
    /// Proof: proofs/filters/StaticFilter.v, filter_sign_certain.
    friend constexpr sign_type sign_of(const filtered& x) {
        const T magnitude = number_traits<T>::abs(x.value);
        bool decided = magnitude > x.bound();
        // After at most one rounding the bound is 0, so an infinite value would have a certain
        // sign.
        if constexpr (detail::may_contract || Roundings <= 1)
            decided = decided && number_traits<T>::is_finite(x.value);
        if (decided) [[likely]]
            return x.value > 0 ? sign_type::positive : sign_type::negative;
        // After at most one rounding, a zero is exact.
        return Roundings <= 1 && Products == 0 && x.value == 0 ? sign_type::zero
                                                               : sign_type::uncertain;
    }
};

/// A difference of two coordinates has its magnitude as size, not the sum of their sizes.
template <std::floating_point T>
struct filtered_coordinate {
    using value_type = T;
    T value;

    constexpr auto operator-() const { return -as_filtered(*this); }
    friend constexpr sign_type sign_of(const filtered_coordinate& x) {
        return sign_of(as_filtered(x));
    }
    friend constexpr filtered<T, 0, 0, true> as_filtered(const filtered_coordinate& x) {
        return {x.value, number_traits<T>::abs(x.value)};
    }
    friend constexpr filtered<T, 1, 0, true> operator-(const filtered_coordinate& x,
                                                       const filtered_coordinate& y) {
        const T d = x.value - y.value;
        return {d, number_traits<T>::abs(d)};
    }
};
template <std::floating_point T, int R, int P, bool Plain>
constexpr const filtered<T, R, P, Plain>& as_filtered(const filtered<T, R, P, Plain>& x) {
    return x;
}

template <class>
inline constexpr bool is_filtered = false;
template <class T, int R, int P, bool Plain>
inline constexpr bool is_filtered<filtered<T, R, P, Plain>> = true;
template <class T>
inline constexpr bool is_filtered<filtered_coordinate<T>> = true;
template <class X>
concept filtered_operand = is_filtered<X>;

/// A whole number; an int may be rounded on conversion to float.
template <std::floating_point T>
constexpr auto filtered_constant(int c) {
    const T v = static_cast<T>(c);
    return filtered<T, (number_traits<T>::digits < 31), 0, true>{v, number_traits<T>::abs(v)};
}

template <class X, class Y>
constexpr auto filtered_sum(typename X::value_type value, const X& x, const Y& y) {
    using T = typename X::value_type;
    constexpr int roundings = (X::roundings > Y::roundings ? X::roundings : Y::roundings) + 1;
    return filtered<T, roundings, X::products + Y::products, false>{value, x.size + y.size};
}
template <class X, class Y>
constexpr auto filtered_product(const X& x, const Y& y) {
    using T = typename X::value_type;
    constexpr int roundings = X::roundings + Y::roundings + 1;
    const T v = x.value * y.value;
    constexpr bool plain = X::plain && Y::plain && X::products == 0 && Y::products == 0;
    if constexpr (plain)  // |x|·|y| is |xy|, also when rounded
        return filtered<T, roundings, 1, true>{v, number_traits<T>::abs(v)};
    else
        return filtered<T, roundings, 1, false>{v, x.full_size() * y.full_size()};
}

template <filtered_operand X, filtered_operand Y>
constexpr auto operator+(const X& x, const Y& y) {
    return filtered_sum(x.value + y.value, as_filtered(x), as_filtered(y));
}
template <filtered_operand X, filtered_operand Y>
constexpr auto operator-(const X& x, const Y& y) {
    return filtered_sum(x.value - y.value, as_filtered(x), as_filtered(y));
}
template <filtered_operand X, filtered_operand Y>
constexpr auto operator*(const X& x, const Y& y) {
    return filtered_product(as_filtered(x), as_filtered(y));
}
template <filtered_operand X>
constexpr auto operator+(const X& x, std::same_as<int> auto c) {
    return as_filtered(x) + filtered_constant<typename X::value_type>(c);
}
template <filtered_operand X>
constexpr auto operator+(std::same_as<int> auto c, const X& x) {
    return x + c;
}
template <filtered_operand X>
constexpr auto operator-(const X& x, std::same_as<int> auto c) {
    return as_filtered(x) - filtered_constant<typename X::value_type>(c);
}
template <filtered_operand X>
constexpr auto operator-(std::same_as<int> auto c, const X& x) {
    return filtered_constant<typename X::value_type>(c) - as_filtered(x);
}
template <filtered_operand X>
constexpr auto operator*(const X& x, std::same_as<int> auto c) {
    return as_filtered(x) * filtered_constant<typename X::value_type>(c);
}
template <filtered_operand X>
constexpr auto operator*(std::same_as<int> auto c, const X& x) {
    return x * c;
}

}  // namespace errbound::filters
