// An integer with a bound on its distance from the real number that it approximates.
#pragma once

#include <algorithm>
#include <errbound/sign.hpp>

namespace ccd::detail {

/// The real number is less than 2^error_bits away from `value`, or equal to it if error_bits <
/// exact/2. Bounds are powers of two, rounded up: each operation costs about one bit of precision.
/// Integer is a fixed_integer or long_integer, whose preconditions on widths apply.
template <class Integer>
struct bounded_integer {
    /// Low enough to stay below exact/2 after a few operations.
    static constexpr int exact = -(1 << 20);

    Integer value;
    int error_bits = exact;

    /// Proof: proofs/integers/BoundedInteger.v, bounded_sum_known, bounded_difference_known.
    friend constexpr bounded_integer operator+(const bounded_integer& a, const bounded_integer& b) {
        return {a.value + b.value, std::max(a.error_bits, b.error_bits) + 1};
    }
    friend constexpr bounded_integer operator-(const bounded_integer& a, const bounded_integer& b) {
        return {a.value - b.value, std::max(a.error_bits, b.error_bits) + 1};
    }
    /// Proof: proofs/integers/BoundedInteger.v, bounded_sign_certain.
    friend constexpr errbound::sign_type sign_of(const bounded_integer& x) {
        // |value| >= 2^(bit_length − 1), or is zero.
        const bool is_exact = x.error_bits < exact / 2;
        if (!is_exact && x.value.bit_length() <= std::max(x.error_bits, 0))
            return errbound::sign_type::uncertain;
        return sign_of(x.value);
    }
};

/// With |a| <= 2^m, |b| <= 2^n and errors below 2^d, 2^e, the error of the product is below
/// 2^(m + e) + 2^(n + d) + 2^(d + e). Proof: proofs/integers/BoundedInteger.v,
/// bounded_product_known.
template <class A, class B>
constexpr auto operator*(const bounded_integer<A>& a, const bounded_integer<B>& b) {
    using product = decltype(a.value * b.value);
    return bounded_integer<product>{
        a.value * b.value,
        2 + std::max({a.value.bit_length() + b.error_bits, b.value.bit_length() + a.error_bits,
                      a.error_bits + b.error_bits})};
}

}  // namespace ccd::detail
