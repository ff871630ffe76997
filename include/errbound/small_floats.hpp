// Number formats of 8 and 16 bits: binary16, bfloat16, and the Open Compute Project's E5M2 and
// E4M3. Storage types with arithmetic, also in constant expressions and device code.
//   errbound::float16 x(0.1);                       // the nearest one: 0.1 is rounded once
//   const float wide(x * x);                        // exact
//   errbound::tracked<errbound::bfloat16> y(...);   // with a bound
//
// Conversions from float and double, and operations, round once, to nearest even. E4M3 has no
// infinities: results above 448 are NaN (no saturation, which a bound would not notice). Source:
// OCP 8-bit Floating Point Specification (OFP8), 1.0, 2023.
#pragma once

#include <bit>
#include <cmath>
#include <compare>
#include <concepts>
#include <cstdint>
#include <errbound/detail/power_of_two.hpp>
#include <errbound/error_free.hpp>
#include <errbound/number_traits.hpp>
#include <limits>
#include <type_traits>

namespace errbound {

/// IEEE 754 layout with gradual underflow. Without infinities, the all-ones code is NaN, and the
/// other codes of the largest exponent are numbers.
template <int Precision, int ExponentBits, bool HasInfinity = true>
class small_float {
    static_assert(Precision + ExponentBits == 8 || Precision + ExponentBits == 16,
                  "errbound: a small_float has 8 or 16 bits");
    static_assert(Precision >= 3 && 2 * Precision + 2 <= std::numeric_limits<float>::digits &&
                      ExponentBits >= 2 && ExponentBits <= 8,
                  "errbound: a small_float needs 3 to 11 bits of precision and float's "
                  "exponents, or operations in float round twice");

  public:
    static constexpr int precision = Precision, exponent_bits = ExponentBits;
    static constexpr int bits = Precision + ExponentBits, codes = 1 << bits;
    using code_type = std::conditional_t<bits == 8, std::uint8_t, std::uint16_t>;

    /// 2^least_exponent is the smallest normal number.
    static constexpr int least_exponent = 2 - (1 << (ExponentBits - 1));
    static constexpr int largest_code =
        HasInfinity ? (((1 << ExponentBits) - 1) << (Precision - 1)) - 1 : codes / 2 - 2;
    static constexpr int overflow_code = largest_code + 1;  ///< infinity, or NaN without infinities
    static constexpr int nan_code = codes / 2 - 1;

    constexpr small_float() = default;
    /// The nearest; above the largest number, infinity or NaN (overflow_code).
    template <std::floating_point Source>
    requires(sizeof(Source) <= sizeof(double)) constexpr explicit small_float(Source value)
        : code_(nearest_code(value)) {}
    template <int OtherPrecision, int OtherBits, bool OtherInfinity>
    constexpr explicit small_float(small_float<OtherPrecision, OtherBits, OtherInfinity> value)
        : small_float(static_cast<float>(value)) {}
    /// Implicit, for constants; the nearest, as above.
    template <std::integral Source>
    constexpr small_float(Source value) : small_float(as_double(value)) {}
    static constexpr small_float from_code(int code) {
        small_float x;
        x.code_ = static_cast<code_type>(code);
        return x;
    }
    constexpr int code() const { return code_; }
    /// Exact for floating-point types; otherwise converts as float does.
    template <class Target>
    requires std::is_arithmetic_v<Target>
    constexpr explicit operator Target() const { return static_cast<Target>(as_float()); }

    // Operations are float's, rounded to the format. For p bits, 2p + 2 <= 24 makes double rounding
    // of + − × ÷ √ innocuous (Figueroa 1995). Only bfloat16's operations make float underflow. Then
    // sums are exact; a product of 8-bit significands is exact or below half of the smallest
    // number; no quotient is within 2^-17 of the smallest number from a tie without being one.
    // Tests compare all 8-bit pairs with rationals, all 16-bit pairs with exact midpoints.
    friend constexpr small_float operator+(small_float a, small_float b) {
        return small_float(a.as_float() + b.as_float());
    }
    friend constexpr small_float operator-(small_float a, small_float b) {
        return small_float(a.as_float() - b.as_float());
    }
    friend constexpr small_float operator*(small_float a, small_float b) {
        return small_float(a.as_float() * b.as_float());
    }
    friend constexpr small_float operator/(small_float a, small_float b) {
        return small_float(a.as_float() / b.as_float());
    }
    constexpr small_float operator-() const { return from_code(code_ ^ (codes / 2)); }
    constexpr small_float& operator+=(small_float b) { return *this = *this + b; }
    constexpr small_float& operator-=(small_float b) { return *this = *this - b; }
    constexpr small_float& operator*=(small_float b) { return *this = *this * b; }
    constexpr small_float& operator/=(small_float b) { return *this = *this / b; }
    friend constexpr bool operator==(small_float a, small_float b) {
        return a.as_float() == b.as_float();
    }
    friend constexpr std::partial_ordering operator<=>(small_float a, small_float b) {
        return a.as_float() <=> b.as_float();
    }

