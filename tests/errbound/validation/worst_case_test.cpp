// Certified bounds over boxes, compared with the errors of all inputs in small formats.
#include <gtest/gtest.h>

#include <cmath>
#include <errbound/validation/worst_case.hpp>
#include <string>
#include <vector>

#include "errbound/validation/random_source.hpp"
#include "errbound/validation/worst_case/largest_error.hpp"
#include "tests/errbound/validation/validation_rules.hpp"
#include "tests/support/scaled.hpp"

namespace errbound {
namespace {

using validation::random_source;

enum class op { add, sub, mul, div, neg, root, absolute, lesser, greater, fused, count };
constexpr elementary_function functions[] = {
    elementary_function::exp,   elementary_function::log,   elementary_function::sin,
    elementary_function::cos,   elementary_function::tan,   elementary_function::atan,
    elementary_function::tanh,  elementary_function::expm1, elementary_function::log1p,
    elementary_function::asin,  elementary_function::sinh,  elementary_function::cbrt,
    elementary_function::acosh, elementary_function::pow,   elementary_function::atan2,
    elementary_function::exp2,  elementary_function::log2,  elementary_function::log10,
    elementary_function::acos,  elementary_function::cosh,  elementary_function::asinh,
    elementary_function::atanh};
constexpr int first_function = static_cast<int>(op::count);

struct step {
    int kind, left, right, third;
};
/// Values: inputs, then constants, then results of steps.
struct program {
    int inputs = 1;
    std::vector<double> constants;
    std::vector<step> steps;
};

program random_program(random_source& random, bool with_functions) {
    program p;
    p.inputs = 1 + random.below(2);
    for (int i = random.below(3); i > 0; --i)
        p.constants.push_back(random.one_in(2) ? random.between(-4, 4)
                                               : std::ldexp(random.between(-99, 99), -5));
    const int count = 1 + random.below(7);
    int values = p.inputs + static_cast<int>(p.constants.size());
    for (int i = 0; i < count; ++i, ++values) {
        // Later values more often, so that most steps count.
        const auto operand = [&] {
            return random.one_in(2) ? values - 1 - random.below(std::min(values, 2))
                                    : random.below(values);
        };
        int kind = random.below(4);
        if (random.one_in(4)) kind = random.below(first_function);
        if (with_functions && random.one_in(3))
            kind = first_function + random.below(static_cast<int>(std::size(functions)));
        p.steps.push_back({kind, operand(), operand(), operand()});
    }
    return p;
}

/// Functions whose names differ: those of recorded numbers are found by their arguments.
template <class S>
S function_of(const step& s, const S& x, const S& y, const S& z) {
    if constexpr (std::same_as<S, recorded>) {
        switch (static_cast<op>(s.kind)) {
            case op::root:
                return sqrt(x);
            case op::absolute:
                return abs(x);
            case op::lesser:
                return min(x, y);
            case op::greater:
                return max(x, y);
            case op::fused:
                return fma(x, y, z);
            default:
                const elementary_function f = functions[s.kind - first_function];
                return validation::has_two_arguments(f) ? recorded::of(f, x, y)
                                                        : recorded::of(f, x);
        }
    } else {
        using wide = detail::function_type<S>;
        switch (static_cast<op>(s.kind)) {
            case op::root:
                return number_traits<S>::sqrt(x);
            case op::absolute:
                return number_traits<S>::abs(x);
            case op::lesser:
                return y < x ? y : x;
            case op::greater:
                return x < y ? y : x;
            case op::fused:
                if constexpr (std::same_as<S, long double>) return x * y + z;
                return number_traits<S>::fma(x, y, z);
            default:
                return validation::with_function(
                    functions[s.kind - first_function], [&]<elementary_function F>() {
                        if constexpr (validation::has_two_arguments(F))
                            return S(detail::system_function<F>(wide(x), wide(y)));
                        else
                            return S(detail::system_function<F>(wide(x)));
                    });
        }
    }
}

template <class S>
S run(const program& p, const std::vector<S>& inputs) {
    std::vector<S> v(inputs);
    for (const double c : p.constants) v.push_back(S(c));
    for (const step& s : p.steps) {
        const S x = v[static_cast<std::size_t>(s.left)], y = v[static_cast<std::size_t>(s.right)],
                z = v[static_cast<std::size_t>(s.third)];
        const auto kind = static_cast<op>(s.kind);
        v.push_back(kind == op::add   ? x + y
                    : kind == op::sub ? x - y
                    : kind == op::mul ? x * y
                    : kind == op::div ? x / y
                    : kind == op::neg ? -x
                                      : function_of(s, x, y, z));
    }
    return v.back();
}

/// All numbers of T from a random one on, or from the least one of a random exponent.
template <class T>
std::vector<double> random_numbers(random_source& random, int most) {
    using traits = number_traits<T>;
    const int e = random.one_in(4) ? random.between(traits::min_exponent, traits::max_exponent - 1)
                                   : random.between(-3, 4);
    double x = std::ldexp(random.one_in(3) ? 1 : 1 + random.below(1 << 10) * 0x1p-10, e);
    x = static_cast<double>(T(random.one_in(2) ? -x : x));
    if (!std::isfinite(x)) x = 1;
    if (random.one_in(8)) x = 0;
    std::vector<double> all{x};
    // Some boxes are wide, with a part of their numbers tried.
    const int stride = random.one_in(3) ? 1 + random.below(50) : 1;
    for (int i = random.below(most) * stride; i > 0; --i) {
        const int unit =
            std::max(x == 0 ? traits::min_exponent : std::ilogb(x) + 1, traits::min_exponent) -
            traits::digits;
        const bool to_smaller_unit = x < 0 && std::exp2(std::ilogb(x)) == -x;
        x += std::ldexp(
            1.0, std::max(unit - (to_smaller_unit ? 1 : 0), traits::min_exponent - traits::digits));
        if (!(x <= static_cast<double>(traits::largest()))) break;
        if (i % stride == 0 || i == 1) all.push_back(x);
    }
    return all;
}

struct tally {
    int bounded = 0, programs = 0;
    std::uint64_t inputs = 0;
    double log_ratio = 0;  ///< sum of log2 of bound/largest error
    int ratios = 0;
};

/// A program with a box, of which it tries all listed numbers.
template <class T>
struct trial {
    program p;
    std::vector<std::vector<double>> numbers;
    std::vector<input_range> box;
    worst_case_options options;

