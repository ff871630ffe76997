// Error-free transformations: an operation's rounded result and its exact rounding error. Requires
// a binary format with gradual underflow and rounding to nearest. Notation: docs/notation.md.
#pragma once

#include <errbound/detail/power_of_two.hpp>
#include <errbound/detail/rounded.hpp>
#include <errbound/number_traits.hpp>
#include <type_traits>

namespace errbound {

template <class T>
struct with_error {
    T value, error;
};

namespace detail {

/// u|v| + η, rounded: at least the error of any result rounded to nearest to v. u|v| is exact or
/// underflows. If adding η changes nothing, v is too large for underflow, and u|v| suffices.
template <class T>
constexpr T half_ulp(const T& v) {
    using traits = number_traits<T>;
    return rounded_product(traits::abs(v), traits::unit_roundoff()) + traits::underflow_unit();
}

}  // namespace detail

/// a + b = value + error exactly, value = a ⊕ b. Precondition: no overflow, even of intermediate
/// results; otherwise value or error is infinite or NaN. Cost: 6 operations. Source: Knuth, TAOCP
/// 2, 4.2.2, Theorem B; any precision >= 2. Proof: proofs/floats/ErrorFree.v, two_sum_exact.
template <class T>
constexpr with_error<T> two_sum(const T& a, const T& b) {
    const T x = detail::rounded(a), y = detail::rounded(b);
    const T sum = x + y;
    const T y_in_sum = sum - x;
    return {sum, (x - (sum - y_in_sum)) + (y - y_in_sum)};
}

/// a + b = value + error exactly. Precondition: |a| >= |b| or a = 0, and no overflow. Cost: 3
/// operations. Source: Dekker 1971 (Fast2Sum). Proof: proofs/floats/ErrorFree.v,
/// fast_two_sum_exact.
template <class T>
constexpr with_error<T> fast_two_sum(const T& a, const T& b) {
    const T x = detail::rounded(a), y = detail::rounded(b);
    const T sum = x + y;
    return {sum, y - (sum - x)};
}

/// True if fma(a, b, c) is one instruction.
template <class T>
inline constexpr bool has_fast_fma = false;
#if defined(__FP_FAST_FMA) || defined(__FMA__)
template <>
inline constexpr bool has_fast_fma<double> = true;
#endif
#if defined(__FP_FAST_FMAF) || defined(__FMA__)
template <>
inline constexpr bool has_fast_fma<float> = true;
#endif

inline constexpr int least_precision_for_split = 4;

/// x = value + error exactly. With s = ⌈p/2⌉, value has at most p − s bits and error at most s − 1,
/// so products of such parts are exact. Precondition: p >= least_precision_for_split, and (2^s +
/// 1)x does not overflow (|x| < 2^996 for double, 2^115 for float). On overflow the parts are
/// infinite or NaN. Cost: 4 operations. Source: Veltkamp; Dekker 1971; Boldo 2006 (Pitfalls of a
/// full floating-point proof). Proof, with the weaker claim of at most s bits in the error:
/// proofs/floats/ErrorFree.v, split_exact.
template <class T>
constexpr with_error<T> split(const T& x) {
    constexpr int s = (number_traits<T>::digits + 1) / 2;
    const T c = detail::rounded_product(T(T(detail::power_of_two(s)) + 1), x);
    const T high = c - (c - x);
    return {high, x - high};
}

/// a·b = value + error exactly, value = a ⊙ b, if product_error_is_exact(a, b, result); otherwise
/// error is unreliable, infinite or NaN. Cost: 2 operations with hardware FMA, otherwise 17.
/// Source: Dekker 1971 (TwoProduct). Proof: proofs/floats/ErrorFree.v, two_product_exact,
/// two_product_fma_exact.
template <class T>
constexpr with_error<T> two_product(const T& a, const T& b) {
    const T v = detail::rounded_product(a, b);
    if constexpr (has_fast_fma<T>) {
        if (!std::is_constant_evaluated()) {
            if constexpr (sizeof(T) == sizeof(float))
                return {v, __builtin_fmaf(a, b, -v)};
            else
                return {v, __builtin_fma(a, b, -v)};
        }
    }
    const auto [a_high, a_low] = split(a);
    const auto [b_high, b_low] = split(b);
    const T first = detail::rounded_product(a_high, b_high) - v;
    const T middle =
        (first + detail::rounded_product(a_high, b_low)) + detail::rounded_product(a_low, b_high);
    return {v, middle + detail::rounded_product(a_low, b_low)};
}

/// True if two_product(a, b)'s result is known to be exact, with or without FMA. Value and error
/// must be finite, and |a|, |b| <= largest()/2^(s+2) with s = ⌈p/2⌉ (2^995 for double, 2^114 for
/// float). An operand must be zero, or 2^(2p)·η <= |value| <= largest()/4 (from 2^-968 for double,
/// 2^-101 for float). Without FMA also p >= least_precision_for_split. Derivation: the error and
/// Dekker's intermediate results are multiples of ulp(a)·ulp(b), which is at least η, since |a| <
/// 2^p·ulp(a), |b| < 2^p·ulp(b) and |ab| >= |value|/(1 + u). No overflow: in split(x), for x = a or
/// b, products are below 2^(s+1)·|x| and high parts at most 1.25|x|. Proof:
/// proofs/rules/IeeeInterval.v, product_known.
template <class T>
constexpr bool product_error_is_exact(const T& a, const T& b, const with_error<T>& product) {
    using traits = number_traits<T>;
    if (!traits::is_finite(product.value) || !traits::is_finite(product.error)) return false;
    constexpr int s = (traits::digits + 1) / 2;
    const T most = traits::largest() / T(detail::power_of_two(s + 2));
    if (traits::abs(a) > most || traits::abs(b) > most) return false;
    if (a == 0 || b == 0) return true;
    if (!has_fast_fma<T> && traits::digits < least_precision_for_split) return false;
    if (traits::abs(product.value) > traits::largest() / T(4)) return false;
    return traits::abs(product.value) >=
           traits::underflow_unit() / traits::unit_roundoff() / traits::unit_roundoff();
}

/// The remainder a − q·b of a rounded quotient q = a ⊘ b. Precondition: b finite and not zero.
template <class T>
struct division_remainder {
    T value;
    bool exact;  ///< otherwise value is unreliable, infinite or NaN
};

/// Computes a − q·b for q = a ⊘ b. Exact if a = 0, or if q ≠ 0 and two_product(q, b) = (v, e) is.
/// In the latter case v is between a/2 and 2a, so a − v is exact (Sterbenz). (a − v) − e is a
/// multiple of ulp(q)·ulp(b) >= η and at most |b|·ulp(q)/2, so it is exact too. Cost: a two_product
/// and 2 operations. Source: Pichat 1976; Bohlender, Walter, Kornerup, Matula 1991. Proof:
/// proofs/floats/ErrorFree.v, remainder_of_division_exact; with overflow,
/// proofs/rules/IeeeInterval.v, remainder_known.
template <class T>
constexpr division_remainder<T> remainder_of_division(const T& a, const T& b, const T& q) {
    using traits = number_traits<T>;
    if (a == 0) return {T(0), traits::is_finite(q)};
    const with_error<T> product = two_product(q, b);
    const bool exact = q != 0 && product_error_is_exact(q, b, product);
    return {(a - product.value) - product.error, exact};
}

/// Computes x − v² for v = fl(√x), x >= 0 finite. Exact if x = 0, or if two_product(v, v) is. |√x −
/// v| <= ulp(v)/2, so x − v² is a multiple of ulp(v)² and at most v·ulp(v) in size. Cost and
/// source: see remainder_of_division. Proof: proofs/rules/IeeeSlopes.v, remainder_of_root_known.
template <class T>
constexpr division_remainder<T> remainder_of_root(const T& x, const T& v) {
    return remainder_of_division(x, v, v);
}

}  // namespace errbound
