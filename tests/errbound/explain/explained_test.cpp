// Explained numbers have the bits of the rule that they wrap, and contributions that add up to the
// error, in exact rationals. Errors that are known by hand have the right sources.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <errbound/errbound.hpp>
#include <errbound/explain/explain.hpp>
#include <errbound/functions/function_error.hpp>
#include <errbound/rules/affine.hpp>
#include <errbound/rules/derived.hpp>
#include <errbound/rules/relative.hpp>
#include <errbound/rules/stochastic.hpp>
#include <errbound/small_floats.hpp>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include "tests/support/long_double.hpp"
#include "tests/support/scaled.hpp"
#include "tests/support/special_values.hpp"

// Errors of elementary functions where the library does not know them. Any errors suffice, since
// bounds are only compared with each other.
#ifdef _WIN32
template <errbound::elementary_function F>
inline constexpr double errbound::function_error<F, double> = 3;
template <errbound::elementary_function F>
inline constexpr double errbound::function_error<F, float> = 3;
#endif
#ifndef __GLIBC__
template <errbound::elementary_function F>
inline constexpr double errbound::function_error<F, long double> = 3;
#endif

namespace {

using errbound::explain;
using errbound::explained;
using errbound::explanation;
using errbound::scope;
using errbound::tracked;

/// The relative excess of a sum of a few rounded amounts over the error.
constexpr double rounded = 20 * std::numeric_limits<double>::epsilon();

/// The elementary functions of one number that are defined at 0.6.
// clang-format off
#define ELEMENTARY_FUNCTIONS(DO) \
    DO(exp) DO(exp2) DO(expm1) DO(log) DO(log2) DO(log10) DO(log1p) DO(sin) DO(cos) DO(tan) \
    DO(asin) DO(acos) DO(atan) DO(sinh) DO(cosh) DO(tanh) DO(asinh) DO(atanh) DO(cbrt)
// clang-format on

const char* const scope_names[] = {"first", "second", "third", "fourth"};

/// Random programs by a rule and by `explained` of it, step by step. `Elementary`: half of the
/// functions are elementary functions, dot products and polynomials, and most inputs are near 1.
template <class T, class Rule, std::size_t Limit, bool Elementary = false>
class lockstep {
    using traits = errbound::number_traits<T>;
    using amount = errbound::detail::amount_of<T>;
    struct sample {
        tracked<T, Rule> by_rule;
        tracked<T, explained<Rule, Limit>> by_explained;
        std::optional<rational> exact;  // empty if it is not computed
    };

  public:
    explicit lockstep(std::uint64_t seed) : random_(seed) {}

    void run(int programs) {
        for (int k = 0; k < programs && !testing::Test::HasFatalFailure(); ++k) {
            pool_.clear();
            for (int i = 0; i < 4; ++i) pool_.push_back(input());
            for (int step = 0; step < 9; ++step) {
                const scope outer(scope_names[random_() % 4]);
                const scope inner(scope_names[random_() % 4]);
                pool_.push_back(random_() % 3 == 0 ? function() : operation());
                check(pool_.back(), "program " + std::to_string(k));
                if (testing::Test::HasFatalFailure()) return;
            }
        }
    }

  private:
    sample input() {
        T v = special_value<T>(random_), e = traits::abs(special_value<T>(random_));
        if (Elementary && random_() % 4 != 0)
            v = static_cast<T>(static_cast<double>(random_() >> 10) * 0x1p-52) - T(2);
        std::optional<rational> exact;
        if (traits::is_finite(v)) exact = exactly(v);
        if (random_() % 2) return {v, v, exact};
        if (random_() % 2) e = traits::scale(traits::abs(v), -static_cast<int>(random_() % 30));
        if (exact && traits::is_finite(e))
            *exact += exactly(e) * (static_cast<int>(random_() % 9) - 4) / 4;
        else
            exact.reset();
        const scope s(scope_names[random_() % 4]);
        return {decltype(sample::by_rule)::within(v, e),
                decltype(sample::by_explained)::within(v, e), exact};
    }
    const sample& any() { return pool_[random_() % pool_.size()]; }

