// Explained numbers beside those of the rule that they wrap: the same bits, and contributions that
// add up to the error, in exact rationals; what is booked where, for errors that are known by hand.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <errbound/errbound.hpp>
#include <errbound/explain/explain.hpp>
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

#include "tests/support/assumed_errors.hpp"
#include "tests/support/long_double.hpp"
#include "tests/support/scaled.hpp"
#include "tests/support/special_values.hpp"

namespace {

using errbound::explain;
using errbound::explained;
using errbound::explanation;
using errbound::scope;
using errbound::tracked;

/// Equal, NaN with NaN, and zeros by their signs.
template <class T>
bool same_bits(const T& x, const T& y) {
    if (x != x || y != y) return x != x && y != y;
    return x == y && (x != T(0) ||
                      std::signbit(static_cast<double>(x)) == std::signbit(static_cast<double>(y)));
}

/// How much more than the error the amounts of a few sources come to, relatively.
constexpr double rounded = 20 * std::numeric_limits<double>::epsilon();

const char* const scope_names[] = {"first", "second", "third", "fourth"};

/// On Windows fused products of long doubles do not compile.
#ifdef __MINGW32__
template <class T>
constexpr bool fuses = sizeof(T) <= sizeof(double);
#else
template <class T>
constexpr bool fuses = true;
#endif

/// Random programs by a rule and by `explained` of it, step by step. `Elementary`: half of the
/// functions are elementary functions, dot products and polynomials, and most inputs are near 1.
template <class T, class Rule, std::size_t Limit, bool Elementary = false>
class lockstep {
    using plain = tracked<T, Rule>;
    using told = tracked<T, explained<Rule, Limit>>;
    using traits = errbound::number_traits<T>;
    using amount = errbound::detail::amount_of<T>;
    struct sample {
        plain by_rule;
        told by_explained;
        std::optional<rational> exact;  // of what has one
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
        if (random_() % 2) return {plain(v), told(v), exact_of(v)};
        if (random_() % 2) e = traits::scale(traits::abs(v), -static_cast<int>(random_() % 30));
        std::optional<rational> exact = exact_of(v);
        if (exact && exact_of(e))
            *exact += *exact_of(e) * (static_cast<int>(random_() % 9) - 4) / 4;
        else
            exact.reset();
        const scope s(scope_names[random_() % 4]);
        return {plain::within(v, e), told::within(v, e), exact};
    }
    static std::optional<rational> exact_of(const T& v) {
        if (!traits::is_finite(v)) return std::nullopt;
        return exactly(v);
    }
    const sample& any() { return pool_[random_() % pool_.size()]; }

