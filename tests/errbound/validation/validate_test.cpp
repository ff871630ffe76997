// Validation by MPFR of random expressions and queries: every rule passes, and rules that are
// broken on purpose fail.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <errbound/validation/boost_numbers.hpp>
#include <errbound/validation/validation.hpp>
#include <optional>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "errbound/validation/minimise.hpp"
#include "tests/errbound/validation/validation_rules.hpp"
#include "tests/support/long_double.hpp"
#include "tests/support/scaled.hpp"

namespace {

namespace validation = errbound::validation;
using validation::rule;
using validation_test::all_violations;
using validation_test::allowed_undetermined;
using validation_test::as_printed;
using validation_test::expect_all_kept;
using validation_test::too_small;
using validation_test::too_small_for_sums;

std::uint64_t expression_count() {
    return support::scaled(20000u);
}

TEST(Validate, EveryRuleHoldsInRandomExpressions) {
    const validation::expression_options options{.expressions = expression_count(), .seed = 7};
    const validation::report r = validation::validate_expressions(validation::rules(), options);
    expect_all_kept(r);
    EXPECT_EQ(r.counts.size(), 2 * validation::rules().size());
    for (const auto& c : r.counts) EXPECT_GE(c.cases, options.expressions) << c.rule;
    // Long expressions need more precision of the reference.
    expect_all_kept(validation::validate_expressions(
        validation::rules(),
        {.expressions = expression_count() / 10, .seed = 8, .operations = 48}));
}

std::size_t served(validation::number_type type) {
    return static_cast<std::size_t>(std::ranges::count_if(
        validation::rules(), [type](const rule& r) { return r.supports(type); }));
}

/// Checks that all rules hold in these formats. `open`: the number of values in a million that the
/// reference may leave undetermined.
void expect_kept(const validation::expression_options& options, std::uint64_t open) {
    const validation::report r = validation::validate_expressions(validation::rules(), options);
    EXPECT_EQ(r.violation_count(), 0U) << all_violations(r);
    std::size_t all = 0;
    for (const auto number : options.numbers) all += served(number);
    EXPECT_EQ(r.counts.size(), all);
    for (const auto& c : r.counts) {
        EXPECT_GE(c.cases, options.expressions) << c.rule << " " << c.number;
        EXPECT_LE(c.undetermined, c.values * open / 1000000 + allowed_undetermined(c))
            << c.rule << " " << c.number;
    }
}

TEST(Validate, EveryRuleHoldsInSmallFormats) {
    using enum validation::number_type;
    const validation::expression_options options{
        .expressions = expression_count() / 2,
        .seed = 9,
        .numbers = {float16_type, bfloat16_type, float8_e5m2_type, float8_e4m3_type}};
    for (const auto number : options.numbers) EXPECT_EQ(served(number), validation::rules().size());
    expect_kept(options, 10);
    const rule broken[] = {validation::rule_of<as_printed>()};
    const validation::report caught = validation::validate_expressions(broken, options);
    for (const auto& c : caught.counts) EXPECT_GT(c.violations, 0U) << c.number;
    ASSERT_FALSE(caught.violations.empty());
    EXPECT_NE(caught.violations.front().code.find("errbound::float16(0x"), std::string::npos)
        << caught.violations.front().code;
}

TEST(Validate, EveryRuleHoldsInWideFormats) {
    validation::expression_options options{.expressions = expression_count() / 4, .seed = 10};
    options.numbers.clear();
    for (const auto& number : validation::number_types)
        if (number.type >= validation::number_type::long_double_type)
            options.numbers.push_back(number.type);
    ASSERT_GE(options.numbers.size(), 2U);
    for (const auto number : options.numbers)
        EXPECT_EQ(served(number), validation::is_boost(number) ? 2 : validation::rules().size());
    expect_kept(options, 10000);
    rule broken[] = {validation::rule_of<too_small_for_sums>()};
    validation::set_boost_checks<too_small_for_sums>(broken[0]);
    const validation::report caught = validation::validate_expressions(broken, options);
    EXPECT_EQ(caught.counts.size(), options.numbers.size());
    for (const auto& c : caught.counts) EXPECT_GT(c.violations, 0U) << c.number;
    // The smallest violation has two inputs and a sum or difference, or a number with itself.
    for (const auto& v : caught.violations)
        EXPECT_LE(std::ranges::count(v.code, '\n'), 5) << v.number << "\n" << v.code;
}

/// Checks that a T is converted exactly, and that MPFR agrees.
template <class T, class Set>
void check_exact_values(std::uint64_t seed, const Set& set) {
    using traits = errbound::number_traits<T>;
    std::mt19937_64 random(seed);
    validation::mpfr_number ours(256), theirs(256);
    for (int i = 0; i < 2000; ++i) {
        T x = static_cast<T>(static_cast<double>(random() >> 11));
        for (int bits = 53; bits < traits::digits && i % 3 != 0; bits += 53)
            x = traits::scale(x, 53) + static_cast<T>(static_cast<double>(random() >> 11));
        if (i % 2 != 0) x = -x;
        const int reach = i % 4 == 0 ? 8 : traits::max_exponent / 2;
        x = traits::scale(x, static_cast<int>(random() % static_cast<unsigned>(2 * reach)) - reach);
        const validation::exact_value exact = validation::exactly(x);
        ASSERT_TRUE(validation::number_of<T>(exact) == x);
        EXPECT_EQ(ours.set(exact), 0);
        set(theirs.get(), x);
        ASSERT_NE(mpfr_equal_p(ours.get(), theirs.get()), 0);
    }
    EXPECT_FALSE(validation::exactly(T(traits::infinity())).is_finite());
    EXPECT_TRUE(
        std::isnan(validation::exactly(T(traits::infinity() - traits::infinity())).leading));
}

TEST(Validate, NumbersOfEveryFormatAreConvertedExactly) {
    check_exact_values<double>(1, [](mpfr_ptr to, double x) { mpfr_set_d(to, x, MPFR_RNDN); });
    check_exact_values<support::long_double>(
        2, [](mpfr_ptr to, long double x) { mpfr_set_ld(to, x, MPFR_RNDN); });
    using number = boost::multiprecision::mpfr_float_50;
    check_exact_values<number>(
        3, [](mpfr_ptr to, const number& x) { mpfr_set(to, x.backend().data(), MPFR_RNDN); });
}

TEST(Validate, MinimisedNumbersStayFinite) {
    // The product of numbers with the largest exponents would overflow.
    using number = support::long_double;
    constexpr int most = errbound::number_traits<number>::max_exponent - 1;
    validation::expression e;
    e.inputs[0].value = validation::exactly(std::ldexp(number(1.75), most));
    e.inputs[1].value = validation::exactly(std::ldexp(number(1.3), most));
    e.input_count = 2;
    e.operations[0] = {validation::operation_kind::subtract, 0, 1, 0, 0};
    e.operation_count = 1;
    const auto type = errbound::number_traits<number>::digits > 53
                          ? validation::number_type::long_double_type
                          : validation::number_type::double_type;
    std::size_t tried = 0;
    const auto small = validation::minimised(e, type, [&](const validation::expression& x) {
        ++tried;
        for (std::size_t i = 0; i < x.input_count; ++i) EXPECT_TRUE(x.inputs[i].value.is_finite());
        return x.operation_count == 1 ? std::optional(x.size() - 1) : std::nullopt;
    });
    EXPECT_EQ(small.operation_count, 1U);
    EXPECT_EQ(small.inputs[0].value, validation::exact_value(0));
    EXPECT_GT(tried, 2U);
}

TEST(Validate, ErrorsAreThoseOfTheRulesValues) {
    // In expression 8,531,125, a rule that ignores the sign of zero has the value π, and `none` has
    // −π.
    const rule rules[] = {validation::rule_of<errbound::none>(),
                          validation::rule_of<errbound::tight>()};
    const validation::expression_options options{.expressions = 10'000'000,
                                                 .numbers = {validation::number_type::double_type}};
    const validation::report r =
        validation::evidence_of_expressions(rules, options).report_of(8'531'125 / 33'334);
    EXPECT_EQ(r.violation_count(), 0U);
    EXPECT_EQ(r.counts.front().cases, 33'334U);
}

/// The rule's violations in random expressions, each minimised. There must be some.
std::vector<validation::violation> caught_in_expressions(const rule& broken) {
    const validation::report r =
        validation::validate_expressions(std::span(&broken, 1), {.expressions = 2000, .seed = 1});
    EXPECT_GT(r.violation_count(), 0U) << broken.name;
    EXPECT_FALSE(r.violations.empty());
    return r.violations;
}

TEST(Validate, RulesWithoutAnUnderflowTermFail) {
    constexpr rule broken = validation::rule_of<as_printed>();
    bool by_underflow = false;
    for (const validation::violation& v : caught_in_expressions(broken)) {
        const auto lines = std::count(v.code.begin(), v.code.end(), '\n');
        EXPECT_LE(lines, 5) << v.what << "\n"
                            << v.code;  // namespace, type, two operands, an operation
        by_underflow = by_underflow || v.code.find(" * ") != std::string::npos;
    }
    EXPECT_TRUE(by_underflow);
}

TEST(Validate, RulesWithTooSmallAFactorFail) {
    constexpr rule broken = validation::rule_of<too_small>();
    for (const validation::violation& v : caught_in_expressions(broken))
        EXPECT_LE(std::count(v.code.begin(), v.code.end(), '\n'), 5) << v.what << "\n" << v.code;
}

TEST(Validate, FunctionsHaveTheAssumedErrors) {
    // Sanitizers do not reduce this number: the largest errors must occur.
    validation::function_options options{.samples = 3000, .seed = 5};
    for (const auto& f : validation::named_functions) options.functions.push_back(f.function);
    const validation::report r = validation::examine(validation::evidence_of_functions(options), 0);
    EXPECT_EQ(r.violation_count(), 0U);
    ASSERT_EQ(r.functions.size(), 2 * validation::named_functions.size());
    for (const auto& f : r.functions) {
        EXPECT_GE(f.arguments, options.samples / 8) << f.function << " " << f.number;
        EXPECT_LE(f.largest, f.assumed) << f.function << " of " << f.number << " " << f.at;
        EXPECT_GE(f.largest, 0.45) << f.function << " " << f.number;
    }
    // A smaller assumption is refuted.
    options.units = 0.4;
    const validation::report caught =
        validation::examine(validation::evidence_of_functions(options), 0);
    for (const auto& f : caught.functions) EXPECT_GT(f.violations, 0U) << f.function;
    EXPECT_GT(caught.violation_count(), r.violation_count());
}

TEST(Validate, TriesEveryFloat) {
    validation::function_options options{
        .functions = {errbound::elementary_function::sin},
        .every_float = true,
        .numbers = {errbound::validation::number_type::float_type}};
    const validation::evidence all = validation::evidence_of_functions(options);
    ASSERT_GT(all.chunks, 100U);
    // The last 2^23 − 1 floats are NaN, after infinity. They are not tried.
    const validation::report last = all.report_of(all.chunks - 1);
    ASSERT_EQ(last.functions.size(), 1U);
    EXPECT_EQ(last.functions.front().function, "sin");
    const double size = 0x1p32 / static_cast<double>(all.chunks);
    EXPECT_NEAR(static_cast<double>(last.functions.front().arguments), size - 0x1p23, 0.001 * size);
    options.functions.clear();
    EXPECT_EQ(validation::evidence_of_functions(options).chunks, 0U);
}

TEST(Validate, FindsTheLargestErrorOfAllFloats) {
    // The float at which the GNU C library's sinf has its largest error. If the assumption is half
    // a unit, MPFR checks all errors above half a unit; else only those that may be the largest.
    constexpr auto most = std::bit_cast<std::uint32_t>(0x1.0c05ccp-1F);
    validation::function_options options{
        .functions = {errbound::elementary_function::sin},
        .every_float = true,
        .numbers = {errbound::validation::number_type::float_type}};
    const auto around = [&] {
        const validation::evidence all = validation::evidence_of_functions(options);
        return all.report_of(most * all.chunks >> 32U).functions.front();
    };
    const validation::function_errors as_assumed = around();
    options.units = 0.5;
    const validation::function_errors all = around();
    ASSERT_GT(all.violations, 0U);
    EXPECT_EQ(as_assumed.violations, 0U);
    EXPECT_EQ(as_assumed.arguments, all.arguments);
    if (all.at != "0x1.0c05ccp-1F") GTEST_SKIP() << "another library's sinf";
    EXPECT_EQ(as_assumed.largest, all.largest);
    EXPECT_EQ(as_assumed.at, all.at);
}

TEST(Validate, ChunksTogetherAreTheWhole) {
    const rule rules[] = {validation::rule_of<errbound::tight>(), validation::rule_of<as_printed>(),
                          validation::rule_of<too_small>()};
    const validation::expression_options options{.expressions = 6000, .seed = 4};
    const validation::evidence all = validation::evidence_of_expressions(rules, options);
    ASSERT_GT(all.chunks, 3U);
    // Two halves of the chunks, each merged by itself.
    validation::report first, second;
    for (std::uint64_t c = 0; c < all.chunks; ++c)
        (c < all.chunks / 2 ? first : second).merge(all.report_of(c));
    first.merge(second);
    all.describe(first);
    const validation::report whole = validation::validate_expressions(rules, options);
    EXPECT_EQ(all_violations(first), all_violations(whole));
    ASSERT_EQ(first.counts.size(), 6U);
    std::uint64_t told = 0;
    for (const auto& c : whole.counts)
        told += std::min<std::uint64_t>(c.violations, validation::report::kept_violations);
    EXPECT_EQ(whole.violations.size(), told);
    ASSERT_EQ(first.distributions.size(), whole.distributions.size());
    for (std::size_t i = 0; i < whole.distributions.size(); ++i) {
        EXPECT_EQ(first.distributions[i].quantity, whole.distributions[i].quantity);
        const validation::distribution &a = first.distributions[i].log10,
                                       &b = whole.distributions[i].log10;
        EXPECT_EQ(a.count(), b.count());
        EXPECT_EQ(a.ratios(), b.ratios());
        if (a.ratios() == 0) continue;
        for (double share = 0; share < 1; share += 0.01)
            EXPECT_EQ(a.quantile(share), b.quantile(share));
    }
}

TEST(Validate, ExceptionsOfChunksArePropagated) {
    validation::evidence all{.chunks = 100,
                             .report_of = [](std::uint64_t c) -> validation::report {
                                 if (c == 7) throw std::runtime_error("seven");
                                 return {};
                             },
                             .describe = [](validation::report&) {}};
    for (const int threads : {1, 3})
        EXPECT_THROW(validation::examine(all, threads), std::runtime_error);
    all.chunks = 0;
    EXPECT_TRUE(validation::examine(all, 2).counts.empty());
}

TEST(Distribution, ExtremesAndClampedQuantiles) {
    validation::distribution d;
    d.add_exact();
    d.add_unknown();
    for (const double log10 : {0.5, -3.0, 7.25, -1e6, 0.5, 1e6, 99.999}) d.add(log10);
    EXPECT_EQ(d.count(), 9U);
    EXPECT_EQ(d.ratios(), 7U);
    EXPECT_EQ(d.quantile(0.5), 0.5);
    EXPECT_EQ(d.quantile(0), -1e6);
    EXPECT_EQ(d.quantile(1), 1e6);
    EXPECT_EQ(d.covered(), 5U);
    // The extremes are exact. Their neighbours are only known to lie beyond the ends.
    EXPECT_FALSE(d.is_clamped(0) || d.is_clamped(0.5) || d.is_clamped(1));
    EXPECT_TRUE(d.is_clamped(0.1) && d.is_clamped(0.95));
    d.add(validation::distribution::least_log);
    EXPECT_FALSE(d.is_clamped(0));
}

}  // namespace
