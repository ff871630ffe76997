// Elementary functions of tracked numbers against MPFR, under every rule and in every format. The
// arguments have bounds, are of every size, or are near ends of domains, poles and zeros.
#include <gtest/gtest.h>
#include <mpfr.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <errbound/binary128.hpp>
#include <errbound/elementary.hpp>
#include <errbound/explain/elementary.hpp>
#include <errbound/small_floats.hpp>
#include <errbound/validation/expression.hpp>
#include <errbound/validation/findings.hpp>
#include <errbound/validation/rule_list.hpp>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "errbound/validation/hard_angles.hpp"
#include "tests/support/scaled.hpp"
#include "tests/support/special_values.hpp"

namespace {

using errbound::elementary_function;
using errbound::number_traits;
using errbound::sign_type;
using errbound::tracked;
using errbound::validation::ball;
using errbound::validation::claim;
using errbound::validation::exactly;
using errbound::validation::expression_input;
using errbound::validation::has_two_arguments;
using errbound::validation::mpfr_number;
using errbound::validation::name_of;
using errbound::validation::named_functions;
using errbound::validation::number_of;

/// Examines functions of two inputs by validation's enclosures.
template <class T, class Rule>
class checker {
    using traits = number_traits<T>;
    using limits = std::numeric_limits<std::conditional_t<std::floating_point<T>, T, float>>;

  public:
    checker() { call_.input_count = 2, call_.operation_count = 1; }

    void run(int count) {
        for (const auto& [f, name] : named_functions)
            for (int k = 0; k < count && !testing::Test::HasFailure(); ++k) {
                call_.inputs = {input(f), has_two_arguments(f) ? input(f) : expression_input()};
                check(f);
            }
        EXPECT_LE(undetermined_, count / 10);
    }

    /// Compares sin, cos and tan of the hard angles of this exponent. Returns their number.
    int hard_angles(int exponent) {
        int cases = 0;
        for (const T angle : errbound::validation::hard_angles<T>(exponent)) {
            call_.inputs[0] = {exactly(cases % 2 == 0 ? angle : -angle)};
            for (const auto f :
                 {elementary_function::sin, elementary_function::cos, elementary_function::tan}) {
                const claim found = check(f);
                // Five units at most, so that the bound is of use, too.
                const T error = number_of<T>(found.error), value = number_of<T>(found.value);
                EXPECT_LE(error, 5 * traits::epsilon() * std::abs(value) * (1 + T(0x1p-10)))
                    << text(f);
                ++cases;
            }
        }
        EXPECT_EQ(undetermined_, 0);
        return cases;
    }

  private:
    claim check(elementary_function f) {
        using errbound::validation::finding, errbound::validation::operation_kind;
        call_.operations[0] = {static_cast<operation_kind>(errbound::validation::first_function +
                                                           static_cast<std::size_t>(f)),
                               0, 1, 0, 0};
        std::array<claim, 3> claims;
        errbound::validation::evaluate<Rule, T>(call_, claims.data());
        finding found = finding::undetermined;
        for (const mpfr_prec_t bits : {300, 2400, 20000}) {
            std::array values{ball(bits), ball(bits), ball(bits)};
            errbound::validation::evaluate(call_, values.data());
            errbound::validation::deviation off;
            if (claims[2].value.is_finite() && values[2].is_defined())
                off.compute(claims[2].value, values[2]);
            found = errbound::validation::compare(claims[2], values[2], off);
            if (found != finding::undetermined) break;
        }
        undetermined_ += found == finding::undetermined;
        if (errbound::validation::is_violation(found)) ADD_FAILURE() << text(f);
        return claims[2];
    }
    std::string text(elementary_function f) const {
        std::string line = std::string(name_of(f)) + " by " + Rule::name + " of";
        for (const auto& x : {call_.inputs[0], call_.inputs[1]})
            line += " " + hexadecimal(x.value) + " ± " + hexadecimal(x.error) + " * " +
                    std::to_string(x.quarters) + "/4";
        return line;
    }