  private:
    /// The integer, or one of 46 to 53 bits that rounds equally, because its last bit is sticky.
    template <class Source>
    static constexpr double as_double(Source value) {
        constexpr int digits = std::numeric_limits<double>::digits;
        if constexpr (std::numeric_limits<Source>::digits <= digits) {
            return static_cast<double>(value);
        } else {
            using size_type = std::make_unsigned_t<Source>;
            auto size = static_cast<size_type>(value);
            if (value < 0) size = static_cast<size_type>(0 - size);
            double unit = value < 0 ? -1 : 1;
            for (; size >> digits != 0; unit *= 256) size = (size >> 8) | (size % 256 != 0 ? 1 : 0);
            return unit * static_cast<double>(size);
        }
    }
    /// ⌊m/2^shift⌉, ties to even; 1 <= shift.
    template <class Bits>
    static constexpr Bits shifted(Bits m, int shift) {
        return (m + (Bits{1} << (shift - 1)) - 1 + ((m >> shift) & 1)) >> shift;
    }
    /// Works on the source's bits; a carry out of the fraction correctly enters the exponent.
    template <class Source>
    static constexpr code_type nearest_code(Source value) {
        using bits_of_source =
            std::conditional_t<sizeof(Source) == sizeof(float), std::uint32_t, std::uint64_t>;
        constexpr int fraction = std::numeric_limits<Source>::digits - 1;
        constexpr int bias = std::numeric_limits<Source>::max_exponent - 1;
        constexpr int top = 8 * static_cast<int>(sizeof(Source)) - 1;
        constexpr auto one = bits_of_source{1};
        const auto all = std::bit_cast<bits_of_source>(value);
        const bits_of_source size = all & ((one << top) - 1);
        const int sign = static_cast<int>(all >> top) << (bits - 1);
        if (size > (bits_of_source{2 * bias + 1} << fraction))
            return static_cast<code_type>(sign | nan_code);
        // The source's subnormals round to 0, except for bfloat16, which has float's exponents.
        const int below = least_exponent + bias - static_cast<int>(size >> fraction);
        bits_of_source units = 0;
        if (below <= 0 || least_exponent == 1 - bias)
            units = shifted<bits_of_source>(
                size - (static_cast<bits_of_source>(least_exponent + bias - 1) << fraction),
                fraction + 1 - Precision);
        else if (below <= Precision)
            units = shifted<bits_of_source>((size & ((one << fraction) - 1)) | (one << fraction),
                                            fraction + 1 - Precision + below);
        const int code = units > overflow_code ? overflow_code : static_cast<int>(units);
        return static_cast<code_type>(sign | code);
    }

    constexpr float as_float() const {
        constexpr int spare = std::numeric_limits<float>::digits - Precision;
        constexpr int bias = std::numeric_limits<float>::max_exponent - 1;
        const std::uint32_t size = code_ & (codes / 2 - 1);
        const std::uint32_t sign = static_cast<std::uint32_t>(code_ >> (bits - 1)) << 31;
        std::uint32_t of_float = size << spare;
        if (size > largest_code) {
            const bool infinite = HasInfinity && size == overflow_code;
            of_float = infinite ? 0x7f800000U : 0x7fc00000U;
        } else if (least_exponent != 1 - bias) {
            constexpr auto rebias = static_cast<std::uint32_t>(least_exponent + bias - 1);
            if (size >> (Precision - 1) == 0) {
                constexpr auto unit =
                    static_cast<float>(detail::power_of_two(least_exponent + 1 - Precision));
                of_float = std::bit_cast<std::uint32_t>(static_cast<float>(size) * unit);
            } else {
                of_float += rebias << 23;
            }
        }
        return std::bit_cast<float>(sign | of_float);
    }

