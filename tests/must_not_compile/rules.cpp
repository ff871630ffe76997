// Bound rules, number types, functions and compiler flags that must be rejected. Each case is
// compiled separately, with its name defined.

#ifdef CASE_fast_math_ccd
// With -ffast-math, the headers of collision detection must not compile.
#include <ccd/method.hpp>

int main() {
    return 0;
}
#endif

#ifdef CASE_decimal_numbers
// Rules are for binary numbers.
#include <boost/multiprecision/cpp_dec_float.hpp>
#include <errbound/tracked.hpp>

int main() {
    const errbound::tracked<boost::multiprecision::cpp_dec_float_50> a = 2;
    return (a + a).value() > 0;
}
#endif

#ifdef CASE_number_equality
// A tracked number has no operator==: it would have to guess.
#include <errbound/tracked.hpp>

int main() {
    const errbound::tracked<double> a = 1.0;
    return a == 0;
}
#endif

#ifdef CASE_fast_math
// With -ffast-math, the headers must not compile.
#include <errbound/tracked.hpp>

int main() {
    return 0;
}
#endif

#ifdef CASE_octal_literal
// 010 is eight in C++, but ten as a decimal.
#include <errbound/decimal.hpp>

int main() {
    using namespace errbound::literals;
    return (010_tracked).value() == 8;
}
#endif

#ifdef CASE_of_numbers
// A bound rule whose add returns a number instead of a bound: the message must contain this.
#include <errbound/tracked.hpp>

struct bare {
    static constexpr const char* name = "bare";
    template <class T>
    using bound = errbound::tight::bound<T>;
    template <class T>
    using operand = errbound::rule_operand<T, bare>;
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
    static constexpr T add(const T&, operand<T> a, operand<T>) {
        return a.bound.error;
    }
    template <class T>
    static constexpr bound<T> subtract(const T&, operand<T> a, operand<T>) {
        return a.bound;
    }
    template <class T>
    static constexpr bound<T> multiply(const T&, operand<T> a, operand<T>) {
        return a.bound;
    }
    template <class T>
    static constexpr bound<T> scale(const T&, operand<T> a, int) {
        return a.bound;
    }
};

int main() {
    const errbound::tracked<double, bare> x = 1.0;
    return x.value() > 0;
}
#endif

#ifdef CASE_number_ordering
// A tracked number has no operator<: it would have to guess.
#include <errbound/tracked.hpp>

int main() {
    const errbound::tracked<double> a = 1.0, b = 3.0;
    return a < b;
}
#endif

#ifdef CASE_overflowing_integer
// Roots decided in an integer type that overflows.
#include <errbound/polynomial.hpp>

int main() {
    return errbound::count_roots<int>(errbound::polynomial{-2.0, 0.0, 1.0}, 0, 2) == 1;
}
#endif

#ifdef CASE_roots_by_another_rule
// Roots are counted only by rules that store just the absolute error.
#include <errbound/polynomial.hpp>

int main() {
    using number = errbound::tracked<double, errbound::interval>;
    const errbound::polynomial<number> p{number(-2), number(0), number(1)};
    return errbound::count_roots(p, 0, 10) == 1;
}
#endif

#ifdef CASE_roots_without_subnormals
// The square root's bound needs gradual underflow.
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <errbound/functions.hpp>

int main() {
    const errbound::tracked<boost::multiprecision::cpp_bin_float_50> a = 2;
    return sqrt(a).value() > 0;
}
#endif

#ifdef CASE_safe_division
// SafeBound has no rule for division: the message must contain this.
#include <errbound/tracked.hpp>

int main() {
    const errbound::tracked<double, errbound::safe> a = 1.0, b = 3.0;
    return (a / b).value() > 0;
}
#endif

#ifdef CASE_twice_rounded_fma
// MinGW-w64's fma of long doubles rounds twice on every processor.
#include <errbound/functions.hpp>

long double f(long double x) {
    const errbound::tracked<long double> y = x;
    return fma(y, y, y).error();
}
#endif

#ifdef CASE_unknown_errors
// The errors of the C library's functions are unknown, as on Windows: the message must contain
// this.
#include <errbound/elementary.hpp>

template <>
inline constexpr double errbound::function_error<errbound::elementary_function::sin, double> = 0;

double f(double x) {
    return sin(errbound::tracked<double>(x)).error();
}
#endif

#ifdef CASE_whole_numbers
// Whole numbers have no rounding error to track.
#include <errbound/tracked.hpp>

int main() {
    const errbound::tracked<int> x = 1;
    return x.value();
}
#endif

#ifdef CASE_without_multiply
// A bound rule without multiply: the message must name the missing function.
#include <errbound/tracked.hpp>

struct sums_only {
    static constexpr const char* name = "sums_only";
    template <class T>
    using bound = errbound::tight::bound<T>;
    template <class T>
    using operand = errbound::rule_operand<T, sums_only>;
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
    static constexpr bound<T> add(const T&, operand<T> a, operand<T>) {
        return a.bound;
    }
    template <class T>
    static constexpr bound<T> subtract(const T&, operand<T> a, operand<T>) {
        return a.bound;
    }
    template <class T>
    static constexpr bound<T> scale(const T&, operand<T> a, int) {
        return a.bound;
    }
};

int main() {
    const errbound::tracked<double, sums_only> x = 1.0;
    return x.value() > 0;
}
#endif

#ifdef CASE_without_subnormals
// Boost's binary floats have no subnormal numbers: only the rule `tight` covers sums that
// underflow.
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <errbound/tracked.hpp>

int main() {
    using number = boost::multiprecision::cpp_bin_float_50;
    const errbound::tracked<number, errbound::sharp> a = number(1);
    return (a + a).value() > 0;
}
#endif