    /// A number that may be in the domain, with a bound or none, and what it stands for.
    expression_input input(elementary_function f) {
        T v = candidate(f);
        while (!traits::is_finite(v)) v = candidate(f);
        if (random_() % 3 == 0) return {exactly(v)};
        const T error = random_() % 8 == 0
                            ? traits::abs(candidate(f))
                            : traits::scale(random_() % 2 ? traits::abs(v) : T(1),
                                            -static_cast<int>(random_() % (traits::digits + 12)));
        if (!traits::is_finite(error)) return {exactly(v)};
        const int quarters =
            random_() % 2 ? (random_() % 2 ? 4 : -4) : static_cast<int>(random_() % 9) - 4;
        return {exactly(v), exactly(error), quarters};
    }
    T candidate(elementary_function f) {
        using enum elementary_function;
        const auto near = [&](double x) {
            T v = static_cast<T>(x);
            const int steps = static_cast<int>(random_() % 5) - 2;
            return T(v * (1 + T(steps) * traits::epsilon()));
        };
        switch (random_() % 6) {
            case 0:
                return near(static_cast<int>(random_() % 9) - 4.0);
            case 1:  // zeros, extremes and poles of the waves
                if constexpr (std::floating_point<T>)
                    if (random_() % 2) return hard_angle();
                return near(1.5707963267948966 * (static_cast<int>(random_() % 2000) - 1000));
            case 2:  // where results overflow, underflow, or no longer change
                return near((random_() % 2 ? 1 : -1) * overflow_of(f));
            case 3:
                return T(static_cast<double>(random_() % 4001) / 1000 - 2);
            default:
                return sized();
        }
    }
    T hard_angle() {
        const int most = std::min(limits::max_exponent, 1024);  // as sized()
        while (hard_angles_.empty())
            hard_angles_ = errbound::validation::hard_angles<T>(
                static_cast<int>(random_() % static_cast<unsigned>(most)));
        const T angle = hard_angles_.back();
        hard_angles_.pop_back();
        return random_() % 2 ? angle : -angle;
    }
    /// No long double is so large or small that sums of them have too many bits.
    T sized() {
        if constexpr (std::is_same_v<T, long double>)
            return std::ldexp(static_cast<T>(special_value<double>(random_)),
                              static_cast<int>(random_() % 21) - 10);
        else
            return special_value<T>(random_);
    }
    static double overflow_of(elementary_function f) {
        const double log2 = limits::max_exponent;
        return f == elementary_function::exp2 ? log2 : log2 * 0.6931471805599453;
    }

