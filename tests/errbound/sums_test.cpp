// Undefined results have infinite errors under every rule. Bounds of long sums grow no faster than
// the classical running error bound. Prints a table of the sums; ERRBOUND_TEST_SCALE=100 has ten
// million terms.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <errbound/elementary.hpp>
#include <errbound/functions.hpp>
#include <errbound/printing.hpp>
#include <errbound/small_floats.hpp>
#include <errbound/validation/rule_list.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "tests/support/scaled.hpp"

namespace {

using errbound::number_traits;
using errbound::tracked;

/// Numbers with and without errors, from 0 to infinity, and NaN.
template <class Number>
std::vector<Number> numbers_of_all_sizes() {
    using T = typename Number::value_type;
    using traits = number_traits<T>;
    const T infinity = traits::infinity(), one(1);
    std::vector<Number> all;
    for (const T& v :
         {T(0), one, T(-3), static_cast<T>(0.1), traits::largest(), traits::smallest_normal(),
          traits::underflow_unit(), infinity, T(infinity - infinity)}) {
        all.push_back(Number(v));
        for (const T& e : {traits::underflow_unit(), one, traits::largest(), infinity,
                           T(infinity - infinity), T(-one)})
            all.push_back(Number::within(v, e));
    }
    return all;
}

/// The error is never NaN, and is infinite if the value is not finite.
template <class Number>
void expect_an_error(const Number& x, const char* what) {
    using traits = number_traits<typename Number::value_type>;
    const auto e = x.error();
    ASSERT_TRUE(e >= 0) << Number::rule_type::name << ": " << what << " of value "
                        << static_cast<double>(x.value());
    if (!traits::is_finite(x.value())) {
        ASSERT_EQ(e, traits::infinity()) << Number::rule_type::name << ": " << what;
    }
    if (!traits::is_finite(e)) {
        ASSERT_EQ(certain_digits(x), "unknown");
    }
}

template <class T, class Rule>
void expect_errors_of_operations() {
    using number = tracked<T, Rule>;
    const std::vector<number> all = numbers_of_all_sizes<number>();
    std::vector<number> made = all;
    for (const number& x : all) {
        for (const number& y : all) {
            made.push_back(x + y);
            made.push_back(x - y);
            made.push_back(x * y);
            if constexpr (errbound::has_division<Rule>) made.push_back(x / y);
            expect_an_error(made.back(), "a quotient");
            expect_an_error(fma(x, y, x), "fma");
            expect_an_error(hypot(x, y), "hypot");
            expect_an_error(min(x, y), "min");
            expect_an_error(copysign(x, y), "copysign");
            expect_an_error(midpoint(x, y), "midpoint");
            expect_an_error(lerp(x, y, x), "lerp");
            expect_an_error(dot(std::vector{x, y}, std::vector{y, x}), "dot");
        }
        for (const int e : {-5000, -1, 1, 5000}) made.push_back(scale(x, e));
    }
    for (const number& x : made) {
        expect_an_error(x, "an operation");
        expect_an_error(-x, "negation");
        expect_an_error(x - x, "x - x");
        expect_an_error(x * x + x, "a sum");
        expect_an_error(sqrt(x), "sqrt");
        expect_an_error(abs(x), "abs");
        expect_an_error(pow(x, 9), "pow");
    }
}

template <class T, class Rule>
void expect_errors_of_functions() {
    using number = tracked<T, Rule>;
    const std::vector<number> all = numbers_of_all_sizes<number>();
    for (const number& x : all) {
        for (const number& y :
             {exp(x), exp2(x), expm1(x), log(x), log1p(x), sin(x), tan(x), sinh(x), tanh(x),
              asin(x), acosh(x), atanh(x), cbrt(x), exp(x) - exp(x)})
            expect_an_error(y, "an elementary function");
        for (const number& y : all) {
            expect_an_error(pow(x, y), "pow");
            expect_an_error(atan2(x, y), "atan2");
        }
    }
}

TEST(Errors, OfUndefinedResultsAreInfiniteUnderEveryRule) {
    errbound::for_each_rule(errbound::all_rules(), []<class Rule>() {
        expect_errors_of_operations<double, Rule>();
        expect_errors_of_operations<float, Rule>();
        expect_errors_of_operations<errbound::float16, Rule>();
        expect_errors_of_functions<double, Rule>();
    });
}

TEST(Errors, OfUndefinedResultsExceedAnyTolerance) {
    const tracked<double> powered = exp(tracked<double>(710)), root = sqrt(tracked<double>(-1));
    for (const auto& x : {powered, powered - powered, root}) {
        EXPECT_TRUE(x.error() > 1e-6);
        EXPECT_EQ(x.error(), std::numeric_limits<double>::infinity());
    }
    EXPECT_EQ(with_radius(powered - powered), "nan ± unknown");
}

enum class signs { all_positive, alternating, random };

/// Calls term(positive) for each of n terms ±0.1.
template <class Term>
void for_each_term(signs how, std::int64_t n, const Term& term) {
    std::uint64_t state = 1;
    for (std::int64_t i = 0; i < n; ++i) {
        state = state * 6364136223846793005U + 1442695040888963407U;
        term(how == signs::all_positive || (how == signs::alternating ? i % 2 == 0 : state >> 63));
    }
}

/// The rule's bound of the sum.
template <class T, class Rule>
double bound_of_sum(signs how, std::int64_t n) {
    using number = tracked<T, Rule>;
    const number term(static_cast<T>(0.1));
    number sum(T(0));
    for_each_term(how, n, [&](bool positive) { sum = positive ? sum + term : sum - term; });
    return static_cast<double>(sum.error());
}

/// The error of the plain sum, and Higham's running bound, u Σ|partial sums|, in double.
template <class T>
std::pair<double, double> error_and_running_bound(signs how, std::int64_t n) {
    const T term = static_cast<T>(0.1);
    T sum(0);
    std::int64_t count = 0;
    double sizes = 0;
    for_each_term(how, n, [&](bool positive) {
        sum = positive ? T(sum + term) : T(sum - term);
        count += positive ? 1 : -1;
        sizes += std::abs(static_cast<double>(sum));
    });
    const long double exact =
        static_cast<long double>(static_cast<double>(term)) * static_cast<long double>(count);
    return {std::abs(static_cast<double>(static_cast<double>(sum) - exact)),
            static_cast<double>(number_traits<T>::unit_roundoff()) * sizes};
}

template <class T>
void expect_bounds_of_sums(const char* format, std::int64_t n) {
    using namespace errbound;
    for (const signs how : {signs::all_positive, signs::alternating, signs::random}) {
        const auto [error, running] = error_and_running_bound<T>(how, n);
        const double by_tight = bound_of_sum<T, tight>(how, n),
                     by_sharp = bound_of_sum<T, sharp>(how, n),
                     by_residual = bound_of_sum<T, residual>(how, n);
        std::printf("%-9s %9lld %-12s %9.2e %9.2e %9.2e %9.2e %9.2e\n", format,
                    static_cast<long long>(n),
                    how == signs::all_positive  ? "+0.1"
                    : how == signs::alternating ? "alternating"
                                                : "random signs",
                    error, running, by_tight, by_sharp, by_residual);
        // `tight` counts 2u, for any direction of rounding.
        EXPECT_LE(by_tight, 1.5 * 2 * running);
        EXPECT_LE(by_sharp, 1.5 * running);
        EXPECT_LE(by_residual, 1.01 * error + 0.1 * running);
        for (const double bound : {by_tight, by_sharp, by_residual})
            EXPECT_LE(error, bound * (1 + 1e-9));
    }
}

TEST(LongSums, GrowNoFasterThanTheRunningErrorBound) {
    std::printf("%-9s %9s %-12s %9s %9s %9s %9s %9s\n", "format", "terms", "", "error", "running",
                "tight", "sharp", "residual");
    expect_bounds_of_sums<errbound::bfloat16>("bfloat16", 1000);
    expect_bounds_of_sums<errbound::float16>("float16", 1000);
    expect_bounds_of_sums<float>("float", support::scaled(100'000));
    expect_bounds_of_sums<double>("double", support::scaled(100'000));
}

TEST(LongSums, OfFloatsThatLoseAllDigits) {
    // 0.1 is less than half a last place of 2^21: the sum stays there, and each term is lost.
    using number = tracked<float>;
    number sum(0x1p21F);
    for (int i = 0; i < 200'000; ++i) sum += number(0.1F);
    EXPECT_EQ(sum.value(), 0x1p21F);
    EXPECT_GE(sum.error(), 20'000);
    EXPECT_LE(sum.error(), 51'000);  // 200,000 times 2^-23·2^21
}

}  // namespace