    sample operation() {
        const sample a = any(), b = any();
        const bool exact = a.exact && b.exact;
        using result = std::optional<rational>;
        switch (random_() % 6) {
            case 0:
                return {a.by_rule + b.by_rule, a.by_explained + b.by_explained,
                        exact ? result(*a.exact + *b.exact) : result()};
            case 1:
                return {a.by_rule - b.by_rule, a.by_explained - b.by_explained,
                        exact ? result(*a.exact - *b.exact) : result()};
            case 2:
                return {a.by_rule * b.by_rule, a.by_explained * b.by_explained,
                        exact ? result(*a.exact * *b.exact) : result()};
            case 3:
                return {-a.by_rule, -a.by_explained, a.exact ? result(-*a.exact) : result()};
            case 4: {
                const int e = static_cast<int>(random_() % 60) - 30;
                return {scale(a.by_rule, e), scale(a.by_explained, e),
                        a.exact ? result(*a.exact * exactly(std::ldexp(1.0, e))) : result()};
            }
        }
        if constexpr (errbound::detail::rule_divides<Rule, T>)
            return {a.by_rule / b.by_rule, a.by_explained / b.by_explained,
                    exact && *b.exact != 0 ? result(*a.exact / *b.exact) : result()};
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
            if (random_() % 2 == 0) return elementary_function();
        const int n = static_cast<int>(random_() % 7) - 2;
        return one_of([](auto x, auto, auto) { return sqrt(x); },
                      [](auto x, auto, auto) { return abs(x); },
                      [](auto x, auto y, auto) { return min(x, y); },
                      [](auto x, auto y, auto) { return max(x, y); },
                      [](auto x, auto y, auto) { return midpoint(x, y); },
                      [](auto x, auto y, auto) { return copysign(x, y); },
                      [n](auto x, auto, auto) { return pow(x, n); },
                      [](auto x, auto y, auto z) {
                          if constexpr (fuses<T>)
                              return fma(x, y, z);
                          else
                              return x;
                      },
                      [](auto x, auto y, auto z) {
                          if constexpr (fuses<T>)
                              return lerp(x, y, z);
                          else
                              return x;
                      },
                      [](auto x, auto y, auto) {
                          if constexpr (traits::digits >= 8)
                              return hypot(x, y);
                          else
                              return x;
                      });
    }
    sample elementary_function() {
        return one_of(
            [](auto x, auto, auto) { return exp(x); }, [](auto x, auto, auto) { return exp2(x); },
            [](auto x, auto, auto) { return expm1(x); }, [](auto x, auto, auto) { return log(x); },
            [](auto x, auto, auto) { return log2(x); }, [](auto x, auto, auto) { return log10(x); },
            [](auto x, auto, auto) { return log1p(x); }, [](auto x, auto, auto) { return cbrt(x); },
            [](auto x, auto y, auto) { return pow(x, y); },
            [](auto x, auto, auto) { return pow(x, T(0.3)); },
            [](auto x, auto, auto) { return pow(T(0.3), x); },
            [](auto x, auto, auto) { return sin(x); }, [](auto x, auto, auto) { return cos(x); },
            [](auto x, auto, auto) { return tan(x); }, [](auto x, auto, auto) { return asin(x); },
            [](auto x, auto, auto) { return acos(x); }, [](auto x, auto, auto) { return atan(x); },
            [](auto x, auto y, auto) { return atan2(x, y); },
            [](auto x, auto, auto) { return sinh(x); }, [](auto x, auto, auto) { return cosh(x); },
            [](auto x, auto, auto) { return tanh(x); }, [](auto x, auto, auto) { return asinh(x); },
            [](auto x, auto, auto) { return acosh(x); },
            [](auto x, auto, auto) { return atanh(x); },
            [](auto x, auto y, auto) {
                return dot(std::array{x, y, x, y}, std::array{y, y, -y, x});
            },
            [](auto x, auto y, auto) { return dot(std::array{x}, std::array{y}); },
            [](auto x, auto y, auto) {
                return horner(std::array{y, x, y, -x}, x);
            },
            [](auto x, auto y, auto) { return horner(std::array{y}, x); });
    }