    std::mt19937_64 random_{21};
    std::vector<T> hard_angles_;
    errbound::validation::expression call_;
    int undetermined_ = 0;
};

using rules = errbound::rule_types<errbound::tight, errbound::sharp, errbound::safe,
                                   errbound::interval, errbound::residual>;

template <class T>
class ElementaryFunctions : public testing::Test {};
using numbers = testing::Types<double, float, long double, errbound::float16, errbound::bfloat16,
                               errbound::float8_e5m2, errbound::float8_e4m3>;
TYPED_TEST_SUITE(ElementaryFunctions, numbers);

TYPED_TEST(ElementaryFunctions, HoldTheExactResult) {
    errbound::for_each_rule(
        rules(), []<class Rule>() { checker<TypeParam, Rule>().run(support::scaled(300)); });
}

template <class Rule>
class ElementaryFunctionsOfDoubles : public testing::Test {
  public:
    using number = tracked<double, Rule>;
};
template <class... Rules>
testing::Types<Rules...> types_of(errbound::rule_types<Rules...>);
using types = decltype(types_of(rules()));
TYPED_TEST_SUITE(ElementaryFunctionsOfDoubles, types);

TYPED_TEST(ElementaryFunctionsOfDoubles, AreExactAtSomeArguments) {
    using number = typename TestFixture::number;
    const number zero(0), one(1);
    for (const number& x : {exp(zero), exp2(zero), cos(zero), cosh(zero), pow(number(5), zero),
                            pow(one, number::within(3, 1)), pow(zero, zero)}) {
        EXPECT_EQ(x.value(), 1);
        EXPECT_EQ(x.error(), 0);
    }
    for (const number& x :
         {expm1(zero), log(one), log2(one), log10(one), log1p(zero), sin(zero), tan(zero),
          asin(zero), acos(one), atan(zero), sinh(zero), tanh(zero), asinh(zero), acosh(one),
          atanh(zero), cbrt(zero), atan2(zero, number::within(2, 1)), pow(zero, number(0.5))})
        EXPECT_EQ(sign_of(x), sign_type::zero);
    EXPECT_EQ(exp2(number(-1074)).error(), 0);
    EXPECT_EQ(sign_of(exp2(number(-1074))), sign_type::positive);
    EXPECT_NE(exp2(number(-1075)).error(), 0);
    EXPECT_NE(exp2(number(0.5)).error(), 0);
    EXPECT_EQ(log2(number(0x1p-1074)).value(), -1074);
    EXPECT_EQ(log2(number(0x1p-1074)).error(), 0);
    EXPECT_EQ(cbrt(number(8)).error(), 0);
    EXPECT_EQ(cbrt(number(-8)).value(), -2);
    EXPECT_NE(cbrt(number(9)).error(), 0);
    EXPECT_EQ(pow(number::within(3, 0.5), number(1)).value(), 3);
}

template <class... Number>
void expect_unknown(const Number&... x) {
    const auto check = [](const auto& y) {
        EXPECT_FALSE(std::isfinite(y.value()) && std::isfinite(y.error())) << y.value();
        EXPECT_EQ(sign_of(y), sign_type::uncertain) << y.value();
    };
    (check(x), ...);
}

TYPED_TEST(ElementaryFunctionsOfDoubles, HaveInfiniteErrorsOutsideOfDomainsAndAtPoles) {
    using number = typename TestFixture::number;
    const auto about = [](double v, double e) { return number::within(v, e); };
    expect_unknown(
        log(number(0)), log(number(-1)), log2(about(1, 1)), log10(about(1, 2)), log1p(number(-1)),
        log1p(about(0, 1)), asin(number(1.5)), asin(about(1, 0x1p-60)), acos(about(-1, 0x1p-1074)),
        acosh(about(1, 0x1p-1074)), acosh(number(0.5)), atanh(number(1)), atanh(about(0.5, 0.5)),
        tan(about(1.5, 0.1)), tan(about(0, 1.6)), tan(about(0, 1e300)),
        pow(number(-8), number(1.5)), pow(about(-8, 1), about(2, 0.1)), pow(number(0), number(-1)),
        pow(about(0, 1), number(0.5)), pow(about(1, 2), number(-2)), atan2(number(0), number(0)),
        atan2(about(1, 1), about(1, 1)), exp(number(1000)), exp(about(700, 100)),
        pow(number(10), number(400)), sinh(about(0, 1e9)));
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity}) {
        const number x(bad), one(1), wide = number::within(1, std::abs(bad));
        expect_unknown(exp(x), log(x), sin(x), atan(x), tanh(x), cbrt(x), pow(x, number(0)),
                       pow(one, x), atan2(one, x), sin(wide), atan(wide));
    }
}

TYPED_TEST(ElementaryFunctionsOfDoubles, HaveFiniteErrorsUpToTheEndsOfDomains) {
    using number = typename TestFixture::number;
    const auto about = [](double v, double e) { return number::within(v, e); };
    EXPECT_TRUE(std::isfinite(asin(number(1)).error()));
    EXPECT_TRUE(std::isfinite(log1p(about(-0.5, 0.25)).error()));
    // Only for rules that do not enlarge the error of an input.
    if (about(0.5, 0.5).error() == 0.5 && about(1.5, 0.5).error() == 0.5) {
        EXPECT_TRUE(std::isfinite(acos(about(0.5, 0.5)).error()));
        EXPECT_TRUE(std::isfinite(acosh(about(1.5, 0.5)).error()));
    }
}

/// The slope of a function of one number at v, to a ten-thousandth; not finite at ends of domains.
template <elementary_function F>
double slope_at(double v) {
    const auto at = [](double x) {
        return errbound::detail::function_of<F>(tracked<double>(x)).value();
    };
    return std::abs(at(v + 0x1p-7) - at(v - 0x1p-7)) * 0x1p6;
}

