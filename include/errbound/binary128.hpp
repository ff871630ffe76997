// IEEE 754 binary128 as errbound::float128: __float128 of GCC and clang on x86, long double on
// AArch64, elsewhere nothing. Needs sqrtf128 and fmaf128, which round once (glibc 2.26).
//   errbound::tracked<errbound::float128> x = 0.1;   // the double, exactly
#pragma once

#include <bit>
#include <cfloat>
#include <cstdint>
#include <errbound/number_traits.hpp>

#if LDBL_MANT_DIG == 113

namespace errbound {
using float128 = long double;
}  // namespace errbound

#elif defined(__SIZEOF_FLOAT128__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__

namespace errbound {

using float128 = __float128;  ///< 113 bits of precision, in software on most processors

template <>
struct number_traits<float128> {
    static constexpr int digits = 113, max_exponent = 16384, min_exponent = -16381;
    static constexpr bool has_infinity = true, has_subnormals = true;

    static constexpr float128 epsilon() { return power_of_two(1 - digits); }
    static constexpr float128 unit_roundoff() { return power_of_two(-digits); }
    static constexpr float128 underflow_unit() { return of({1, 0}); }
    static constexpr float128 smallest_normal() { return power_of_two(min_exponent - 1); }
    static constexpr float128 largest() { return of({~std::uint64_t{0}, infinite - 1}); }
    static constexpr float128 infinity() { return of({0, infinite}); }

    static constexpr float128 abs(const float128& x) { return of(size_of(x)); }
    static constexpr float128(max)(const float128& x, const float128& y) { return x < y ? y : x; }
    static constexpr bool is_finite(const float128& x) { return size_of(x).high < infinite; }
    static float128 sqrt(const float128& x) { return __builtin_sqrtf128(x); }
    static float128 fma(const float128& a, const float128& b, const float128& c) {
        return __builtin_fmaf128(a, b, c);
    }
    /// Multiplies in steps. Only the last step that does not give 0 may round.
    static constexpr float128 scale(const float128& x, int e) {
        constexpr int step = 11000, reach = 4 * step;
        int rest = e < -reach ? -reach : e > reach ? reach : e;
        const int first = rest % step;
        float128 y = x * power_of_two(first);
        for (rest -= first; rest != 0; rest += rest < 0 ? step : -step)
            y *= power_of_two(rest < 0 ? -step : step);
        return y;
    }
    static constexpr int exponent(const float128& x) {
        const int biased = static_cast<int>(size_of(x).high >> fraction_bits_of_high);
        return biased == 0 ? exponent(x * power_of_two(digits)) - digits
                           : biased - (max_exponent - 2);
    }

  private:
    /// Two words, as 32-bit processors have no 128-bit integers.
    struct words {
        std::uint64_t low, high;
    };
    static constexpr int fraction_bits_of_high = 48;
    static constexpr std::uint64_t infinite = std::uint64_t{0x7fff} << fraction_bits_of_high;

    static constexpr float128 of(words x) { return std::bit_cast<float128>(x); }
    static constexpr words size_of(const float128& x) {
        const auto [low, high] = std::bit_cast<words>(x);
        return {low, high & ~(std::uint64_t{1} << 63)};
    }
    static constexpr float128 power_of_two(int e) {
        return of({0, static_cast<std::uint64_t>(e + max_exponent - 1) << fraction_bits_of_high});
    }
};

}  // namespace errbound

#endif
