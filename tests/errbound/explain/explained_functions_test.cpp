// Elementary functions, dot products and Horner's rule of explained numbers beside those of the
// rule that they wrap, on any input: the same bits, and contributions that come to no less than the
// error.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <errbound/explain/explain.hpp>
#include <errbound/rules/affine.hpp>
#include <limits>
#include <random>
#include <string>

#include "tests/support/any_format.hpp"
#include "tests/support/assumed_errors.hpp"
#include "tests/support/scaled.hpp"

namespace {

using errbound::explained;
using errbound::scope;
using errbound::tracked;

template <class T>
bool same(const T& x, const T& y) {
    return x == y ? std::signbit(x) == std::signbit(y) : x != x && y != y;
}

template <class T, class Rule>
class functions_beside {
    using plain = tracked<T, Rule>;
    using told = tracked<T, explained<Rule>>;

  public:
    void run(int times) {
        for (int k = 0; k < times && !testing::Test::HasFatalFailure(); ++k) {
            draw();
            compare_exponentials();
            compare_trigonometric();
            compare_hyperbolic();
            compare_sums();
        }
        EXPECT_GT(known_, times);
        EXPECT_GT(unknown_, times / 10);
    }

  private:
    /// x and y, each with an error or none, in a product or as they are; most of them near 1.
    void draw() {
        for (int i = 0; i < 2; ++i) {
            T v = any_number<T>(random_);
            if (random_() % 4 != 0)
                v = static_cast<T>(static_cast<double>(random_() >> 11) * 0x1p-52);
            if (random_() % 2 != 0) v = -v;
            T e = std::abs(any_number<T>(random_));
            if (random_() % 8 != 0) e = std::ldexp(std::abs(v), -static_cast<int>(random_() % 30));
            if (random_() % 4 == 0) e = 0;
            const scope s("input " + std::to_string(i));
            by_rule_[i] = plain::within(v, e);
            by_explained_[i] = told::within(v, e);
            if (random_() % 3 != 0) continue;
            by_rule_[i] *= plain(T(0.7));
            by_explained_[i] *= told(T(0.7));
        }
    }
    void compare_exponentials() {
        compare("exp", [](auto x, auto) { return exp(x); });
        compare("exp2", [](auto x, auto) { return exp2(x); });
        compare("expm1", [](auto x, auto) { return expm1(x); });
        compare("log", [](auto x, auto) { return log(x); });
        compare("log2", [](auto x, auto) { return log2(x); });
        compare("log10", [](auto x, auto) { return log10(x); });
        compare("log1p", [](auto x, auto) { return log1p(x); });
        compare("cbrt", [](auto x, auto) { return cbrt(x); });
        compare("pow", [](auto x, auto y) { return pow(x, y); });
        compare("pow of a number", [](auto x, auto) { return pow(x, T(0.3)); });
        compare("power of a number", [](auto x, auto) { return pow(T(0.3), x); });
    }
    void compare_trigonometric() {
        compare("sin", [](auto x, auto) { return sin(x); });
        compare("cos", [](auto x, auto) { return cos(x); });
        compare("tan", [](auto x, auto) { return tan(x); });
        compare("asin", [](auto x, auto) { return asin(x); });
        compare("acos", [](auto x, auto) { return acos(x); });
        compare("atan", [](auto x, auto) { return atan(x); });
        compare("atan2", [](auto x, auto y) { return atan2(x, y); });
    }
    void compare_hyperbolic() {
        compare("sinh", [](auto x, auto) { return sinh(x); });
        compare("cosh", [](auto x, auto) { return cosh(x); });
        compare("tanh", [](auto x, auto) { return tanh(x); });
        compare("asinh", [](auto x, auto) { return asinh(x); });
        compare("acosh", [](auto x, auto) { return acosh(x); });
        compare("atanh", [](auto x, auto) { return atanh(x); });
    }
    void compare_sums() {
        compare("dot", [](auto x, auto y) {
            return dot(std::array{x, y, x, y}, std::array{y, y, -y, x});
        });
        compare("dot of one", [](auto x, auto y) { return dot(std::array{x}, std::array{y}); });
        compare("horner", [](auto x, auto y) { return horner(std::array{y, x, y, -x}, x); });
        compare("horner of one", [](auto x, auto y) { return horner(std::array{y}, x); });
    }

    template <class F>
    void compare(const char* name, const F& f) {
        const scope s("function");
        const plain wanted = f(by_rule_[0], by_rule_[1]);
        const told found = f(by_explained_[0], by_explained_[1]);
        const std::string where = std::string(name) + ", rule " + Rule::name;
        ASSERT_TRUE(same(found.value(), wanted.value())) << where;
        ASSERT_TRUE(same(found.error(), wanted.error())) << where;
        ASSERT_EQ(sign_of(found), sign_of(wanted)) << where;
        rational amounts = 0;
        const errbound::explanation e = errbound::explain(found);
        const bool known = std::isfinite(found.error());
        for (const auto& c : e.contributions) {
            ASSERT_EQ(std::isfinite(c.amount), known) << where;
            if (known) amounts += exactly(c.amount);
        }
        ++(known ? known_ : unknown_);
        if (known && found.error() < std::numeric_limits<T>::max() / 2) {
            ASSERT_GE(amounts, exactly_of(found.error())) << where;
        } else if (!known) {
            ASSERT_FALSE(e.contributions.empty()) << where;
        }
    }

    std::mt19937_64 random_{7};
    plain by_rule_[2];
    told by_explained_[2];
    int known_ = 0, unknown_ = 0;
};

TEST(ExplainedFunctions, AreTheRulesAndAddUpOnAnyInput) {
    const int times = support::scaled(3000);
    functions_beside<double, errbound::tight>().run(times);
    functions_beside<float, errbound::residual>().run(times);
    functions_beside<double, errbound::affine>().run(times / 4);
}

}  // namespace