TYPED_TEST(ElementaryFunctionsOfDoubles, HaveErrorsNearTheSmallestPossible) {
    using number = typename TestFixture::number;
    // |f'(x)|e, and the C library's error: less than 6ε|f(x)|. The rules add up to 3ε|f(x)|.
    int tried = 0;
    const auto expect = [&](const number& r, double slope, const number& x) {
        const double change = slope * x.error();
        EXPECT_LE(r.error(), 1.001 * change + 9 * 0x1p-52 * std::abs(r.value())) << r.value();
        EXPECT_GE(r.error(), 0.999 * change) << r.value();
        ++tried;
    };
    for (const double e : {0x1p-20, 0x1p-40, 0x1p-52, 0x1p-70}) {
        const auto about = [e](double v) { return number::within(v, e); };
        const number two = about(2), three = about(3);
        for (const auto& [f, name] : named_functions)
            for (const double v : {-600.0, -0.5, 0.5, 1.0, 2.0, 3.0, 600.0, 1e5})
                errbound::validation::with_function(f, [&]<elementary_function F>() {
                    if constexpr (!has_two_arguments(F)) {
                        const double slope = slope_at<F>(v);
                        if (std::isfinite(slope))
                            expect(errbound::detail::function_of<F>(about(v)), slope, about(v));
                    }
                });
        expect(pow(two, number(3.5)), 3.5 * std::pow(2, 2.5), two);
        expect(pow(number(2), three), std::log(2) * 8, three);
        expect(atan2(three, number(4)), 4.0 / 25, three);
        expect(atan2(number(4), three), 4.0 / 25, three);
        expect(atan2(three, 4), 4.0 / 25, three);
        expect(atan2(4, three), 4.0 / 25, three);
    }
    EXPECT_GT(tried, 4 * 100);
    // At an extreme of the second order; at most the range.
    EXPECT_LE(cos(number::within(0, 0x1p-20)).error(), 1.01 * 0x1p-41);
    EXPECT_LE(sin(number::within(0.5, 1e10)).error(), 1.4795);
    EXPECT_LE(atan2(number::within(0, 1), number::within(-5, 1)).error(), 6.2832);
    EXPECT_LE(cbrt(number::within(0, 1)).error(), 1.0001);
    EXPECT_LE(pow(number::within(0, 1), number(3)).error(), 1.0001);
}

TYPED_TEST(ElementaryFunctionsOfDoubles, IgnoreTheSignOfZero) {
    using number = typename TestFixture::number;
    const number angle = atan2(number(-0.0), number(-1));
    EXPECT_GE(angle.error(), std::abs(angle.value() - M_PI));
    EXPECT_LE(atan2(number(0.0), number(-1)).error(), 0x1p-48);
}

TYPED_TEST(ElementaryFunctionsOfDoubles, OfLargeAnglesNearMultiplesOfHalfPiHoldTheExactResult) {
    // Results of glibc 2.36 are off by up to 136,921 units in the last place: its reduction of
    // large angles has an absolute error. The exact results are MPFR's, rounded to nearest.
    using number = typename TestFixture::number;
    const auto expect = [](const number& x, double exact) {
        const double unit = 0x1p-52 * std::abs(exact);
        EXPECT_LE(std::abs(x.value() - exact), unit);
        EXPECT_GE(x.error(), std::abs(x.value() - exact));
        EXPECT_LE(x.error(), 4.5 * unit);
        EXPECT_EQ(sign_of(x), exact < 0 ? sign_type::negative : sign_type::positive);
    };
    expect(cos(number(0x1.69eab0985179bp+246)), -0x1.61ecec9c577fdp-58);
    expect(sin(number(0x1.4c96c11134d36p+578)), -0x1.6ec67bcf77522p-58);
    expect(sin(number(0x1.b951f1572eba5p+26)), -0x1.f54f5227a4e84p-57);
    expect(tan(number(0x1.69eab0985179bp+246)), 0x1.72567cb9047a9p+57);
    expect(cos(number(0x1.6ac5b262ca1ffp+849)), -0x1.14ae72e6ba22fp-61);
    expect(sin(number(1e22)), -0x1.b453ab76bf397p-1);
    // The slope is 1 + tan². Rules with relative errors enlarge the error of the input.
    const number near_pole = number::within(0x1.69eab0985179bp+246, 0x1p-70);
    const double tangent = 0x1.72567cb9047a9p+57;
    if (near_pole.error() == 0x1p-70) {
        EXPECT_LE(tan(near_pole).error(), 1.1 * 0x1p-70 * tangent * tangent);
    }
    EXPECT_FALSE(std::isfinite(tan(number::within(0x1.69eab0985179bp+246, 0x1p-56)).error()));
}

