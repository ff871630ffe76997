// Dot products and Horner's rule against rationals, single operations and a plain loop: of numbers
// with bounds, of every size, in every format, under every rule.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <errbound/functions.hpp>
#include <errbound/rules/affine.hpp>
#include <errbound/rules/derived.hpp>
#include <errbound/rules/relative.hpp>
#include <errbound/rules/stochastic.hpp>
#include <errbound/small_floats.hpp>
#include <errbound/validation/rule_list.hpp>
#include <limits>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/random_programs.hpp"
#include "tests/support/scaled.hpp"

namespace {

using errbound::number_traits;
using errbound::sign_type;
using errbound::tracked;

/// `tight` without its dot_bound, which is not inherited.
struct renamed : errbound::derived_rule<renamed, errbound::tight> {
    static constexpr const char* name = "renamed";
};
static_assert(errbound::detail::rule_has_dot<errbound::tight, double>);
static_assert(errbound::detail::rule_has_dot<errbound::sharp, errbound::bfloat16>);
static_assert(!errbound::detail::rule_has_dot<errbound::tight, errbound::float8_e4m3>);
static_assert(!errbound::detail::rule_has_dot<errbound::residual, double>);
static_assert(!errbound::detail::rule_has_dot<renamed, double>);

/// A product that no compiler fuses into a sum.
template <class T>
T plain_product(const T& a, const T& b) {
    if constexpr (std::is_floating_point_v<T>) {
        volatile T product = a * b;
        return product;
    } else {
        return a * b;
    }
}

template <class T, class Rule>
class checker {
    using number = tracked<T, Rule>;
    using traits = number_traits<T>;
    using sample = support::sample<number>;

  public:
    void run(int count) {
        for (int k = 0; k < count && !testing::Test::HasFatalFailure(); ++k) {
            largest_exponent_ = static_cast<int>(random_() % 4);
            const std::size_t size = random_() % 16 == 0 ? 60 + random_() % 80 : random_() % 9;
            draw(size);
            check_dot();
            check_horner();
        }
        EXPECT_GT(known_, count / 10);
    }

  private:
    /// A number of any size, or one of those whose sums stay in range. It is exact, or has a bound
    /// and stands for any number within it.
    sample input() {
        T v = special_value<T>(random_);
        if (largest_exponent_ != 0 || !traits::is_finite(v))
            v = traits::scale(static_cast<T>(static_cast<double>(random_() % 4097) / 2048 - 1),
                              static_cast<int>(random_() % 3) * largest_exponent_ - 2);
        if (random_() % 2 != 0) return {number(v), exactly(v)};
        T error = traits::scale(traits::abs(v), -static_cast<int>(random_() % 40));
        if (random_() % 16 == 0) error = traits::abs(special_value<T>(random_));
        if (!traits::is_finite(error)) return {number(v), exactly(v)};
        return support::sample_within<number>(v, error, random_);
    }
    /// Pairs, some of which cancel earlier ones, or nearly. In one list of eight, each pair after
    /// the first is half a unit in the last place of the first.
    void draw(std::size_t size) {
        a_.clear();
        b_.clear();
        exact_.clear();
        const bool lost = random_() % 8 == 0;
        while (a_.size() < size) {
            const auto add = [&](const sample& x, const sample& y) {
                a_.push_back(x.number);
                b_.push_back(y.number);
                exact_.push_back({x.exact, y.exact});
            };
            const std::size_t i = a_.empty() ? 0 : random_() % a_.size();
            if (lost && !a_.empty()) {
                const T x = traits::scale(a_[0].value(), -traits::digits), y = b_[0].value();
                add({x, exactly(x)}, {y, exactly(y)});
            } else if (!a_.empty() && random_() % 4 == 0) {
                add({-a_[i], -exact_[i][0]}, {b_[i], exact_[i][1]});
            } else {
                add(input(), input());
            }
        }
    }

