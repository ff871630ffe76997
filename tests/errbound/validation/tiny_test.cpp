// Number formats of 6 to 8 bits. Every rule passes in every case of them, and rules that are broken
// on purpose fail.
#include <gtest/gtest.h>

#include <cmath>
#include <errbound/validation/tiny_float.hpp>
#include <errbound/validation/validation.hpp>
#include <limits>

#include "tests/errbound/validation/validation_rules.hpp"

namespace {

namespace validation = errbound::validation;
using validation::rule;
using validation::tiny_float;

// E5M2, with 5 bits of exponent and 3 of precision, has the numbers of a half with a short
// fraction.
TEST(TinyFloat, IsAFormatAsIeee754DefinesIt) {
    using tiny = tiny_float<3, 5>;
    using traits = errbound::number_traits<tiny>;
    const validation::tiny_rounding<tiny> nearest(MPFR_RNDN);
    EXPECT_EQ(double(traits::largest()), 57344);
    EXPECT_EQ(double(traits::smallest_normal()), 0x1p-14);
    EXPECT_EQ(double(traits::underflow_unit()), 0x1p-16);
    EXPECT_EQ(double(traits::epsilon()), 0.25);
    EXPECT_EQ(double(traits::infinity()), std::numeric_limits<double>::infinity());
    EXPECT_EQ(double(tiny(1) + tiny(0.125)), 1);       // a tie, to even
    EXPECT_EQ(double(tiny(1.25) + tiny(0.125)), 1.5);  // a tie, to even
    EXPECT_EQ(double(tiny(0x1p-8) * tiny(0x1.8p-8)), 0x1p-15);
    EXPECT_EQ(double(tiny(0x1p-8) * tiny(0x1p-9)), 0);
    EXPECT_EQ(double(tiny(57344) + tiny(4096)), std::numeric_limits<double>::infinity());
    EXPECT_TRUE(std::isnan(double(tiny(0) / tiny(0))));
    EXPECT_EQ(double(traits::scale(tiny(1.75), -16)), 0x1p-15);
    {
        const validation::tiny_rounding<tiny> upwards(MPFR_RNDU);
        EXPECT_EQ(double(tiny(1) + traits::underflow_unit()), 1.25);
        EXPECT_EQ(double(tiny(0x1p-8) * tiny(0x1p-16)), 0x1p-16);
        tiny::clear_flag();
        EXPECT_EQ(double(tiny(-57344) - tiny(57344)), -57344);
        EXPECT_TRUE(tiny::overflowed_unnoticed());
    }
    EXPECT_EQ(double(tiny(1) + traits::underflow_unit()), 1);
}

// Compares with double. A second rounding to 3 bits is harmless after one to 53.
TEST(TinyFloat, OperationsRoundOnceToNearest) {
    using tiny = tiny_float<4, 3>;
    const validation::tiny_rounding<tiny> nearest(MPFR_RNDN);
    const auto same = [](tiny x, double y) {
        return x.code() == tiny(y).code() || (std::isnan(double(x)) && std::isnan(y));
    };
    for (int i = 0; i < tiny::codes; ++i)
        for (int j = 0; j < tiny::codes; ++j) {
            const tiny a = tiny::from_code(i), b = tiny::from_code(j);
            const double x = double(a), y = double(b);
            ASSERT_TRUE(same(a + b, x + y) && same(a - b, x - y)) << x << " " << y;
            ASSERT_TRUE(same(a * b, x * y) && same(a / b, x / y)) << x << " " << y;
        }
}

TEST(Tiny, EveryRuleHolds) {
    validation_test::expect_all_kept(validation::validate_tiny(validation::rules(), 0));
}

TEST(Tiny, BrokenRulesAreCaught) {
    rule broken[2];
    broken[0].name = validation_test::as_printed::name;
    broken[1].name = validation_test::too_small::name;
    validation::set_tiny_checks<validation_test::as_printed>(broken[0]);
    validation::set_tiny_checks<validation_test::too_small>(broken[1]);
    for (const rule& r : broken) {
        const validation::report found = validation::validate_tiny(std::span(&r, 1), 0);
        EXPECT_GT(found.violation_count(), 0U) << r.name;
        ASSERT_FALSE(found.violations.empty());
        EXPECT_NE(found.violations.front().code.find("tiny_float<"), std::string::npos);
    }
}

}  // namespace