    explicit trial(random_source& random, bool with_functions)
        : p(random_program(random, with_functions)) {
        for (int k = 0; k < p.inputs; ++k) {
            // MPFR measures all errors of doubles.
            const int most = std::same_as<T, double> ? 16 : 256;
            numbers.push_back(random_numbers<T>(random, p.inputs == 1 ? most : most / 8 + 2));
            box.push_back({numbers.back().front(), numbers.back().back()});
        }
        options.samples = random.one_in(8) ? 400 : 0;
        options.seed = random.bits();
        constexpr std::size_t limits[] = {1, 2, 7, 50, 400};
        options.boxes = limits[random.below(5)];
        options.round_inputs = random.one_in(4);
        options.relative = random.one_in(4);
    }

    void record(validation::recording& r) const {
        std::vector<recorded> inputs;
        for (std::size_t k = 0; k < box.size(); ++k)
            inputs.emplace_back(
                validation::recording::node{.kind = validation::recording::leaf::input, .left = k});
        r.result = run<recorded>(p, inputs).index();
    }
    /// Distances of the real numbers that are rounded to these; 0 if they are not in the box.
    std::vector<double> offsets(const std::vector<double>& at, random_source& random) const {
        std::vector<double> off(at.size(), 0);
        for (std::size_t k = 0; k < at.size() && options.round_inputs; ++k) {
            const int e = at[k] == 0 ? -10000 : std::ilogb(at[k]);
            const double half = std::ldexp(
                0.4990234375, std::max(e, number_traits<T>::min_exponent - 1) + 1 -
                                  number_traits<T>::digits - (std::exp2(e) == std::abs(at[k])));
            off[k] = random.one_in(2) ? half : -half;
            if (at[k] + off[k] < box[k].lower || at[k] + off[k] > box[k].upper) off[k] = 0;
        }
        return off;
    }
    /// The error at one input, by long double. MPFR decides for doubles, and near a bound.
    double check(const validation::recording& r, const worst_case_result& bound,
                 const std::vector<double>& at, const std::vector<double>& off) const {
        std::vector<T> computed_at;
        std::vector<long double> exactly_at;
        for (std::size_t k = 0; k < at.size(); ++k) {
            computed_at.push_back(T(at[k]));
            exactly_at.push_back(static_cast<long double>(at[k]) + off[k]);
        }
        const auto computed = static_cast<double>(run<T>(p, computed_at));
        const long double exact = run<long double>(p, exactly_at);
        const auto error = static_cast<double>(std::abs(computed - exact));
        const double size = std::abs(static_cast<double>(exact)), slack = 1e-12 * size;
        const auto relative_holds = [&](double e) {
            return !options.relative || bound.relative_at_most == HUGE_VAL ||
                   e <= bound.relative_at_most * size * (1 + 1e-12);
        };
        const bool in_range = exact >= bound.lower - slack && exact <= bound.upper + slack;
        if (number_traits<T>::digits < number_traits<double>::digits &&
            error <= bound.at_most * 0.999 && relative_holds(error) && in_range)
            return error;
        const double certain = validation::error_at(r, at, off);
        EXPECT_TRUE(std::isfinite(computed));
        EXPECT_LE(certain, bound.at_most) << at[0] << ' ' << at.back();
        EXPECT_TRUE(relative_holds(certain)) << at[0] << ' ' << at.back();
        EXPECT_TRUE(in_range) << at[0] << ' ' << at.back();
        return error;
    }
};

template <class T>
void check_random_programs(std::uint64_t seed, int count, bool with_functions, tally& t) {
    random_source random(seed);
    for (int i = 0; i < count && !testing::Test::HasFailure(); ++i) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", program " + std::to_string(i));
        const trial<T> one(random, with_functions);
        validation::recording r(validation::number_type_of<T>(), one.box, one.options);
        one.record(r);
        const worst_case_result bound = validation::worst_case_of(r);
        ++t.programs;
        EXPECT_LE(bound.at_least, bound.at_most);
        if (!std::isfinite(bound.at_most)) continue;
        ++t.bounded;
        double largest = 0;
        for (const double x : one.numbers[0])
            for (const double y : one.p.inputs == 1 ? std::vector<double>{x} : one.numbers[1]) {
                std::vector<double> at{x};
                if (one.p.inputs == 2) at.push_back(y);
                ++t.inputs;
                largest = std::max(largest, one.check(r, bound, at, one.offsets(at, random)));
            }
        if (largest > 0 && bound.at_most > 0)
            t.log_ratio += std::log2(bound.at_most) - std::log2(largest), ++t.ratios;
    }
}