    void check_dot() {
        const number found = dot(a_, std::span<const number>(b_));
        T plain(0);
        number one_by_one(0);
        rational exact = 0;
        for (std::size_t i = 0; i < a_.size(); ++i) {
            plain = plain + plain_product(a_[i].value(), b_[i].value());
            one_by_one = one_by_one + a_[i] * b_[i];
            exact += exact_[i][0] * exact_[i][1];
        }
        ASSERT_TRUE(same_bits(found.value(), plain)) << Rule::name;
        check(found, exact, "dot");
        check_not_worse(found, one_by_one, a_.size(), "dot");
    }
    void check_horner() {
        const sample x = input();
        const number found = horner(a_, x.number);
        T plain(0);
        number one_by_one(0);
        rational exact = 0;
        for (std::size_t i = a_.size(); i-- > 0;) {
            const bool first = i + 1 == a_.size();
            plain = first ? a_[i].value() : plain_product(plain, x.number.value()) + a_[i].value();
            one_by_one = first ? number(a_[i]) : one_by_one * x.number + a_[i];
            exact = exact * x.exact + exact_[i][0];
        }
        ASSERT_TRUE(same_bits(found.value(), plain)) << Rule::name;
        check(found, exact, "horner");
        check_not_worse(found, one_by_one, 0, "horner");
    }

    void check(const number& found, const rational& exact, const char* what) {
        if constexpr (!errbound::promises_bound<Rule>) return;
        known_ += !support::claims_nothing(found);
        support::check(sample{found, exact},
                       std::string(what) + " " + Rule::name + " of " + std::to_string(a_.size()));
    }
    /// The bound of a dot product may be larger by the factor 1 + (terms + 7)ε and a few η for each
    /// `closing` of terms.
    void check_not_worse(const number& found, const number& one_by_one, std::size_t terms,
                         const char* what) {
        if (!errbound::promises_bound<Rule> || !traits::is_finite(one_by_one.error())) return;
        ASSERT_TRUE(traits::is_finite(found.error())) << what << " " << Rule::name;
        const rational slack = terms == 0 ? 0 : 1;
        ASSERT_LE(
            exactly(found.error()),
            exactly(one_by_one.error()) * (1 + slack * (terms + 8) * exactly(traits::epsilon())) +
                slack * (terms / 2 + 2) * exactly(traits::underflow_unit()))
            << what << " " << Rule::name << " " << terms;
    }

    std::mt19937_64 random_{17};
    std::vector<number> a_, b_;
    std::vector<std::array<rational, 2>> exact_;
    int largest_exponent_ = 0, known_ = 0;
};

template <class T>
class DotAndHorner : public testing::Test {};
using numbers = testing::Types<double, float, errbound::float16, errbound::bfloat16,
                               errbound::float8_e5m2, errbound::float8_e4m3>;
TYPED_TEST_SUITE(DotAndHorner, numbers);

TYPED_TEST(DotAndHorner, HoldTheExactResultAndEqualPlainLoops) {
    const auto run = []<class Rule>() { checker<TypeParam, Rule>().run(support::scaled(2000)); };
    using namespace errbound;
    for_each_rule(rule_types<tight, sharp, safe, interval, residual, relative>(), run);
    checker<TypeParam, affine>().run(support::scaled(500));
    checker<TypeParam, renamed>().run(support::scaled(500));
}

/// The error of the sum of the squares of a thousand thirds, and the error of a loop.
template <class Rule>
std::pair<double, double> errors_of_squares() {
    using number = tracked<double, Rule>;
    const std::vector<number> thirds(1000, number(1.0 / 3));
    number loop = 0;
    for (const number& x : thirds) loop += x * x;
    return {dot(thirds, thirds).error(), loop.error()};
}

TEST(DotOfDoubles, HasSmallerErrorsThanALoop) {
    using errbound::relative, errbound::sharp, errbound::tight;
    const auto [by_tight, by_loop] = errors_of_squares<tight>();
    EXPECT_LT(by_tight, by_loop);
    // Half as many factors: partial sums are smaller than the last one.
    const auto [by_relative, by_relative_loop] = errors_of_squares<relative>();
    EXPECT_LT(by_relative, 0.52 * by_relative_loop);
    // A thousand small terms beside a large one: each is off by no more than it is.
    std::vector<tracked<double, sharp>> small(1000, 0x1p-70), ones(1000, 1);
    small[0] = 1 / 3.0;
    tracked<double, sharp> sum = 0;
    for (const auto& x : small) sum += x;
    EXPECT_LT(dot(small, ones).error(), 0x1p-54 + 1001 * 0x1p-69);
    EXPECT_GT(sum.error(), 900 * 0x1p-55);
    // Partial sums that cancel do not lose their errors.
    using counted = tracked<double, relative>;
    const std::vector<counted> a{1 / 3.0, -1 / 3.0, 5}, b{1 / 3.0, 1 / 3.0, 1 / 3.0};
    EXPECT_EQ(sign_of(dot(a, b)), sign_type::positive);
    EXPECT_EQ(sign_of(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]), sign_type::uncertain);
}