    void check(const sample& s, const std::string& what) {
        const std::string where = what + ", rule " + Rule::name;
        const T value = s.by_explained.value(), error = s.by_explained.error();
        ASSERT_TRUE(same_bits(value, s.by_rule.value())) << where;
        ASSERT_TRUE(same_bits(error, s.by_rule.error())) << where;
        ASSERT_EQ(sign_of(s.by_explained), sign_of(s.by_rule)) << where;
        const auto& entries = s.by_explained.bound().contributions.entries();
        ASSERT_LE(entries.size(), Limit) << where;
        if (!traits::is_finite(error)) {
            ASSERT_FALSE(entries.empty()) << where;
            if (errbound::detail::bounds_are_wider<T, Rule> && entries.front().is_finite()) {
                // Only the error rounded to T overflows.
                rational amounts = 0;
                for (const auto& e : entries) {
                    ASSERT_TRUE(e.is_finite()) << where;
                    amounts += exactly(e.size());
                }
                const rational factor = 1 + 2 * exactly(traits::epsilon());
                ASSERT_GE(rational(amounts * factor), exactly(traits::largest())) << where;
            } else {
                for (const auto& e : entries) ASSERT_FALSE(e.is_finite()) << where;
            }
            return;
        }
        check_sums(s, where);
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
        // Roundings of a sum of so many terms, and of scaling them.
        using limits = std::numeric_limits<amount>;
        const int count = static_cast<int>(entries.size()) + 2;
        const rational slack = sizes * 4 * count * exactly(limits::epsilon()) +
                               4 * count * exactly(limits::denorm_min());
        const rational error = exactly(s.by_explained.error());
        // Covered, whatever was rounded; where no overflow is near.
        if (error < exactly(limits::max()) / 2) {
            // error() is rounded upwards to T if the bound is kept in a wider type.
            const rational lost =
                errbound::detail::bounds_are_wider<T, Rule>
                    ? rational(error * 2 * exactly(errbound::number_traits<T>::epsilon()) +
                               2 * exactly(errbound::number_traits<T>::underflow_unit()))
                    : rational(0);
            ASSERT_GE(rational(amounts + lost), error) << where;
        }
        if (!errbound::detail::rule_has_correction<Rule, T>) {
            ASSERT_LE(sizes, rational(error + slack)) << where;
        }
        if (!s.exact || !errbound::promises_bound<Rule>) return;
        const rational off = *s.exact - exactly(s.by_explained.value());
        ASSERT_LE(boost::multiprecision::abs(off), error) << where;
        // Known parts are what the value is off by; unknown ones bound the rest.
        ASSERT_LE(boost::multiprecision::abs(rational(off - known)), rational(unknown + slack))
            << where;
    }