template <class T>
class WorstCase : public testing::Test {};
using formats = testing::Types<float8_e4m3, float8_e5m2, bfloat16, float16, float, double>;
TYPED_TEST_SUITE(WorstCase, formats);

TYPED_TEST(WorstCase, BoundsHoldForEveryInputOfRandomPrograms) {
    tally t;
    for (const bool with_functions : {false, true})
        for (int part = 0; part < 4; ++part)
            check_random_programs<TypeParam>(static_cast<std::uint64_t>(part + 1),
                                             static_cast<int>(::support::scaled(150u)),
                                             with_functions, t);
    std::printf("%d programs, %d bounded, %llu inputs, geometric mean of bound/largest %.2f\n",
                t.programs, t.bounded, static_cast<unsigned long long>(t.inputs),
                std::exp2(t.log_ratio / std::max(t.ratios, 1)));
    EXPECT_GT(t.bounded, t.programs / 3);
}

constexpr auto quotient = [](const auto& x, const auto& y) { return x / (x + y); };

TEST(WorstCaseOfFunction, IsTightForAQuotient) {
    const worst_case_result e = worst_case<float>(quotient, {{1, 4}, {1, 4}});
    EXPECT_TRUE(e.complete);
    EXPECT_LE(e.at_least, e.at_most);
    EXPECT_LT(e.at_most, 1.05 * e.at_least);
    EXPECT_LE(e.lower, 0.2);
    EXPECT_GE(e.upper, 0.8);
    ASSERT_EQ(e.where.size(), 2u);
    ASSERT_EQ(e.by_operation.contributions.size(), 2u);
    double sum = 0;
    for (const contribution& c : e.by_operation.contributions) sum += c.amount;
    EXPECT_NEAR(sum, e.at_most, 1e-12 * e.at_most);
}

