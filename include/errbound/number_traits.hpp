// Facts about a floating-point type: unit roundoff, underflow unit, exponents.
#pragma once

#include <cmath>
#include <errbound/environment.hpp>
#include <limits>
#include <type_traits>

namespace errbound {

/// std::ldexp and std::frexp for constant expressions, where some compilers' do not work.
namespace detail {

/// x·2^e in steps. At most one step rounds, unless the result is 0.
template <class T>
constexpr T scaled_by_steps(const T& x, int e) {
    constexpr int most = std::numeric_limits<T>::max_exponent, step = most - most / 8;
    T y = x;
    for (int rest = e < -4 * most ? -4 * most : e > 4 * most ? 4 * most : e; rest != 0;) {
        const int next = rest % step != 0 ? rest % step : rest < 0 ? -step : step;
        T power = 1;
        for (int i = 0; i < (next < 0 ? -next : next); ++i) power *= next < 0 ? T(0.5) : T(2);
        y *= power;
        rest -= next;
    }
    return y;
}
template <class T>
constexpr int exponent_by_steps(const T& x) {
    int e = 0;
    T y = x < 0 ? -x : x;
    for (; y >= 1; ++e) y /= 2;
    for (; y < T(0.5); --e) y *= 2;
    return e;
}

template <class T>
inline constexpr bool fma_is_instruction =
#if defined(__FP_FAST_FMA) || defined(__FMA__) || defined(__AVX512F__) || defined(__CUDA_ARCH__)
    sizeof(T) <= sizeof(double);
#else
    false;
#endif

}  // namespace detail

/// For a type without std::numeric_limits (a SIMD pack), specialise the members that your calls
/// use.
template <class T>
struct number_traits {
    static_assert(std::numeric_limits<T>::is_specialized && !std::numeric_limits<T>::is_integer,
                  "errbound: specialise errbound::number_traits for this number type");
    static_assert(!std::is_floating_point_v<T> || detail::is_ieee_format<T>,
                  "errbound: not an IEEE 754 binary format, as long double on some PowerPC");
    static_assert(std::numeric_limits<T>::radix == 2 &&
                      std::numeric_limits<T>::digits < (std::numeric_limits<int>::max)() &&
                      std::numeric_limits<T>::round_style == std::round_to_nearest,
                  "errbound: numbers must be binary, of fixed precision, and rounded to nearest");

    /// ε = 2u, a bound of the relative error of one rounding in any direction.
    static constexpr T epsilon() { return std::numeric_limits<T>::epsilon(); }
    /// u = ε/2, a bound of the relative error of one rounding to nearest.
    static constexpr T unit_roundoff() { return epsilon() / 2; }
    /// η, the smallest positive number. An operation that underflows is off by less than this.
    static constexpr T underflow_unit() {
        // Boost.Multiprecision's denorm_min is 0 if there are no subnormal numbers.
        if constexpr (has_subnormals)
            return std::numeric_limits<T>::denorm_min();
        else
            return smallest_normal();
    }
    static constexpr T smallest_normal() { return (std::numeric_limits<T>::min)(); }
    static constexpr T largest() { return (std::numeric_limits<T>::max)(); }
    /// The result of an overflow; NaN for a format without infinities.
    static constexpr T infinity() { return std::numeric_limits<T>::infinity(); }
    static constexpr bool has_infinity = std::numeric_limits<T>::has_infinity;
    static constexpr int max_exponent = std::numeric_limits<T>::max_exponent;
    /// 2^(min_exponent − 1) is the smallest normal number, 2^max_exponent the first power of two
    /// above the largest number. (Both exponents of Boost's cpp_bin_float are one less.)
    static constexpr int min_exponent = std::numeric_limits<T>::min_exponent;
    /// If false, η is the smallest normal number, and even sums may underflow.
    static constexpr bool has_subnormals = [] {
        if constexpr (std::is_floating_point_v<T>)
            return true;
        else
            return std::numeric_limits<T>::has_denorm == std::denorm_present;
    }();
    static constexpr int digits = std::numeric_limits<T>::digits;  ///< the precision p in bits

    static constexpr T abs(const T& x) {
        // fabs is one instruction; the comparison takes more, since −0 stays −0.
        if constexpr (std::is_floating_point_v<T>)
            if (!std::is_constant_evaluated()) return std::fabs(x);
        return x < 0 ? -x : x;
    }
    static constexpr T(max)(const T& x, const T& y) { return x < y ? y : x; }
    static constexpr bool is_finite(const T& x) { return abs(x) <= largest(); }
    /// √x, rounded once; NaN below zero.
    static constexpr T sqrt(const T& x) {
        using std::sqrt;
        return sqrt(x);
    }
    /// ab + c, rounded once.
    static constexpr T fma(const T& a, const T& b, const T& c) {
        // Boost.Multiprecision's fma rounds twice, as does libstdc++'s for 16 bits.
        static_assert(std::is_floating_point_v<T> && sizeof(T) >= sizeof(float),
                      "errbound: specialise errbound::number_traits for an fma that rounds once");
#ifdef __MINGW32__
        // The C library's fma rounds twice, and std::fma calls it without optimisation.
        static_assert(detail::fma_is_instruction<T>,
                      "errbound: this C library's fma rounds twice; for float and double "
                      "compile with -mfma");
        if constexpr (sizeof(T) == sizeof(float))
            return __builtin_fmaf(a, b, c);
        else
            return __builtin_fma(a, b, c);
#else
        // If ab underflows, musl's fma(a, b, 0) returns a zero of the wrong sign.
        if constexpr (!detail::fma_is_instruction<T>)
            if (c == 0 && a != 0 && b != 0) return a * b;
        return std::fma(a, b, c);
#endif
    }
    /// x·2^e, rounded once.
    static constexpr T scale(const T& x, int e) {
        if constexpr (std::is_floating_point_v<T>)
            if (std::is_constant_evaluated()) return detail::scaled_by_steps(x, e);
        using std::ldexp;
        return ldexp(x, e);
    }
    /// e with 2^(e−1) <= |x| < 2^e, for x finite and not zero.
    static constexpr int exponent(const T& x) {
        if constexpr (std::is_floating_point_v<T>)
            if (std::is_constant_evaluated()) return detail::exponent_by_steps(x);
        using std::frexp;
        int e = 0;
        (void)T(frexp(x, &e));
        return e;
    }
};

/// True if T has infinities, or if its custom number_traits does not define has_infinity.
/// Otherwise overflow gives NaN, and the custom `max` must return NaN if x or y is NaN.
template <class T>
inline constexpr bool has_infinity = [] {
    if constexpr (requires { number_traits<T>::has_infinity; })
        return number_traits<T>::has_infinity;
    else
        return true;
}();

namespace detail {

/// The type in which T's operations are computed before rounding to T: its computed_in, or T.
template <class T>
struct type_that_computes {
    using type = T;
};
template <class T>
requires requires {
    typename number_traits<T>::computed_in;
}
struct type_that_computes<T> {
    using type = typename number_traits<T>::computed_in;
};

}  // namespace detail

/// True if T has subnormal numbers, or if its custom number_traits does not define has_subnormals.
template <class T>
inline constexpr bool has_subnormals = [] {
    if constexpr (requires { number_traits<T>::has_subnormals; })
        return number_traits<T>::has_subnormals;
    else
        return true;
}();

}  // namespace errbound