    sample operation() {
        const sample a = any(), b = any();
        const auto apply = [&](const auto& f, bool has_exact) {
            sample result{f(a.by_rule, b.by_rule), f(a.by_explained, b.by_explained), {}};
            if (has_exact) result.exact = f(*a.exact, *b.exact);
            return result;
        };
        const bool both = a.exact && b.exact;
        switch (random_() % 6) {
            case 0:
                return apply([](const auto& x, const auto& y) { return x + y; }, both);
            case 1:
                return apply([](const auto& x, const auto& y) { return x - y; }, both);
            case 2:
                return apply([](const auto& x, const auto& y) { return x * y; }, both);
            case 3:
                return {-a.by_rule, -a.by_explained, a.exact ? std::optional(-*a.exact) : a.exact};
            case 4: {
                const int e = static_cast<int>(random_() % 60) - 30;
                sample result{scale(a.by_rule, e), scale(a.by_explained, e), a.exact};
                if (a.exact) *result.exact *= power_of(2, e);
                return result;
            }
        }
        if constexpr (errbound::detail::rule_divides<Rule, T>)
            return apply([](const auto& x, const auto& y) { return x / y; }, both && *b.exact != 0);
        return a;
    }
    /// One of the functions, of three numbers.
    template <class... Functions>
    sample one_of(const Functions&... functions) {
        const sample a = any(), b = any(), c = any();
        sample result = a;
        std::size_t left = random_() % sizeof...(Functions);
        const auto call = [&](const auto& f) {
            if (left-- == 0)
                result = {f(a.by_rule, b.by_rule, c.by_rule),
                          f(a.by_explained, b.by_explained, c.by_explained), std::nullopt};
        };
        (call(functions), ...);
        return result;
    }
    sample function() {
        if constexpr (Elementary)
            if (random_() % 2 == 0) return elementary();
        const int n = static_cast<int>(random_() % 7) - 2;
        const auto any_format = [&](const auto&... more) {
            return one_of([](auto x, auto, auto) { return sqrt(x); },
                          [](auto x, auto, auto) { return abs(x); },
                          [](auto x, auto y, auto) { return min(x, y); },
                          [](auto x, auto y, auto) { return max(x, y); },
                          [](auto x, auto y, auto) { return midpoint(x, y); },
                          [](auto x, auto y, auto) { return copysign(x, y); },
                          [n](auto x, auto, auto) { return pow(x, n); }, more...);
        };
        const auto length = [](auto x, auto y, auto) {
            if constexpr (traits::digits >= 8)
                return hypot(x, y);
            else
                return x;
        };
        if constexpr (support::fuses<T>)
            return any_format([](auto x, auto y, auto z) { return fma(x, y, z); },
                              [](auto x, auto y, auto z) { return lerp(x, y, z); }, length);
        else
            return any_format(length);
    }
    sample elementary() {
#define UNARY(function) [](auto x, auto, auto) { return function(x); },
        return one_of(
            ELEMENTARY_FUNCTIONS(UNARY) UNARY(acosh)[](auto x, auto y, auto) { return pow(x, y); },
            [](auto x, auto, auto) { return pow(x, T(0.3)); },
            [](auto x, auto, auto) { return pow(T(0.3), x); },
            [](auto x, auto y, auto) { return atan2(x, y); },
            [](auto x, auto y, auto) {
                return dot(std::array{x, y, x, y}, std::array{y, y, -y, x});
            },
            [](auto x, auto y, auto) { return dot(std::array{x}, std::array{y}); },
            [](auto x, auto y, auto) {
                return horner(std::array{y, x, y, -x}, x);
            },
            [](auto x, auto y, auto) { return horner(std::array{y}, x); });
#undef UNARY
    }