TEST(WorstCaseOfFunction, ComparesRules) {
    const auto f = [](const auto& x, const auto& y) { return x + y + 0.1F; };
    worst_case_options options{.samples = 20'000};
    options.rules.assign(validation::rules().begin(), validation::rules().end());
    options.rules.emplace_back();
    validation::set_expression_checks<validation_test::too_small>(options.rules.back());
    for (const bool rounds : {false, true}) {
        options.round_inputs = rounds;
        const worst_case_result e = worst_case<float>(f, {{1, 4}, {1, 4}}, options);
        ASSERT_EQ(e.by_rule.size(), options.rules.size());
        for (std::size_t i = 0; i < options.rules.size(); ++i) {
            const rule_bound& found = e.by_rule[i];
            EXPECT_EQ(found.rule, options.rules[i].name);
            if (!options.rules[i].promises()) continue;
            const bool is_broken = found.rule == "too_small";
            EXPECT_EQ(found.broken > 0, is_broken) << found.rule;
            EXPECT_TRUE(is_broken || found.largest >= e.at_least) << found.rule;
            EXPECT_TRUE(found.rule != "residual" || found.largest < 1.5 * e.at_most);
        }
    }
    const auto quotients = worst_case<double>(quotient, {{1, 4}, {1, 4}}, options);
    for (const rule_bound& found : quotients.by_rule)
        EXPECT_EQ(std::isfinite(found.largest), found.rule != "safe") << found.rule;
}

// x1·x2 to 225, the second product to 450, three sums to 705: halves of units in the last place.
TEST(WorstCaseOfFunction, AddsHalfUnitsOfARigidBody) {
    const auto rigid_body = [](const auto& x, const auto& y, const auto& z) {
        return -(x * y) - 2 * y * z - x - z;
    };
    const input_range box[] = {{-15, 15}, {-15, 15}, {-15, 15}};
    EXPECT_NEAR(worst_case<double>(rigid_body, box).at_most, 3.75 * 0x1p-44, 1e-3 * 0x1p-44);
    // Rounding of inputs, half a unit of 15 each, reaches the result by 16, 45 and 31.
    EXPECT_NEAR(worst_case<double>(rigid_body, box, {.round_inputs = true}).at_most,
                3.75 * 0x1p-44 + 92 * 0x1p-50, 1e-3 * 0x1p-44);
}

TEST(WorstCaseOfFunction, IsZeroForExactOperations) {
    const auto exact = [](const auto& x) { return abs(4 * x - (x - 1)) / 2; };
    EXPECT_EQ(worst_case<double>(exact, {{1, 1}}).at_most, 0);
    const auto sterbenz = [](const auto& x, const auto& y) { return x - y; };
    EXPECT_EQ(worst_case<float16>(sterbenz, {{3, 5}, {2.5, 6}}).at_most, 0);
}

TEST(WorstCaseOfFunction, CountsErrorsOfInputsAndConstants) {
    const auto identity = [](const auto& x) { return x; };
    EXPECT_NEAR(worst_case<double>(identity, {{1, 2, 0.25}}).at_most, 0.25, 1e-12);
    const auto tenth = [](const auto&) { return recorded::constant("0.1"); };
    const worst_case_result e = worst_case<float>(tenth, {{0, 1}});
    EXPECT_NEAR(e.at_most, 0.1f - 0.1, 1e-16);
    EXPECT_NEAR(e.at_least, 0.1f - 0.1, 1e-16);
}

// 2^-1000 + 2^-1600, whose error no double holds.
TEST(WorstCaseOfFunction, CountsErrorsOfTinyConstants) {
    const std::string text = "0x1." + std::string(149, '0') + "1p-1000";
    const auto scaled = [&](const auto&) { return recorded::constant(text) * 0x1p1000; };
    EXPECT_GE(worst_case<double>(scaled, {{0, 1}}).at_most, 0x1p-600);
}

TEST(WorstCaseOfFunction, CountsUnderflowToZero) {
    const auto product = [](const auto& x) { return x * x * 0x1p1000 * 0x1p1000; };
    EXPECT_GE(worst_case<double>(product, {{0x1p-600, 0x1p-599}}).at_most, 0x1p802);
    const auto quotient = [](const auto& x) { return 0x1p-600 / x * 0x1p1000 * 0x1p1000; };
    EXPECT_GE(worst_case<double>(quotient, {{0x1p600, 0x1p601}}).at_most, 0x1p800);
}

TEST(WorstCaseOfFunction, BoundsRelativeErrorsTooSmallForDoubles) {
    const auto f = [](const auto& x, const auto& y) { return x + y; };
    const worst_case_result e =
        worst_case<double>(f, {{0x1p1000, 0x1p1001, 0x1p-1000}, {0, 0}}, {.relative = true});
    EXPECT_GT(e.at_most, 0);
    EXPECT_GT(e.relative_at_most, 0);
    EXPECT_LT(e.relative_at_most, 1e-300);
}

TEST(WorstCaseOfFunction, DoesNotDecideComparisonsOfUndefinedNumbers) {
    const auto f = [](const auto& x) { return sqrt(x) == sqrt(x) ? x : 1; };
    EXPECT_THROW(worst_case<double>(f, {{-1, 1}}), undecided_comparison);
    EXPECT_EQ(worst_case<double>(f, {{0, 1}}).at_most, 0);
}

TEST(WorstCaseOfFunction, TakesNoInputs) {
    const auto third = [](std::span<const recorded>) { return recorded(1) / 3; };
    const worst_case_result e = worst_case<double>(third, std::span<const input_range>());
    EXPECT_GT(e.at_least, 0);
    EXPECT_LE(e.at_least, e.at_most);
    EXPECT_TRUE(e.where.empty());
}

TEST(WorstCaseOfFunction, IsInfiniteOutsideOfDomains) {
    const auto root = [](const auto& x) { return sqrt(x); };
    EXPECT_EQ(worst_case<double>(root, {{-1, 1}}, {.boxes = 100}).at_most, HUGE_VAL);
    const auto square = [](const auto& x) { return x * x; };
    EXPECT_EQ(worst_case<float16>(square, {{0, 300}}, {.boxes = 100}).at_most, HUGE_VAL);
    const auto angle = [](const auto& y, const auto& x) { return atan2(y, x); };
    EXPECT_EQ(worst_case<double>(angle, {{-1, 1}, {-2, -1}}, {.boxes = 100}).at_most, HUGE_VAL);
}

TEST(WorstCaseOfFunction, HoldsAtEveryLimit) {
    const auto f = [](const auto& x, const auto& y) { return (x * x - y) / (x + y * y); };
    double before = HUGE_VAL;
    for (const std::size_t boxes : {1, 10, 100, 1000}) {
        const worst_case_result e = worst_case<double>(f, {{1, 9}, {1, 5}}, {.boxes = boxes});
        EXPECT_LE(e.at_least, e.at_most);
        EXPECT_LE(e.at_most, before);
        before = e.at_most;
    }
}

TEST(WorstCaseOfFunction, DecidesComparisonsByTheBox) {
    const auto f = [](const auto& x) { return x < 2 ? x + 1 : x * x; };
    EXPECT_LT(worst_case<double>(f, {{0, 1}}).at_most, 0x1p-52);
    EXPECT_GT(worst_case<double>(f, {{4, 5}}).at_most, 0x1p-50);
    EXPECT_THROW(worst_case<double>(f, {{1, 3}}), undecided_comparison);
    EXPECT_THROW(worst_case<double>(f, {{3, 1}}), std::invalid_argument);
    EXPECT_THROW(recorded(1), std::logic_error);
}

}  // namespace
}  // namespace errbound