template <class T>
class HardAngles : public testing::Test {};
using hard_angle_numbers = testing::Types<float, double, long double>;
TYPED_TEST_SUITE(HardAngles, hard_angle_numbers);

TYPED_TEST(HardAngles, OfEveryExponentHoldTheExactResult) {
    using traits = number_traits<TypeParam>;
    checker<TypeParam, errbound::tight> all;
    int cases = 0;
    for (int e = 0; e < std::min(traits::max_exponent, 1024); ++e) cases += all.hard_angles(e);
    // The larger exponents are only of long double. A scale of 64 tries all of them, in minutes.
    const int step = std::max(64 / support::scaled(1), 1);
    for (int e = 1024; e < traits::max_exponent; e += step) cases += all.hard_angles(e);
    EXPECT_GT(cases, 20 * std::min(traits::max_exponent, 1024));
    testing::Test::RecordProperty("cases", cases);
}

template <class T>
class AngleReduction : public testing::Test {
  public:
    /// Compares an angle with its quadrant and remainder.
    void check(T x) {
        const auto reduced = errbound::detail::angle_reduction<T>::of(x);
        set_exactly(difference_.get(), x);
        mpfr_div(turns_.get(), difference_.get(), half_pi_.get(), MPFR_RNDN);
        mpfr_rint(turns_.get(), turns_.get(), MPFR_RNDN);
        mpfr_fms(difference_.get(), turns_.get(), half_pi_.get(), difference_.get(), MPFR_RNDN);
        for (const T part : {reduced.high, reduced.low}) {
            set_exactly(part_.get(), part);
            mpfr_add(difference_.get(), difference_.get(), part_.get(), MPFR_RNDN);
        }
        set_exactly(part_.get(), reduced.error);
        ASSERT_LE(mpfr_cmpabs(difference_.get(), part_.get()), 0);
        const T small = number_traits<T>::epsilon() * T(0x1p-16);
        ASSERT_TRUE(reduced.error <= small * number_traits<T>::abs(reduced.high));
        mpfr_fmod_ui(turns_.get(), turns_.get(), 4, MPFR_RNDN);
        ASSERT_EQ(mpfr_get_si(turns_.get(), MPFR_RNDN), reduced.quadrant);
    }

  private:
    static void set_exactly(mpfr_ptr to, T x) {
        const int exponent = x == 0 ? 0 : number_traits<T>::exponent(x);
        T rest = number_traits<T>::scale(x, -exponent);
        mpfr_set_zero(to, 1);
        for (; rest != 0; rest -= static_cast<T>(static_cast<double>(rest)))
            mpfr_add_d(to, to, static_cast<double>(rest), MPFR_RNDN);
        mpfr_mul_2si(to, to, exponent, MPFR_RNDN);
    }

    static constexpr mpfr_prec_t precision = number_traits<T>::max_exponent + 600;
    mpfr_number half_pi_ = [] {
        mpfr_number x(precision);
        mpfr_const_pi(x.get(), MPFR_RNDN);
        mpfr_div_2ui(x.get(), x.get(), 1, MPFR_RNDN);
        return x;
    }();
    mpfr_number difference_{precision}, turns_{precision}, part_{precision};
};
using reduced_numbers = testing::Types<float, double, long double
#ifdef __SIZEOF_FLOAT128__
                                       ,
                                       errbound::float128
#endif
                                       >;
TYPED_TEST_SUITE(AngleReduction, reduced_numbers);