TEST(DotOfDoubles, OfResidualIsCompensated) {
    using number = tracked<double, errbound::residual>;
    const std::array<number, 3> a{1e16, 1, -1e16}, b{1, 1, 1};
    const number found = dot(a, b);
    EXPECT_EQ(found.value(), 0);  // the plain sum
    EXPECT_EQ(found.bound().correction, 1);
    EXPECT_EQ(found.bound().remainder, 0);
    EXPECT_EQ(sign_of(found), sign_type::positive);
}

TEST(HornerOfDoubles, MultipliesTheErrorOfXByTheSlope) {
    using number = tracked<double>;
    // (x − 1)², where the slope is 0.
    const std::array<number, 3> c{1, -2, 1};
    const number x = number::within(1, 1e-3);
    EXPECT_LE(horner(c, x).error(), 1.01e-6);
    EXPECT_GE(((c[2] * x + c[1]) * x + c[0]).error(), 1.99e-3);
    using ends = tracked<double, errbound::interval>;
    const std::array<ends, 3> d{1, -2, 1};
    EXPECT_LE(horner(d, ends::within(1, 1e-3)).error(), 1.01e-6);
    // If x is so uncertain that the slope is useless, the error is no larger than a loop's.
    const number wide = number::within(1, 100);
    EXPECT_LE(horner(c, wide).error(), ((c[2] * wide + c[1]) * wide + c[0]).error());
}

TEST(DotOfDoubles, OfNothingZerosAndInfinities) {
    using number = tracked<double>;
    const std::vector<number> none, zeros(5, number(0)), some(5, number(0.1));
    EXPECT_EQ(sign_of(dot(none, none)), sign_type::zero);
    EXPECT_EQ(sign_of(dot(zeros, some)), sign_type::zero);
    EXPECT_EQ(sign_of(horner(none, number(0.1))), sign_type::zero);
    EXPECT_EQ(horner(some, number(0)).value(), 0.1);
    EXPECT_FALSE(std::signbit(dot(std::array{number(-1)}, std::array{number(0)}).value()));
    const std::vector<number> infinite(5, number(std::numeric_limits<double>::infinity()));
    EXPECT_EQ(sign_of(dot(infinite, zeros)), sign_type::uncertain);
    EXPECT_FALSE(std::isfinite(dot(infinite, zeros).error()));
    EXPECT_EQ(sign_of(dot(infinite, some)), sign_type::uncertain);
    EXPECT_EQ(sign_of(horner(infinite, number(0.1))), sign_type::uncertain);
}

TEST(DotOfDoubles, WorksInConstantExpressions) {
    using number = tracked<double>;
    constexpr std::array<number, 2> a{3, 4};
    static_assert(sign_of(dot(a, a) - number(24)) == sign_type::positive);
    static_assert(sign_of(horner(a, number(2)) - number(12)) == sign_type::negative);
    const number c[] = {1, 2};
    EXPECT_EQ(dot(c, a).value(), 11);
}

TEST(DotOfDoubles, IsAPlainLoopForRulesWithoutBounds) {
    using number = tracked<double, errbound::none>;
    const std::vector<number> a{0.1, 0.2, 0.3};
    double plain = 0;
    for (const number& x : a) plain += plain_product(x.value(), x.value());
    EXPECT_EQ(dot(a, a).value(), plain);
    EXPECT_EQ(dot(a, a).error(), 0);
    using sampled = tracked<double, errbound::stochastic>;
    const std::vector<sampled> b{0.1, 0.2, 0.3};
    EXPECT_EQ(dot(b, b).value(), dot(a, a).value());
    EXPECT_EQ(horner(b, sampled::within(2, 1e-3)).value(), horner(a, number(2)).value());
}

}  // namespace
