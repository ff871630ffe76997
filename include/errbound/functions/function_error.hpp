// Assumed errors of the C library's elementary functions. Users may replace them.
#pragma once

#include <errbound/number_traits.hpp>

namespace errbound {

/// Named as in the C library.
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

/// MinGW-w64's sine of 10^22 is 0.46, not −0.85; musl on ARM computes long doubles in double.
constexpr bool has_documented_errors([[maybe_unused]] bool is_wide) {
#if defined(_WIN32)
    return false;
#elif defined(__GLIBC__)
    return true;
#else
    return !is_wide;
#endif
}

/// The default of function_error for each function, in the order of the enumeration; 0 if unknown.
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

/// Larger angles are reduced by angle_reduction.hpp, not by the C library.
inline constexpr double least_reduced_angle = 0x1p20;

}  // namespace detail

/// The assumption for arguments of type T in the domain of F: a finite result v is within this many
/// units in the last place of the exact result f. For subnormal f the unit is η. Rounding is to
/// nearest. The number must be from 0.5 to 1024. For sin, cos and tan it covers only arguments
/// below 2^20, since glibc reduces larger doubles with an absolute error.
///
/// The defaults are upper bounds of the errors in two sources: the GNU C library's manual ("Known
/// Maximum Errors in Math Functions", x86-64); Gladman, Innocente, Mather and Zimmermann (Accuracy
/// of Mathematical Functions ...), with float and double of other libraries. `errbound validate
/// --functions all` tests them. There is no default on Windows, nor for long double of other
/// libraries: specialise function_error before the first use:
///
///   template <>
///   inline constexpr double errbound::function_error<errbound::elementary_function::exp, double> =
///       0.52;
template <elementary_function F, class T>
inline constexpr double function_error = detail::documented_error(F, number_traits<T>::digits > 53);

}  // namespace errbound
