// A scalar that counts errors. An algorithm runs on it once, with bounds instead of numbers. So a
// static filter's constant comes from the code that the filter will run.
//
// Notation: docs/notation.md; M bounds the inputs' magnitudes. A number x of degree k is computed
// as x̂:
//     |x̂| <= magnitude·M^k + underflow·η·max(1, M)^(k−1),
//     |x̂ − x| <= error·ε·M^k + underflow·η·max(1, M)^(k−1)
// This holds in any rounding direction, with or without FMA. Sums do not underflow. If inputs have
// separate bounds M_x, M_y, ..., M^k stands for the largest product of k of them in a term of a
// sum. Proof: proofs/filters/ErrorCount.v, count_sound. Constants are nonzero whole numbers there,
// and counts are far below 1/η (count_height).
#pragma once

#include <concepts>
#include <errbound/number_traits.hpp>

namespace errbound::filters {

template <std::floating_point T>
struct basic_error_count {
    T magnitude = 0;
    T error = 0;
    T underflow = 0;

    constexpr basic_error_count() = default;
    constexpr basic_error_count(T m, T e, T u) : magnitude(m), error(e), underflow(u) {}
    constexpr basic_error_count(double constant)
        : magnitude(static_cast<T>(constant < 0 ? -constant : constant)) {}

    static constexpr basic_error_count exact() { return {1, 0, 0}; }
    /// The rounded difference of exact numbers; M bounds the computed differences.
    static constexpr basic_error_count difference() { return {1, 1, 0}; }

    friend constexpr basic_error_count operator+(const basic_error_count& a,
                                                 const basic_error_count& b) {
        const T m = rounded(a.magnitude + b.magnitude);
        return {m, rounded(a.error + b.error + m), rounded(a.underflow + b.underflow)};
    }
    friend constexpr basic_error_count operator-(const basic_error_count& a,
                                                 const basic_error_count& b) {
        return a + b;
    }
    constexpr basic_error_count operator-() const { return *this; }
    /// |âb̂ − ab| <= |â|·|b̂ − b| + |â − a|·|b̂| + |â − a|·|b̂ − b|, and the product is rounded.
    friend constexpr basic_error_count operator*(const basic_error_count& a,
                                                 const basic_error_count& b) {
        constexpr T epsilon = number_traits<T>::epsilon();
        const T m = rounded(a.magnitude * b.magnitude);
        return {m,
                rounded(a.magnitude * b.error + a.error * b.magnitude +
                        a.error * b.error * epsilon + m),
                // The third term is doubled, since â may exceed its magnitude by its underflow. The
                // 2 covers η for the rounding, and products of two underflows.
                rounded(a.magnitude * b.underflow + a.underflow * b.magnitude +
                        (a.error * b.underflow + a.underflow * b.error) * (2 * epsilon) + 2)};
    }
    /// The larger of each count, so that one constant covers several results.
    friend constexpr basic_error_count worst(const basic_error_count& a,
                                             const basic_error_count& b) {
        const auto larger = [](T x, T y) { return x < y ? y : x; };
        return {larger(a.magnitude, b.magnitude), larger(a.error, b.error),
                larger(a.underflow, b.underflow)};
    }

  private:
    /// Covers rounding the count and the counted magnitude: at most ten factors of at most 1 + ε.
    static constexpr T rounded(T count) { return count * (1 + 16 * number_traits<T>::epsilon()); }
};
using error_count = basic_error_count<double>;

}  // namespace errbound::filters
