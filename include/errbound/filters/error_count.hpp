// The error-counting scalar: runs an algorithm once, on sizes instead of numbers, and so derives
// the constant of a static filter from the very code that the filter will run.
//
// In notation: ε the largest relative error of one rounding in any direction, η the smallest
// positive number, M a bound on the sizes of the inputs. A number x computed as x̂ is represented by
//     |x̂| <= magnitude·M^k + underflow·η·max(1, M)^(k−1),
//     |x̂ − x| <= error·ε·M^k + underflow·η·max(1, M)^(k−1)
// where k is its degree in the inputs. Rounding, in any direction and fused or not, is paid for in
// `error`; underflow of products in `underflow` (sums do not lose anything to underflow).
//
// Products whose factors have sizes of their own (M_x, M_y, ...) are served alike, if all terms of
// every sum have the same factors or M^k is replaced by the largest of their products.
//
// Proof: proofs/ErrorCount.v, count_sound; of expressions whose constants are whole and not zero,
// and counts far from 1/η (count_height).
#pragma once

#include <concepts>
#include <errbound/number_traits.hpp>

namespace errbound::filters {

/// Of floating-point type T, in which the counts are computed, too.
template <std::floating_point T>
struct basic_error_count {
    T magnitude = 0;
    T error = 0;
    T underflow = 0;

    constexpr basic_error_count() = default;
    constexpr basic_error_count(T m, T e, T u) : magnitude(m), error(e), underflow(u) {}
    /// A constant, exactly known: one that T has.
    constexpr basic_error_count(double constant)
        : magnitude(static_cast<T>(constant < 0 ? -constant : constant)) {}

    /// An input that is known exactly, of size at most M.
    static constexpr basic_error_count exact() { return {1, 0, 0}; }
    /// The rounded difference of two exact numbers; M is a bound on the computed differences.
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
                // Twice the third: â may exceed its magnitude by its underflow. In the last: η for
                // the rounding, and the products of two underflows, far less than one η.
                rounded(a.magnitude * b.underflow + a.underflow * b.magnitude +
                        (a.error * b.underflow + a.underflow * b.error) * (2 * epsilon) + 2)};
    }
    /// The larger of each, for one constant that serves several results.
    friend constexpr basic_error_count worst(const basic_error_count& a,
                                             const basic_error_count& b) {
        const auto larger = [](T x, T y) { return x < y ? y : x; };
        return {larger(a.magnitude, b.magnitude), larger(a.error, b.error),
                larger(a.underflow, b.underflow)};
    }

  private:
    /// Pays for the rounding of the count itself and of the counted result's size: every count
    /// stands for at most ten roundings, each a factor of at most 1 + ε.
    static constexpr T rounded(T count) { return count * (1 + 16 * number_traits<T>::epsilon()); }
};
using error_count = basic_error_count<double>;

}  // namespace errbound::filters
