// What the library needs of the compiler and the floating-point environment, checked where it can
// be.
//
// Needed: IEEE 754 binary formats with gradual underflow, operations rounded once to the format
// (any rounding direction for `tight` and `safe`; to nearest for `sharp`, `interval`, `residual`
// and error-free transformations), and no value-changing optimisation. Contraction to fused
// multiply-add does not reach the values and bounds of tracked numbers (rounded.hpp); in SIMD packs
// and plain floating-point code it makes results differ between machines: build with
// -ffp-contract=off for identical results everywhere.
#pragma once

#include <cfloat>
#include <limits>

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__) || \
    defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || defined(_M_FP_FAST)
#error "errbound: -ffast-math and its parts void every error bound; compile without them"
#endif

#if defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD != 0
#error \
    "errbound: operations must round to their own type (FLT_EVAL_METHOD 0); use -msse2 -mfpmath=sse"
#endif

static_assert(std::numeric_limits<double>::is_iec559 && std::numeric_limits<float>::is_iec559,
              "errbound: float and double must be IEEE 754 binary formats");

namespace errbound {

/// What the calling thread's floating-point environment does. Compilers do not tell of every flag
/// (flush-to-zero is set at start-up by code that other flags link in), so this one is asked at
/// run time: a program that cares asserts `floating_point_environment().sound()` once.
struct environment_report {
    bool gradual_underflow;  ///< subnormals are neither flushed nor read as zero
    bool no_reassociation;   ///< (a + b) − a is computed as written
    bool nearest_even;       ///< default rounding; bounds hold in every mode, results differ

    /// Every bound rule that promises one keeps it.
    constexpr bool sound() const { return gradual_underflow && no_reassociation; }
};

inline environment_report floating_point_environment() {
    // volatile: the compiler must not answer for the machine.
    volatile double smallest_normal = std::numeric_limits<double>::min();
    volatile double half = 0.5, one = 1, tiny = std::numeric_limits<double>::epsilon() / 4;
    volatile double subnormal = smallest_normal * half;
    volatile double restored = subnormal + subnormal;
    const double x = one, y = tiny;
    volatile double lost = (x + y) - x;
    volatile double up = one + 3 * tiny, down = one + tiny;
    return {restored == smallest_normal, lost != y,
            up == 1 + std::numeric_limits<double>::epsilon() && down == 1};
}

}  // namespace errbound
