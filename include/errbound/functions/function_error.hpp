// How far the system's elementary functions are off: the assumption that bounds of
// errbound/elementary.hpp rest on, a number for each function and type, for users to replace.
#pragma once

#include <errbound/number_traits.hpp>

namespace errbound {

/// As the C library names them.
enum class elementary_function {
    exp,
    exp2,
    expm1,
    log,
    log2,
    log10,
    log1p,
    sin,
    cos,
    tan,
    asin,
    acos,
    atan,
    sinh,
    cosh,
    tanh,
    asinh,
    acosh,
    atanh,
    cbrt,
    pow,
    atan2
};

namespace detail {

/// Whether function_error's comment is of this C library's functions, of more bits than double or
/// not. (MinGW-w64's sine of 10^22 is 0.46, not −0.85; musl computes most of long doubles in double
/// on ARM.)
constexpr bool has_documented_errors([[maybe_unused]] bool is_wide) {
#if defined(_WIN32)
    return false;
#elif defined(__GLIBC__)
    return true;
#else
    return !is_wide;
#endif
}

/// In the order of elementary_function: at least what function_error's comment names; 0: unknown.
constexpr double documented_error(elementary_function f, bool is_wide) {
    if (!has_documented_errors(is_wide)) return 0;
    constexpr double narrow[] = {1, 1, 2, 1, 2, 3, 2, 1, 1, 2, 1, 1, 1, 3, 3, 3, 3, 3, 3, 5, 1, 2};
    constexpr double wide[] = {2, 2, 4, 2, 4, 3, 4, 3, 3, 3, 2, 2, 2, 4, 4, 4, 5, 5, 5, 2, 4, 3};
    return (is_wide ? wide : narrow)[static_cast<int>(f)];
}

constexpr bool is_function_of_angle(elementary_function f) {
    using enum elementary_function;
    return f == sin || f == cos || f == tan;
}

/// From this size on, angles are reduced by angle_reduction.hpp: the system's functions of them are
/// not evaluated.
inline constexpr double least_reduced_angle = 0x1p20;

}  // namespace detail

/// The assumption: wherever the system's function F has a finite result v for arguments of type T
/// in its domain, |v − f| is at most so many units in the last place of the exact result f, which
/// are of η where f is subnormal; in rounding to nearest. From 0.5 to 1024. For sin, cos and tan
/// this is assumed below 2^20 only, because glibc's reduction of larger doubles has an absolute
/// error: near multiples of π/2, cos(0x1.69eab0985179bp+246) is off by 136,921 units.
///
/// The defaults are at least the errors that the GNU C library documents (its manual, "Known
/// Maximum Errors in Math Functions", x86-64; for long double the larger one of those of 80 and 128
/// bits) and those found by Gladman, Innocente, Mather and Zimmermann (Accuracy of Mathematical
/// Functions in Single, Double, Double Extended, and Quadruple Precision), rounded up. `errbound
/// validate --functions all` tells whether they hold on a system. The second source has other
/// libraries', too, of float and double; of their long doubles, and of Windows' functions, nothing
/// is assumed: they do not compile unless it is specialised, as it may be for closer bounds, too,
/// before the first use:
///
///   template <>
///   inline constexpr double errbound::function_error<errbound::elementary_function::exp, double> =
///       0.52;
template <elementary_function F, class T>
inline constexpr double function_error = detail::documented_error(F, number_traits<T>::digits > 53);

}  // namespace errbound