    void check(const sample& s, const std::string& what) {
        const std::string where = what + ", rule " + Rule::name;
        const T error = s.by_explained.error();
        ASSERT_TRUE(same_bits(s.by_explained.value(), s.by_rule.value())) << where;
        ASSERT_TRUE(same_bits(error, s.by_rule.error())) << where;
        ASSERT_EQ(sign_of(s.by_explained), sign_of(s.by_rule)) << where;
        const auto& entries = s.by_explained.bound().contributions.entries();
        ASSERT_LE(entries.size(), Limit) << where;
        if (traits::is_finite(error)) return check_sums(s, where);
        ASSERT_FALSE(entries.empty()) << where;
        // Bounds in a wider type may overflow only when they are rounded to T.
        const bool finite =
            errbound::detail::bounds_are_wider<T, Rule> && entries.front().is_finite();
        rational amounts = 0;
        for (const auto& e : entries) {
            ASSERT_EQ(e.is_finite(), finite) << where;
            if (finite) amounts += exactly(e.size());
        }
        if (!finite) return;
        const rational factor = 1 + 2 * exactly(traits::epsilon());
        ASSERT_GE(rational(amounts * factor), exactly(traits::largest())) << where;
    }
    void check_sums(const sample& s, const std::string& where) {
        rational sizes = 0, amounts = 0, known = 0, unknown = 0;
        const auto& entries = s.by_explained.bound().contributions.entries();
        for (const auto& e : entries) {
            ASSERT_TRUE(e.is_finite() && e.unknown >= 0) << where;
            sizes += boost::multiprecision::abs(exactly(e.known)) + exactly(e.unknown);
            amounts += exactly(e.size());
            known += exactly(e.known);
            unknown += exactly(e.unknown);
        }
        // The rounding errors of the sums of the entries, and of scaling the entries.
        using limits = std::numeric_limits<amount>;
        const int count = static_cast<int>(entries.size()) + 2;
        const rational slack = sizes * 4 * count * exactly(limits::epsilon()) +
                               4 * count * exactly(limits::denorm_min());
        const rational error = exactly(s.by_explained.error());
        // Rounding never makes the amounts too small, unless a sum is about to overflow.
        if (error < exactly(limits::max()) / 2) {
            // error() is rounded upwards to T if the bound is kept in a wider type.
            rational lost = 0;
            if constexpr (errbound::detail::bounds_are_wider<T, Rule>)
                lost = 2 * (error * exactly(traits::epsilon()) + exactly(traits::underflow_unit()));
            ASSERT_GE(rational(amounts + lost), error) << where;
        }
        if (!errbound::detail::rule_has_correction<Rule, T>) {
            ASSERT_LE(sizes, rational(error + slack)) << where;
        }
        if (!s.exact || !errbound::promises_bound<Rule>) return;
        const rational off = *s.exact - exactly(s.by_explained.value());
        ASSERT_LE(boost::multiprecision::abs(off), error) << where;
        // The known parts sum up to the value's error; the unknown ones bound the rest.
        ASSERT_LE(boost::multiprecision::abs(rational(off - known)), rational(unknown + slack))
            << where;
    }