TYPED_TEST(AngleReduction, HasTheRemainderOfHardAngles) {
    constexpr int most = number_traits<TypeParam>::max_exponent;
    for (int e = 20; e<most; e += most> 1024 ? 256 : 4)
        for (const TypeParam x : errbound::validation::hard_angles<TypeParam>(e))
            if (x >= TypeParam(0x1p20)) this->check(x);
    this->check(number_traits<TypeParam>::largest());
}

TEST(DigitsOfPi, AreThoseOfMpfr) {
    constexpr int digits = 64 * static_cast<int>(errbound::detail::two_over_pi.size());
    mpfr_number pi(digits + 64), x(digits + 64);
    mpfr_const_pi(pi.get(), MPFR_RNDN);
    const auto expect_digits = [&x](const auto& words) {
        for (const std::uint64_t word : words) {
            for (const std::uint64_t half : {word >> 32, word & 0xffffffff}) {
                mpfr_mul_2ui(x.get(), x.get(), 32, MPFR_RNDN);
                EXPECT_EQ(mpfr_get_ui(x.get(), MPFR_RNDZ), half);
                mpfr_frac(x.get(), x.get(), MPFR_RNDN);
            }
        }
    };
    mpfr_ui_div(x.get(), 2, pi.get(), MPFR_RNDN);
    expect_digits(errbound::detail::two_over_pi);
    mpfr_div_2ui(x.get(), pi.get(), 3, MPFR_RNDN);
    expect_digits(errbound::detail::half_pi);
}

TEST(ElementaryFunctions, OfNoneAreThoseOfPlainArithmetic) {
    using number = tracked<double, errbound::none>;
    EXPECT_EQ(exp(number(2)).value(), std::exp(2.0));
    EXPECT_EQ(pow(number(2), 0.5).value(), std::pow(2, 0.5));
    EXPECT_EQ(sign_of(log(number(-1))), sign_type::uncertain);
    EXPECT_EQ(tan(tracked<float, errbound::none>(1)).value(), std::tan(1.0F));
}

TEST(Powers, WithBuiltInIntegersAreProducts) {
    const tracked<double> x = 3;
    EXPECT_EQ(pow(x, 2).error(), (x * x).error());
    EXPECT_EQ(pow(x, 0.5).value(), std::sqrt(3.0));
    EXPECT_EQ(pow(2, x).value(), 8);
    EXPECT_EQ(pow(tracked<float>(4.0F), 0.5).value(), 2);
}

TEST(PlainArguments, OfOtherTypesAreWithinTheErrorOfTheirConversion) {
    const tracked<float> one = -1, two = 2, hundred = 100, least = 0x1p-149F;
    // 2^24 + 1 is no float, and odd.
    EXPECT_EQ(sign_of(pow(one, 16777217.0)), sign_type::uncertain);
    EXPECT_EQ(sign_of(pow(one, 16777217L)), sign_type::uncertain);
    EXPECT_EQ(sign_of(pow(tracked<double>(-1), 9007199254740993L)), sign_type::uncertain);
    EXPECT_EQ(sign_of(pow(one, 16777215.0)), sign_type::negative);
    const auto expect_within = [](const auto& x, double truth) {
        EXPECT_LE(std::abs(double(x.value()) - truth), double(x.error()) * (1 + 1e-12)) << truth;
        EXPECT_LE(double(x.error()), 1e-3 * truth);
    };
    expect_within(pow(two, 100.1), std::pow(2.0, 100.1));
    expect_within(pow(1.1, hundred), std::pow(1.1, 100.0));
    expect_within(pow(tracked<errbound::float16>(2), 0.1), std::pow(2.0, 0.1));
    expect_within(pow(tracked<float, errbound::explained<errbound::tight>>(2), 100.1),
                  std::pow(2.0, 100.1));
    expect_within(atan2(tracked<float>(1), 0.1), std::atan2(1.0, 0.1));
    expect_within(atan2(0.1, tracked<float>(1)), std::atan2(0.1, 1.0));
    EXPECT_GE(atan2(least, 2e-45).error(), 0.17F);
    EXPECT_EQ(pow(two, 4.0).error(), pow(two, tracked<float>(4)).error());
}

}  // namespace