    std::mt19937_64 random_;
    std::vector<sample> pool_;
};

struct of_own : errbound::derived_rule<of_own, errbound::residual> {
    static constexpr const char* name = "of one's own";
};

template <class Rule>
class ExplainedBy : public testing::Test {};
using rules = testing::Types<errbound::tight, errbound::safe, errbound::sharp, errbound::interval,
                             errbound::residual, errbound::affine, errbound::affine_of<2>,
                             errbound::relative, errbound::stochastic, of_own, errbound::none>;
TYPED_TEST_SUITE(ExplainedBy, rules);

TYPED_TEST(ExplainedBy, IsTheRuleItselfAndAddsUpInRandomPrograms) {
    const int programs = support::scaled(4000);
    lockstep<double, TypeParam, 64>(1).run(programs);
    lockstep<float, TypeParam, 3>(2).run(programs);
}

TEST(Explained, IsTheRuleItselfInOtherNumberTypesInRandomPrograms) {
    const int programs = support::scaled(4000);
    lockstep<double, errbound::residual, 1>(3).run(programs);
    lockstep<errbound::float16, errbound::residual, 64>(4).run(programs);
    lockstep<errbound::float8_e4m3, errbound::tight, 64>(5).run(programs);
    lockstep<support::long_double, errbound::residual, 64>(6).run(programs / 4);
}

TEST(Explained, IsTheRuleItselfInFunctionsInRandomPrograms) {
    const int programs = support::scaled(4000);
    lockstep<double, errbound::tight, 64, true>(7).run(programs);
    lockstep<float, errbound::residual, 64, true>(8).run(programs);
    lockstep<double, errbound::affine, 64, true>(9).run(programs / 4);
}

TEST(Explained, SaysWhatTheRulesErrorMeans) {
    using errbound::stochastic;
    static_assert(errbound::promises_bound<explained<errbound::tight>>);
    static_assert(!errbound::promises_bound<explained<errbound::none>>);
    static_assert(explained<stochastic>::error_is == errbound::error_meaning::estimate);
    const tracked<double, stochastic> x = 0.1, y = (x * x + x) / x;
    const tracked<double, explained<stochastic>> told = 0.1, of_told = (told * told + told) / told;
    EXPECT_EQ(of_told.error(), y.error());
    EXPECT_GT(y.error(), 0);
    double sum = 0;
    for (const auto& c : explain(of_told).contributions) sum += c.amount;
    EXPECT_GE(sum, y.error());
    EXPECT_LE(sum, y.error() * (1 + rounded));
}

/// The amount of a source in the scope of that name; 0 where there is none.
double amount_in(const explanation& e, const std::string& name, const std::string& operation = "") {
    double sum = 0;
    for (const auto& c : e.contributions)
        if (!c.scopes.empty() && c.scopes.back().name == name &&
            (operation.empty() || c.operation == operation))
            sum += c.amount;
    return sum;
}

// A second computation of what the head of explained.hpp says, for rules whose bounds are sums of
// the operands' errors times derivatives: a scope for each step of a program.
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
                // (The root of an exact square is exact, that of about one is not.)
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

TEST(Contributions, AreOwnErrorsTimesDerivativesInRandomPrograms) {
    const int programs = support::scaled(3000);
    first_order<errbound::tight> by_tight;
    by_tight.run(programs);
    EXPECT_GT(by_tight.checked(), programs);
    first_order<errbound::sharp> by_sharp;
    by_sharp.run(programs);
    EXPECT_GT(by_sharp.checked(), programs);
}

using number = tracked<double, explained<>>;
using signed_number = tracked<double, explained<errbound::residual>>;

TEST(Contributions, OfInputsAndOperationsAreToldApart) {
    const auto input_of = [](const char* name, double v, double e) {
        const scope s(name);
        return number::within(v, e);
    };
    const number a = input_of("a", 3, 1e-6), b = input_of("b", -5, 1e-7);
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

TEST(Contributions, OfANumberLessItselfAreTheRulesOwn) {
    // `tight` does not know that x − x is 0: twice x's error, from where it came.
    const number x = number(0.1) * number(0.3), difference = x - x;
    const explanation by_tight = explain(difference);
    ASSERT_EQ(by_tight.contributions.size(), 1U);
    EXPECT_EQ(by_tight.contributions[0].operation, "*");
    EXPECT_DOUBLE_EQ(by_tight.contributions[0].amount, difference.error());
    // `residual` does.
    const signed_number y = signed_number(0.1) * signed_number(0.3);
    EXPECT_EQ(explain(y).contributions.size(), 1U);
    EXPECT_NE(explain(y).contributions[0].known, 0);
    EXPECT_EQ((y - y).error(), 0);
    EXPECT_TRUE(explain(y - y).contributions.empty());
}

TEST(Contributions, WithSignsCancelWhereErrorsDo) {
    const signed_number a = 0.1, b = 1e8;
    signed_number s, rest;
    {
        const scope first("sum");
        s = a + b;
    }
    {
        const scope correction("what it lost");
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
    const auto input_of = [](const char* name, double v, double e) {
        const scope s(name);
        return number::within(v, e);
    };
    const number a = input_of("a", 3, 1e-6), b = input_of("b", 4, 1e-6);
    const auto near = [](double x, double wanted) { return std::abs(x - wanted) < 1e-3 * wanted; };
    EXPECT_TRUE(near(amount_in(explain(sqrt(b)), "b"), 0.25e-6));
    EXPECT_TRUE(near(amount_in(explain(abs(-a)), "a"), 1e-6));
    EXPECT_TRUE(near(amount_in(explain(min(a, b)), "a"), 1e-6));
    EXPECT_EQ(amount_in(explain(min(a, b)), "b"), 0);
    EXPECT_TRUE(near(amount_in(explain(max(a, b)), "b"), 1e-6));
    EXPECT_TRUE(near(amount_in(explain(fma(a, b, a)), "a"), 5e-6));
    EXPECT_TRUE(near(amount_in(explain(fma(a, b, a)), "b"), 3e-6));
    EXPECT_TRUE(near(amount_in(explain(copysign(a, -b)), "a"), 1e-6));
    EXPECT_TRUE(near(amount_in(explain(pow(a, 2)), "a"), 6e-6));
    EXPECT_TRUE(near(amount_in(explain(pow(a, 2.0)), "a"), 6e-6));
    EXPECT_TRUE(near(amount_in(explain(pow(a, b)), "a"), 108e-6));
    EXPECT_TRUE(near(amount_in(explain(pow(a, b)), "b"), 88.99e-6));
    EXPECT_TRUE(near(amount_in(explain(atan2(a, b)), "a"), 0.16e-6 + 0.12e-6 - 0.12e-6));
    EXPECT_TRUE(near(amount_in(explain(log(b)), "b"), 0.25e-6));
    EXPECT_TRUE(near(amount_in(explain(midpoint(a, b)), "b"), 0.5e-6));
    // (`hypot` adds its arguments' errors, `lerp` counts (1 − t)a + tb.)
    const explanation length = explain(hypot(a, b));
    EXPECT_TRUE(near(amount_in(length, "a"), 1e-6) && near(amount_in(length, "b"), 1e-6));
    EXPECT_TRUE(near(amount_in(explain(lerp(a, b, number(0.25))), "a"), 0.75e-6));
    EXPECT_TRUE(near(amount_in(explain(lerp(a, b, number(0.25))), "b"), 0.25e-6));
    const explanation third = explain(errbound::as_one_operation(
        "third", [](const auto& x, const auto&, const auto& z) { return x * z / 3; }, a, b, b));
    EXPECT_TRUE(near(amount_in(third, "a"), 4e-6 / 3));
    EXPECT_TRUE(near(amount_in(third, "b"), 1e-6));
    bool named = false;
    for (const auto& c : third.contributions) named = named || c.operation == "third";
    EXPECT_TRUE(named);
}

TEST(Contributions, PassThroughElementaryFunctions) {
    const double v = 0.6;
    const scope s("x");
    const number x = number::within(v, 1e-9), y = x + number(1);
    const scope after("after");
    const auto check = [](const char* name, const number& result, double derivative) {
        const explanation e = explain(result);
        EXPECT_NEAR(amount_in(e, "x", "input"), derivative * 1e-9, derivative * 1e-13) << name;
        EXPECT_GT(amount_in(e, "after", name), 0) << name;
    };
    check("exp", exp(x), std::exp(v));
    check("exp2", exp2(x), std::log(2) * std::exp2(v));
    check("expm1", expm1(x), std::exp(v));
    check("log", log(x), 1 / v);
    check("log2", log2(x), 1 / v / std::log(2));
    check("log10", log10(x), 1 / v / std::log(10));
    check("log1p", log1p(x), 1 / (1 + v));
    check("sin", sin(x), std::cos(v));
    check("cos", cos(x), std::sin(v));
    check("tan", tan(x), 1 + std::tan(v) * std::tan(v));
    check("asin", asin(x), 1 / std::sqrt(1 - v * v));
    check("acos", acos(x), 1 / std::sqrt(1 - v * v));
    check("atan", atan(x), 1 / (1 + v * v));
    check("sinh", sinh(x), std::cosh(v));
    check("cosh", cosh(x), std::sinh(v));
    check("tanh", tanh(x), 1 - std::tanh(v) * std::tanh(v));
    check("asinh", asinh(x), 1 / std::sqrt(v * v + 1));
    check("acosh", acosh(y), 1 / std::sqrt(v * v + 2 * v));
    check("atanh", atanh(x), 1 / (1 - v * v));
    check("cbrt", cbrt(x), std::cbrt(v) / (3 * v));
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

TEST(Contributions, TellWhatMadeANumberUnknown) {
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
    // Known again, whatever it was.
    const number unsure = number::within(1, std::numeric_limits<double>::infinity());
    EXPECT_EQ((unsure * number(0)).error(), 0);
    EXPECT_TRUE(explain(unsure * number(0)).contributions.empty());
}

TEST(Contributions, BeyondTheLimitAreTheRest) {
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

/// Of what a product in the scopes around says.
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

TEST(Scopes, NestAsTheyAreEntered) {
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

TEST(Scopes, OfEachThreadAreItsOwn) {
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
    // Numbers go from thread to thread; what is done with them counts where it is done.
    const explanation sum = explain(results[0] + results[1]);
    EXPECT_EQ(sum.contributions.size(), 64U);
    EXPECT_GT(amount_in(sum, "this thread", "+"), 0);
}

// The last one here: no scope that is new after it is told apart.
TEST(Scopes, BeyondTheLimitCountForTheOneAround) {
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