    std::mt19937_64 random_;
    std::vector<sample> pool_;
};

struct custom : errbound::derived_rule<custom, errbound::residual> {
    static constexpr const char* name = "custom";
};

template <class Rule>
class ExplainedBy : public testing::Test {};
using rules = testing::Types<errbound::tight, errbound::safe, errbound::sharp, errbound::interval,
                             errbound::residual, errbound::affine, errbound::affine_of<2>,
                             errbound::relative, errbound::stochastic, custom, errbound::none>;
TYPED_TEST_SUITE(ExplainedBy, rules);

TYPED_TEST(ExplainedBy, AgreesWithTheRuleInRandomPrograms) {
    const int programs = support::scaled(4000);
    lockstep<double, TypeParam, 64>(1).run(programs);
    lockstep<float, TypeParam, 3>(2).run(programs);
}

TEST(Explained, AgreesWithTheRuleInOtherNumberTypesAndFunctionsInRandomPrograms) {
    const int programs = support::scaled(4000);
    lockstep<double, errbound::residual, 1>(3).run(programs);
    lockstep<errbound::float16, errbound::residual, 64>(4).run(programs);
    lockstep<errbound::float8_e4m3, errbound::tight, 64>(5).run(programs);
    lockstep<support::long_double, errbound::residual, 64>(6).run(programs / 4);
    lockstep<double, errbound::tight, 64, true>(7).run(programs);
    lockstep<float, errbound::residual, 64, true>(8).run(programs);
    lockstep<double, errbound::affine, 64, true>(9).run(programs / 4);
}

TEST(Explained, HasTheMeaningOfTheRulesError) {
    using errbound::stochastic;
    static_assert(errbound::promises_bound<explained<errbound::tight>>);
    static_assert(!errbound::promises_bound<explained<errbound::none>>);
    static_assert(explained<stochastic>::error_is == errbound::error_meaning::estimate);
    const tracked<double, explained<stochastic>> x = 0.1, y = (x * x + x) / x;
    EXPECT_GT(y.error(), 0);
    double sum = 0;
    for (const auto& c : explain(y).contributions) sum += c.amount;
    EXPECT_GE(sum, y.error());
    EXPECT_LE(sum, y.error() * (1 + rounded));
}

/// The sum of the amounts of the sources in scopes of that name.
double amount_in(const explanation& e, const std::string& name, const std::string& operation = "") {
    double sum = 0;
    for (const auto& c : e.contributions)
        if (!c.scopes.empty() && c.scopes.back().name == name &&
            (operation.empty() || c.operation == operation))
            sum += c.amount;
    return sum;
}

/// Recomputes the contributions by the formula in the head of explained.hpp: the operands' errors
/// times derivatives. Each step of a program has its own scope.
template <class Rule>
class first_order {
    using number = tracked<double, explained<Rule>>;
    using plain = tracked<double, Rule>;
    static constexpr int inputs = 3, steps = 8;
    struct sample {
        number x;
        std::vector<long double> parts;  // by step
    };

  public:
    void run(int programs) {
        for (int k = 0; k < programs && !testing::Test::HasFatalFailure(); ++k) {
            pool_.clear();
            for (int i = 0; i < inputs; ++i) pool_.push_back({number(draw()), {}});
            for (auto& s : pool_) s.parts.resize(steps);
            for (int i = 0; i < steps; ++i) {
                const std::string name = "step " + std::to_string(i);
                const scope here(name);
                const sample s = next(static_cast<std::size_t>(i));
                if (!(s.x.error() < 1e-9 * std::abs(s.x.value()))) continue;
                check(s);
                pool_.push_back(s);
            }
        }
    }
    /// The number of contributions that are more than a hundredth of the error.
    int checked() const { return checked_; }

  private:
    double draw() { return std::ldexp(static_cast<double>(random_() >> 11) - 0x1p52, -50); }

    sample next(std::size_t step) {
        const sample a = pool_[random_() % pool_.size()], b = pool_[random_() % pool_.size()];
        const plain x = a.x.value(), y = b.x.value();
        const auto by = [&](const number& result, const plain& own, long double of_a,
                            long double of_b) {
            sample s{result, std::vector<long double>(steps)};
            for (std::size_t i = 0; i < steps; ++i)
                s.parts[i] = std::abs(of_a) * a.parts[i] + std::abs(of_b) * b.parts[i];
            s.parts[step] += own.error();
            return s;
        };
        switch (random_() % 5) {
            case 0:
                return by(a.x + b.x, x + y, 1, 1);
            case 1:
                return by(a.x - b.x, x - y, 1, 1);
            case 2:
                return by(a.x * b.x, x * y, y.value(), x.value());
            case 3:
                return by(a.x / b.x, x / y, 1.0L / y.value(),
                          static_cast<long double>(x.value()) / y.value() / y.value());
            default: {
                // The root of an exact square is exact; the root of an inexact one is not.
                const plain root = sqrt(abs(x));
                if (root.error() == 0) return a;
                return by(sqrt(abs(a.x)), root, 0.5L / root.value(), 0);
            }
        }
    }
    void check(const sample& s) {
        const explanation e = explain(s.x);
        for (std::size_t i = 0; i < steps; ++i) {
            const double found = amount_in(e, "step " + std::to_string(i));
            ASSERT_LE(std::abs(static_cast<long double>(found) - s.parts[i]), 1e-5L * s.x.error())
                << Rule::name << ", step " << i << " of " << s.x.value();
            checked_ += s.parts[i] > 0.01L * s.x.error();
        }
    }

