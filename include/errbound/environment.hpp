// Checks the compiler and the floating-point environment. Compiler flags: docs/guarantees.md.
// Needed: IEEE 754 binary formats with gradual underflow, operations rounded once to the format, no
// value-changing optimisation. The rules `tight` and `safe`, and the methods of ccd with these
// names, hold in any rounding direction. The other rules and methods, predicates, error-free
// transformations and certified_solve need rounding to nearest. Contraction to fused multiply-add
// does not affect tracked numbers (rounded.hpp). Other code differs between machines without
// -ffp-contract=off.
#pragma once

#include <cfloat>
#include <cmath>
#include <limits>

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__) || \
    defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || defined(_M_FP_FAST)
#error "errbound: -ffast-math and its parts void every error bound; compile without them"
#endif

#if defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD != 0
#error \
    "errbound: operations must round to their own type (FLT_EVAL_METHOD 0); on x86 without -mfpmath=387, -ffp-eval-method and parts of -ffast-math, on i386 with -msse2 -mfpmath=sse"
#endif

static_assert(std::numeric_limits<double>::is_iec559 && std::numeric_limits<float>::is_iec559,
              "errbound: float and double must be IEEE 754 binary formats");
static_assert(sizeof(0.1) == sizeof(double) && 0.1 != static_cast<double>(0.1F),
              "errbound: constants must be doubles; compile without -fsingle-precision-constant");

#if (defined(__linux__) || defined(__MINGW32__)) && !defined(__ANDROID__) && \
    (defined(__x86_64__) || defined(__i386__))  // Android's have 64 or 128 bits
static_assert(std::numeric_limits<long double>::digits == 64,
              "errbound: long doubles must be those of the C library; compile without "
              "-mlong-double-64 and -mlong-double-128");
#endif

namespace errbound {
namespace detail {

/// False for a pair of doubles (long double on some PowerPC), which libstdc++ reports as iec559.
template <class T>
constexpr bool is_ieee_format = [] {
    constexpr int digits_of_pair = 2 * std::numeric_limits<double>::digits;
    return std::numeric_limits<T>::is_iec559 && std::numeric_limits<T>::digits != digits_of_pair;
}();

}  // namespace detail

/// The calling thread's floating-point environment and the compiler's treatment of the calling
/// unit. Tested at run time: compilers do not reveal every flag, and some flags set flush-to-zero
/// at start-up. Covers float, double and long double (no subnormals, no pair of doubles).
struct environment_report {
    bool gradual_underflow;  ///< subnormals are neither flushed nor read as zero
    bool as_written;         ///< sums in the written order, with the type's bits, no more
    bool all_bits;           ///< no fewer bits: x87 may be set to round long doubles
    bool own_quotients;      ///< quotients are rounded once, not products with reciprocals
    bool special_values;     ///< infinity and NaN are distinguished from numbers
    bool nearest_even;       ///< default rounding direction

    /// True if the bounds of `tight` and `safe` hold.
    constexpr bool sound_in_any_direction() const {
        return gradual_underflow && as_written && all_bits && own_quotients && special_values;
    }
    /// True if every guarantee of the library holds.
    constexpr bool sound() const { return sound_in_any_direction() && nearest_even; }
};

/// Static: the single copy of an inline function might come from a unit with other flags.
namespace detail {

template <class T>
static T unknown(T x) {
    volatile T v = x;
    return v;
}
/// Tests the processor and the compiler's constant folding.
template <class T>
static bool has_gradual_underflow() {
    using limits = std::numeric_limits<T>;
    const T subnormal = unknown(unknown((limits::min)()) * unknown(T(0.5)));
    const T factors[] = {limits::denorm_min(), T(4)};
    return unknown(subnormal + subnormal) == (limits::min)() && unknown(limits::denorm_min()) > 0 &&
           unknown(factors[0] * factors[1]) > 0;
}
template <class T>
static bool computes_as_written() {
    constexpr T epsilon = std::numeric_limits<T>::epsilon();
    const T x = unknown(T(1)), y = unknown(epsilon / 4);
    const T sum = x + y, y_in_sum = sum - x;
    const T stored = unknown(x + y), stored_y = unknown(stored - x);
    bool same = unknown(sum - x) == stored_y &&
                unknown((x - (sum - y_in_sum)) + (y - y_in_sum)) ==
                    unknown(unknown(x - unknown(stored - stored_y)) + unknown(y - stored_y));
    T terms[64];  // the loop over them may be vectorised
    for (T& term : terms) term = y;
    terms[0] = x;
    T in_order = 0, total = 0;
    for (const T& term : terms) total += term;
    for (const T& term : terms) in_order = unknown(in_order + unknown(term));
    return same && total == in_order;
}
template <class T>
static bool has_all_bits() {
    constexpr T epsilon = std::numeric_limits<T>::epsilon();
    return unknown(unknown(T(1)) + unknown(epsilon)) - 1 == epsilon;
}
/// Products with reciprocals of 41 or 49 would not be whole, in double or float.
template <class T>
static bool divides_once() {
    const auto whole = [](T divisor, const auto& quotient) {
        T numerators[8], quotients[8];
        for (int k = 0; k < 8; ++k) numerators[k] = unknown(T(k + 1) * divisor);
        for (int k = 0; k < 8; ++k) quotients[k] = quotient(numerators[k]);
        bool right = true;
        for (int k = 0; k < 8; ++k) right = right && unknown(quotients[k]) == T(k + 1);
        return right;
    };
    const T a = unknown(T(41)), b = unknown(T(49));
    return whole(41, [a](T x) { return x / a; }) && whole(41, [](T x) { return x / T(41); }) &&
           whole(49, [b](T x) { return x / b; }) && whole(49, [](T x) { return x / T(49); });
}
template <class T>
static bool distinguishes_special_values() {
    using limits = std::numeric_limits<T>;
    const T infinity = unknown(limits::infinity()), nothing = infinity - infinity;
    return std::isinf(infinity) && std::isnan(nothing) && infinity > (limits::max)() &&
           !(infinity <= (limits::max)()) && !(nothing == nothing) && !(nothing <= 0) &&
           !(nothing >= 0) && nothing != 0;
}
template <class T>
static bool rounds_to_nearest() {
    constexpr T epsilon = std::numeric_limits<T>::epsilon();
    const T one = unknown(T(1)), quarter = unknown(epsilon / 4);
    return unknown(one + 3 * quarter) == 1 + epsilon && unknown(one + quarter) == 1;
}

}  // namespace detail

/// Reports on the calling thread and unit: assert .sound() once in each unit compiled with its own
/// flags. Cost: some microseconds.
static inline environment_report floating_point_environment() {
    using namespace detail;
    const auto of_all = [](const auto& check) {
        bool all = check(float()) && check(double());
        if constexpr (is_ieee_format<long double>) all = all && check(0.0L);
        return all;
    };
    return {has_gradual_underflow<float>() && has_gradual_underflow<double>(),
            of_all([](auto x) { return computes_as_written<decltype(x)>(); }),
            of_all([](auto x) { return has_all_bits<decltype(x)>(); }),
            of_all([](auto x) { return divides_once<decltype(x)>(); }),
            of_all([](auto x) { return distinguishes_special_values<decltype(x)>(); }),
            of_all([](auto x) { return rounds_to_nearest<decltype(x)>(); })};
}

}  // namespace errbound