    code_type code_ = 0;
};

using float16 = small_float<11, 5>;            ///< IEEE 754 binary16
using bfloat16 = small_float<8, 8>;            ///< float's exponents, with 8 bits of precision
using float8_e5m2 = small_float<3, 5>;         ///< binary16's exponents, with 3 bits of precision
using float8_e4m3 = small_float<4, 4, false>;  ///< no infinities; at most 448

template <int P, int E, bool HasInfinity>
struct number_traits<small_float<P, E, HasInfinity>> {
    using number = small_float<P, E, HasInfinity>;
    using computed_in = float;  ///< rules that can keep bounds in floats do so (tracked.hpp)
    static constexpr int digits = P;
    static constexpr bool has_infinity = HasInfinity;
    static constexpr int max_exponent = (1 << (E - 1)) + (HasInfinity ? 0 : 1);
    static constexpr int min_exponent = number::least_exponent + 1;

    static constexpr number epsilon() { return number(detail::power_of_two(1 - P)); }
    static constexpr number unit_roundoff() { return number(detail::power_of_two(-P)); }
    static constexpr number underflow_unit() { return number::from_code(1); }
    static constexpr number smallest_normal() { return number::from_code(1 << (P - 1)); }
    static constexpr number largest() { return number::from_code(number::largest_code); }
    static constexpr number infinity() { return number::from_code(number::overflow_code); }

    static constexpr number abs(const number& x) {
        return number::from_code(x.code() & (number::codes / 2 - 1));
    }
    /// Without infinities, NaN stands for overflow and is passed on.
    static constexpr number(max)(const number& x, const number& y) {
        if constexpr (!HasInfinity)
            if (y != y) return y;
        return x < y ? y : x;
    }
    static constexpr bool is_finite(const number& x) {
        return abs(x).code() <= number::largest_code;
    }
    static constexpr number sqrt(const number& x) {
        return number(std::sqrt(static_cast<float>(x)));
    }
    /// The product is exact in double. The sum is rounded to odd there, so that rounding it again
    /// is harmless (Boldo, Melquiond 2008, Emulation of FMA).
    static constexpr number fma(const number& a, const number& b, const number& c) {
        const double product = static_cast<double>(a) * static_cast<double>(b);
        const auto [sum, error] = two_sum(product, static_cast<double>(c));
        const auto code = std::bit_cast<std::uint64_t>(sum);
        if (!(error != 0) || code % 2 == 1 || error != error) return number(sum);
        return number(std::bit_cast<double>((error > 0) == (sum > 0) ? code + 1 : code - 1));
    }
    static constexpr number scale(const number& x, int e) {
        constexpr int reach = 2 * (max_exponent + P - number::least_exponent);
        const int power = e < -reach ? -reach : e > reach ? reach : e;
        return number(static_cast<double>(x) * detail::power_of_two(power));
    }
    static constexpr int exponent(const number& x) {
        const auto code = std::bit_cast<std::uint64_t>(static_cast<double>(abs(x)));
        return static_cast<int>(code >> 52) - 1022;
    }
};

}  // namespace errbound

template <int P, int E, bool HasInfinity>
class std::numeric_limits<errbound::small_float<P, E, HasInfinity>> {
    using number = errbound::small_float<P, E, HasInfinity>;
    using traits = errbound::number_traits<number>;
    /// ⌊n·log10 2⌋
    static constexpr int decimal(int n) { return n * 1233 / 4096 - (n < 0 ? 1 : 0); }

  public:
    static constexpr bool is_specialized = true, is_signed = true, is_integer = false,
                          is_exact = false, is_bounded = true, is_modulo = false, traps = false,
                          tinyness_before = false;
    static constexpr bool has_infinity = HasInfinity, has_quiet_NaN = true,
                          has_signaling_NaN = false, has_denorm_loss = false;
    static constexpr std::float_denorm_style has_denorm = std::denorm_present;
    static constexpr std::float_round_style round_style = std::round_to_nearest;
    static constexpr bool is_iec559 = HasInfinity;
    static constexpr int radix = 2, digits = P, digits10 = decimal(P - 1),
                         max_digits10 = decimal(P) + 2;
    static constexpr int min_exponent = number::least_exponent + 1,
                         max_exponent = traits::max_exponent,
                         min_exponent10 = decimal(min_exponent - 1) + 1,
                         max_exponent10 = decimal(max_exponent);

    static constexpr number(min)() noexcept { return traits::smallest_normal(); }
    static constexpr number(max)() noexcept { return traits::largest(); }
    static constexpr number lowest() noexcept { return -traits::largest(); }
    static constexpr number epsilon() noexcept { return traits::epsilon(); }
    static constexpr number round_error() noexcept { return number(0.5); }
    static constexpr number infinity() noexcept { return traits::infinity(); }
    static constexpr number quiet_NaN() noexcept { return number::from_code(number::nan_code); }
    static constexpr number signaling_NaN() noexcept { return quiet_NaN(); }
    static constexpr number denorm_min() noexcept { return traits::underflow_unit(); }
};
