// Bound rules, number types, functions and compiler flags that must be rejected. Each case is
// compiled separately, with its name defined.

#ifdef CASE_fast_math  // void every error bound
// With -ffast-math, the headers must not compile.
#include <errbound/tracked.hpp>
#endif
#ifdef CASE_fast_math_ccd  // void every error bound
#include <ccd/method.hpp>
#endif

#ifdef CASE_decimal_numbers  // numbers must be binary
// Rules are for binary numbers.
#include <boost/multiprecision/cpp_dec_float.hpp>
#include <errbound/tracked.hpp>

const errbound::tracked<boost::multiprecision::cpp_dec_float_50> a = 2, sum = a + a;
#endif

#ifdef CASE_number_equality  // use_sign_of_or_compare
// A tracked number has no operator==: it would have to guess.
#include <errbound/tracked.hpp>

const bool is_zero = errbound::tracked<double>(1.0) == 0;
#endif

#ifdef CASE_number_ordering  // use_compare_or_by_value
// A tracked number has no operator<: it would have to guess.
#include <errbound/tracked.hpp>

const bool is_less = errbound::tracked<double>(1.0) < errbound::tracked<double>(3.0);
#endif

#ifdef CASE_octal_literal  // tracked_is_for_decimal_literals
// 010 is eight in C++, but ten as a decimal.
#include <errbound/decimal.hpp>

using namespace errbound::literals;
const auto eight_or_ten = 010_tracked;
#endif

#if defined(CASE_of_numbers) || defined(CASE_without_multiply)
#include <errbound/tracked.hpp>

struct incomplete {
    static constexpr const char* name = "incomplete";
    template <class T>
    using bound = errbound::tight::bound<T>;
    template <class T>
    static constexpr bound<T> exact(const T&) {
        return {};
    }
    template <class T>
    static constexpr bound<T> within(const T&, const T& error) {
        return {error};
    }
    template <class T>
    static constexpr T error(const T&, const bound<T>& b) {
        return b.error;
    }
    template <class T>
    static constexpr bound<T> subtract(const T&, auto a, auto) {
        return a.bound;
    }
    template <class T>
    static constexpr bound<T> scale(const T&, auto a, int) {
        return a.bound;
    }
};
#ifdef CASE_of_numbers  // a bound rule needs add.result, a, b., which returns bound<T>
// A bound rule whose add returns a number instead of a bound: the message must contain this.
struct rule : incomplete {
    template <class T>
    static constexpr T add(const T&, auto a, auto) {
        return a.bound.error;
    }
    template <class T>
    static constexpr bound<T> multiply(const T&, auto a, auto) {
        return a.bound;
    }
};
#endif
#ifdef CASE_without_multiply  // a bound rule needs multiply.result, a, b., which returns bound<T>
// A bound rule without multiply: the message must name the missing function.
struct rule : incomplete {
    template <class T>
    static constexpr bound<T> add(const T&, auto a, auto) {
        return a.bound;
    }
};
#endif
const errbound::tracked<double, rule> x = 1.0;
#endif

#ifdef CASE_overflowing_integer  // the integer type must never overflow
// Roots decided in an integer type that overflows.
#include <errbound/polynomial.hpp>

const auto count = errbound::count_roots<int>(errbound::polynomial{-2.0, 0.0, 1.0}, 0, 2);
#endif

#ifdef CASE_roots_by_another_rule  // as tight and sharp do: convert by within
// Roots are counted only by rules that store just the absolute error.
#include <errbound/polynomial.hpp>

using number = errbound::tracked<double, errbound::interval>;
const errbound::polynomial<number> p{number(-2), number(0), number(1)};
const auto count = errbound::count_roots(p, 0, 10);
#endif

#ifdef CASE_roots_without_subnormals  // sqrt needs a number type with subnormal
// The square root's bound needs gradual underflow.
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <errbound/functions.hpp>

const auto root = sqrt(errbound::tracked<boost::multiprecision::cpp_bin_float_50>(2));
#endif

#ifdef CASE_safe_division  // SafeBound has no rule for division
// SafeBound has no rule for division: the message must contain this.
#include <errbound/tracked.hpp>

const errbound::tracked<double, errbound::safe> a = 1.0, b = 3.0, quotient = a / b;
#endif

#ifdef CASE_twice_rounded_fma  // this C library's fma rounds twice
// MinGW-w64's fma of long doubles rounds twice on every processor.
#include <errbound/functions.hpp>

const errbound::tracked<long double> y = 2.0L, fused = fma(y, y, y);
#endif

#ifdef CASE_unknown_errors  // the errors of this C library's elementary functions are unknown
// The errors of the C library's functions are unknown, as on Windows: the message must contain
// this.
#include <errbound/elementary.hpp>

template <>
inline constexpr double errbound::function_error<errbound::elementary_function::sin, double> = 0;
const auto y = sin(errbound::tracked<double>(1.0));
#endif

#ifdef CASE_whole_numbers  // first argument of tracked must be a floating-point type
// Whole numbers have no rounding error to track.
#include <errbound/tracked.hpp>

const errbound::tracked<int> x = 1;
#endif

#ifdef CASE_without_subnormals  // no subnormal numbers.*use the rule .tight
// Boost's binary floats have no subnormal numbers: only the rule `tight` covers sums that
// underflow.
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <errbound/tracked.hpp>

using number = boost::multiprecision::cpp_bin_float_50;
const errbound::tracked<number, errbound::sharp> a = number(1), sum = a + a;
#endif
