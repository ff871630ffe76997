// Certain signs, and the value for an uncertain one.
#pragma once

#if __cplusplus < 202002L
#error "errbound is written in C++20: compile with -std=c++20 or later"
#endif

#include <cstdint>

namespace errbound {

/// The sign of a number known up to a bound. `uncertain` is not a sign and never converts to one.
enum class sign_type : std::uint8_t { negative, zero, positive, uncertain };

/// Signs have no order: compare by == or functions such as certainly_nonnegative. So < does not
/// compile at run time. Generic code uses it in constant expressions, to detect if an enumeration
/// is signed.
consteval bool operator<(sign_type s, sign_type t) {
    return static_cast<int>(s) < static_cast<int>(t);
}
consteval bool operator>(sign_type s, sign_type t) {
    return t < s;
}
consteval bool operator<=(sign_type s, sign_type t) {
    return !(t < s);
}
consteval bool operator>=(sign_type s, sign_type t) {
    return !(s < t);
}

constexpr bool certain(sign_type s) {
    return s != sign_type::uncertain;
}
constexpr bool certainly_nonnegative(sign_type s) {
    return s == sign_type::zero || s == sign_type::positive;
}
constexpr bool certainly_nonpositive(sign_type s) {
    return s == sign_type::zero || s == sign_type::negative;
}
constexpr bool possibly_positive(sign_type s) {
    return s == sign_type::positive || s == sign_type::uncertain;
}
constexpr bool possibly_negative(sign_type s) {
    return s == sign_type::negative || s == sign_type::uncertain;
}
constexpr bool possibly_zero(sign_type s) {
    return s == sign_type::zero || s == sign_type::uncertain;
}

constexpr sign_type operator-(sign_type s) {
    if (s == sign_type::negative) return sign_type::positive;
    if (s == sign_type::positive) return sign_type::negative;
    return s;
}

/// The sign of x·y. A certain zero makes the product zero for any other factor.
constexpr sign_type operator*(sign_type a, sign_type b) {
    if (a == sign_type::zero || b == sign_type::zero) return sign_type::zero;
    if (!certain(a) || !certain(b)) return sign_type::uncertain;
    return a == b ? sign_type::positive : sign_type::negative;
}

/// True for types whose operations + − × are exact (integers and rationals of any size).
/// Boost.Multiprecision's: errbound/multiprecision.hpp.
template <class T>
inline constexpr bool is_exact_number = false;

template <class T>
concept exact_number = is_exact_number<T>;

template <exact_number T>
constexpr sign_type sign_of(const T& x) {
    if (x > 0) return sign_type::positive;
    return x < 0 ? sign_type::negative : sign_type::zero;
}

/// x·2^e for small e >= 0.
template <exact_number Number>
Number scale(Number x, int e) {
    for (; e > 0; --e) x += x;
    return x;
}

}  // namespace errbound
