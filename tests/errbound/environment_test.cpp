// The report of floating_point_environment(). (Compiler flags: flags/flags_test.py.)
#include <gtest/gtest.h>

#include <cfenv>
#include <cfloat>
#include <errbound/environment.hpp>
#include <thread>
#if defined(__SSE2__)
#include <pmmintrin.h>
#include <xmmintrin.h>
#endif

namespace {

using errbound::environment_report;
using errbound::floating_point_environment;

// A long double of 106 bits is a pair of doubles.
static_assert(errbound::detail::is_ieee_format<long double> == (LDBL_MANT_DIG != 106));

TEST(Environment, OfTheTestsIsSound) {
    EXPECT_TRUE(floating_point_environment().sound());
}

TEST(Environment, OtherRoundingDirectionsAreReported) {
    for (const int direction : {FE_DOWNWARD, FE_UPWARD, FE_TOWARDZERO}) {
        std::fesetround(direction);
        const environment_report report = floating_point_environment();
        std::fesetround(FE_TONEAREST);
        EXPECT_FALSE(report.nearest_even) << direction;
        EXPECT_FALSE(report.sound()) << direction;
        EXPECT_TRUE(report.sound_in_any_direction()) << direction;
    }
}

#if defined(__SSE2__)
TEST(Environment, FlushedSubnormalsAreReported) {
    const unsigned before = _mm_getcsr();
    for (const unsigned mode : {unsigned{_MM_FLUSH_ZERO_ON}, unsigned{_MM_DENORMALS_ZERO_ON}}) {
        _mm_setcsr(before | mode);
        const environment_report report = floating_point_environment();
        // A new thread inherits the environment; on Windows it starts with the default.
#ifdef _WIN32
        constexpr bool inherits = false;
#else
        constexpr bool inherits = true;
#endif
        bool other_is_sound = inherits;
        std::thread([&] { other_is_sound = floating_point_environment().sound(); }).join();
        _mm_setcsr(before);
        EXPECT_FALSE(report.gradual_underflow) << mode;
        EXPECT_FALSE(report.sound()) << mode;
        EXPECT_EQ(other_is_sound, !inherits) << mode;
    }
    EXPECT_TRUE(floating_point_environment().sound());
}
#endif

}  // namespace