    std::mt19937_64 random_{5};
    std::vector<sample> pool_;
    int checked_ = 0;
};

template <class Rule>
void expect_first_order(int programs) {
    first_order<Rule> random;
    random.run(programs);
    EXPECT_GT(random.checked(), programs);
}
TEST(Contributions, AreErrorsTimesDerivativesInRandomPrograms) {
    expect_first_order<errbound::tight>(support::scaled(3000));
    expect_first_order<errbound::sharp>(support::scaled(3000));
}

using number = tracked<double, explained<>>;
using signed_number = tracked<double, explained<errbound::residual>>;

number input(const char* name, double v, double e) {
    const scope s(name);
    return number::within(v, e);
}

TEST(Contributions, HaveScopeOperationAndAmount) {
    const number a = input("a", 3, 1e-6), b = input("b", -5, 1e-7);
    const scope s("product");
    const explanation e = explain(a * b, "ab");
    EXPECT_EQ(e.name, "ab");
    EXPECT_EQ(e.rule, "tight");
    EXPECT_EQ(e.value, -15);
    ASSERT_EQ(e.contributions.size(), 3U);
    EXPECT_NEAR(amount_in(e, "a", "input"), 5e-6, 1e-12);
    EXPECT_NEAR(amount_in(e, "b", "input"), 3e-7, 1e-13);
    EXPECT_NEAR(amount_in(e, "product", "*"), 15 * 0x1p-52, 1e-20);
    EXPECT_EQ(e.contributions[0].scopes.front().name, "a");
    EXPECT_NE(e.contributions[0].scopes.front().file.find("explained_test.cpp"), std::string::npos);
    EXPECT_GT(e.contributions[0].scopes.front().line, 0U);
}

TEST(Contributions, CancelInADifferenceOnlyIfTheRuleSubtractsErrors) {
    // `tight` adds both errors of x - x.
    const number x = number(0.1) * number(0.3), difference = x - x;
    const explanation by_tight = explain(difference);
    ASSERT_EQ(by_tight.contributions.size(), 1U);
    EXPECT_EQ(by_tight.contributions[0].operation, "*");
    EXPECT_DOUBLE_EQ(by_tight.contributions[0].amount, difference.error());
    const signed_number y = signed_number(0.1) * signed_number(0.3);
    EXPECT_EQ(explain(y).contributions.size(), 1U);
    EXPECT_NE(explain(y).contributions[0].known, 0);
    EXPECT_EQ((y - y).error(), 0);
    EXPECT_TRUE(explain(y - y).contributions.empty());
}

TEST(Contributions, WithSignsCancelInACompensatedSum) {
    const signed_number a = 0.1, b = 1e8;
    signed_number s, rest;
    {
        const scope first("sum");
        s = a + b;
    }
    {
        const scope correction("rounding error of the sum");
        const signed_number b_in_sum = s - a;
        rest = (a - (s - b_in_sum)) + (b - b_in_sum);
    }
    EXPECT_NE(rest.value(), 0);
    EXPECT_EQ(amount_in(explain(s), "sum"), s.error());
    const scope last("together");
    const signed_number corrected = s + rest;
    const explanation e = explain(corrected);
    EXPECT_EQ(amount_in(e, "sum"), 0);
    EXPECT_GE(amount_in(e, "together", "+"), corrected.error());
    EXPECT_LE(amount_in(e, "together", "+"), corrected.error() * (1 + rounded));
}

TEST(Contributions, PassThroughFunctions) {
    const number a = input("a", 3, 1e-6), b = input("b", 4, 1e-6);
    const auto expect = [](const number& x, double of_a, double of_b) {
        const explanation e = explain(x);
        EXPECT_NEAR(amount_in(e, "a"), of_a * 1e-6, of_a * 1e-9) << x.value();
        EXPECT_NEAR(amount_in(e, "b"), of_b * 1e-6, of_b * 1e-9) << x.value();
    };
    expect(sqrt(b), 0, 0.25);
    expect(abs(-a), 1, 0);
    expect(min(a, b), 1, 0);
    expect(max(a, b), 0, 1);
    expect(fma(a, b, a), 5, 3);
    expect(copysign(a, -b), 1, 0);
    expect(pow(a, 2), 6, 0);
    expect(pow(a, 2.0), 6, 0);
    expect(pow(a, b), 108, 81 * std::log(3));
    expect(atan2(a, b), 0.16, 0.12);
    expect(midpoint(a, b), 0.5, 0.5);
    expect(hypot(a, b), 1, 1);                     // the sum of the arguments' errors
    expect(lerp(a, b, number(0.25)), 0.75, 0.25);  // computed as (1 - t)a + tb
    const auto third = [](const auto& x, const auto&, const auto& z) { return x * z / 3; };
    const number named = errbound::as_one_operation("third", third, a, b, b);
    expect(named, 4.0 / 3, 1);
    bool found = false;
    for (const auto& c : explain(named).contributions) found = found || c.operation == "third";
    EXPECT_TRUE(found);
}

template <class Function>
void expect_derivative(const char* name, const Function& f, double v) {
    const number x = input("x", v, 1e-9);
    const scope after("after");
    const explanation e = explain(f(x));
    const double h = 0x1p-12, slope = std::abs(f(v + h) - f(v - h)) / (2 * h);
    EXPECT_NEAR(amount_in(e, "x", "input"), slope * 1e-9, slope * 1e-15) << name;
    EXPECT_GT(amount_in(e, "after", name), 0) << name;
}
TEST(Contributions, PassThroughElementaryFunctions) {
    const auto hyperbolic = [](const auto& x) {
        using std::acosh;
        return acosh(x);
    };
    expect_derivative("acosh", hyperbolic, 1.6);
#define CHECK(function)          \
    expect_derivative(           \
        #function,               \
        [](const auto& x) {      \
            using std::function; \
            return function(x);  \
        },                       \
        0.6);
    ELEMENTARY_FUNCTIONS(CHECK)
#undef CHECK
}

TEST(Contributions, PassThroughConversions) {
    const number a = number::within(1.0 / 3, 1e-6);
    const auto narrow = errbound::convert<float>(a);
    const auto plain = errbound::convert<float>(tracked<double>::within(1.0 / 3, 1e-6));
    static_assert(std::is_same_v<decltype(narrow), const tracked<float, explained<>>>);
    EXPECT_EQ(narrow.value(), plain.value());
    EXPECT_EQ(narrow.error(), plain.error());
    const explanation e = explain(narrow);
    ASSERT_EQ(e.contributions.size(), 2U);
    EXPECT_EQ(e.contributions[0].operation, "input");
    EXPECT_NEAR(e.contributions[0].amount, 1e-6, 1e-9);
    EXPECT_EQ(e.contributions[1].operation, "convert");
    const auto other = errbound::convert<float, explained<errbound::sharp, 8>>(a);
    static_assert(
        std::is_same_v<decltype(other), const tracked<float, explained<errbound::sharp, 8>>>);
    EXPECT_EQ(explain(other).contributions.size(), 2U);
}

TEST(Contributions, NameTheOperationThatMadeTheErrorInfinite) {
    const number zero = number::within(0, 1e-9);
    number quotient;
    {
        const scope s("quotient");
        quotient = number(1) / zero;
    }
    const scope s("later");
    const number later = quotient * number(3) + number(0.1) * number(0.1);
    const explanation e = explain(later);
    ASSERT_EQ(e.contributions.size(), 1U);
    EXPECT_EQ(e.contributions[0].scopes.front().name, "quotient");
    EXPECT_EQ(e.contributions[0].operation, "/");
    EXPECT_TRUE(std::isinf(e.contributions[0].amount));
    EXPECT_EQ(explain(later - sqrt(number(-1))).contributions.size(), 2U);
    const explanation of_nan = explain(number(std::numeric_limits<double>::quiet_NaN()));
    ASSERT_EQ(of_nan.contributions.size(), 1U);
    EXPECT_EQ(of_nan.contributions[0].operation, "input");
    EXPECT_TRUE(std::isinf(of_nan.error));
    EXPECT_TRUE(std::isinf(explain(sqrt(number(-1))).error));
    // The product with an exact zero is exact.
    const number unsure = number::within(1, std::numeric_limits<double>::infinity());
    EXPECT_EQ((unsure * number(0)).error(), 0);
    EXPECT_TRUE(explain(unsure * number(0)).contributions.empty());
}

TEST(Contributions, ThatExceedTheLimitAreMerged) {
    using few = tracked<double, explained<errbound::tight, 4>>;
    few sum = 0;
    for (int i = 0; i < 50; ++i) {
        const scope s(std::to_string(i));
        sum += few::within(1, i == 30 ? 2e-3 : i == 7 ? 1e-3 : 1e-9);
    }
    const explanation e = explain(sum);
    ASSERT_EQ(e.contributions.size(), 4U);
    EXPECT_EQ(e.contributions[0].scopes.front().name, "30");
    EXPECT_EQ(e.contributions[1].scopes.front().name, "7");
    double all = 0, rest = 0;
    for (const auto& c : e.contributions) {
        all += c.amount;
        if (c.operation == "the rest") rest += c.amount;
    }
    EXPECT_GE(all, sum.error());
    EXPECT_LE(all, sum.error() * (1 + rounded));
    EXPECT_NEAR(rest, 4.7e-8, 0.3e-8);
}

/// The names of the scopes of a product that is computed here.
std::vector<std::string> names_here() {
    const number x = number(0.1) * number(0.1);
    const explanation e = explain(x);
    std::vector<std::string> names;
    for (const auto& s : e.contributions.at(0).scopes) names.push_back(s.name);
    return names;
}
std::vector<std::string> names_in_recursion(int depth) {
    const scope s("recursion");
    if (depth == 0) return names_here();
    const scope between("between");
    return names_in_recursion(depth - 1);
}

TEST(Scopes, Nest) {
    using names = std::vector<std::string>;
    EXPECT_EQ(names_here(), names());
    const scope outer("outer");
    {
        const scope inner("inner");
        EXPECT_EQ(names_here(), names({"outer", "inner"}));
    }
    EXPECT_EQ(names_here(), names({"outer"}));
    EXPECT_EQ(names_in_recursion(0), names({"outer", "recursion"}));
    EXPECT_EQ(names_in_recursion(10), names({"outer", "recursion"}));
    try {
        const scope left("left by an exception");
        throw 1;
    } catch (int) {
    }
    EXPECT_EQ(names_here(), names({"outer"}));
}

TEST(Scopes, BelongToOneThread) {
    const scope here("this thread");
    constexpr std::size_t count = 4;
    std::vector<number> results(count);
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < count; ++i)
        threads.emplace_back([&results, i] {
            const scope s("thread " + std::to_string(i));
            for (int k = 0; k < 200; ++k) {
                const scope step("step " + std::to_string(k % 20));
                results[i] += number(0.1) * number(0.1);
            }
        });
    for (std::thread& t : threads) t.join();
    for (std::size_t i = 0; i < count; ++i) {
        const explanation e = explain(results[i]);
        EXPECT_EQ(e.contributions.size(), 40U);
        for (const auto& c : e.contributions) {
            ASSERT_EQ(c.scopes.size(), 2U);
            EXPECT_EQ(c.scopes.front().name, "thread " + std::to_string(i));
        }
    }
    // An operation on numbers of other threads counts for the thread that computes it.
    const explanation sum = explain(results[0] + results[1]);
    EXPECT_EQ(sum.contributions.size(), 64U);
    EXPECT_GT(amount_in(sum, "this thread", "+"), 0);
}

// This is the last test: new scopes after it are not distinguished.
TEST(Scopes, ThatExceedTheLimitCountForTheirParent) {
    using names = std::vector<std::string>;
    const scope outer("many");
    for (int i = 0; i < 100'100; ++i) {
        const scope s("number " + std::to_string(i));
        if (i == 0) {
            EXPECT_EQ(names_here(), names({"many", "number 0"}));
        }
        if (i == 100'099) {
            EXPECT_EQ(names_here(), names({"many"}));
        }
    }
    EXPECT_EQ(names_here(), names({"many"}));
}

}  // namespace
