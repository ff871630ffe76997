// Coordinates as integers with one common exponent, and their widths.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <errbound/detail/bits.hpp>
#include <errbound/detail/power_of_two.hpp>
#include <errbound/integers/binary_double.hpp>
#include <errbound/integers/sized_integer.hpp>
#include <limits>

namespace errbound::integers {

/// The largest magnitude, as bits of a double; infinities and NaN exceed all finite numbers.
template <std::size_t N>
constexpr std::uint64_t largest_size(const std::array<double, N>& coordinates) {
    std::uint64_t largest = 0;
    for (const double x : coordinates)
        largest = (std::max)(largest, std::bit_cast<std::uint64_t>(x) << 1 >> 1);
    return largest;
}
constexpr bool is_finite_size(std::uint64_t size) {
    return size >> 52 < 2047;
}

using detail::power_of_two;

/// Coordinates with few bits: x = value·2^unit, |value| < 2^Bits, Bits <= 50.
template <std::size_t N, int Bits>
struct short_coordinates {
    std::array<double, N> value;
    int unit;
    bool fit = false;

    /// `largest` is largest_size(coordinates), finite. Adding 3·2^51 units rounds x to whole units;
    /// only multiples survive. Proof: proofs/integers/Widths.v, short_coordinates_exact.
    constexpr short_coordinates(const std::array<double, N>& coordinates, std::uint64_t largest) {
        const auto field = static_cast<int>(largest >> 52);
        unit = field - 1022 - Bits;
        if (unit < -1022 || unit > 970) return;  // all powers of two below must be normal
        const double shift = 3 * power_of_two(unit + 51), to_unit = power_of_two(-unit);
        std::uint64_t lost = 0;
        for (std::size_t i = 0; i < N; ++i) {
            const double x = coordinates[i], multiple = (x + shift) - shift;
            lost |= std::bit_cast<std::uint64_t>(x - multiple);
            value[i] = x * to_unit;
        }
        fit = lost == 0;
    }
};

template <std::size_t N>
struct word_coordinates {
    /// With 61 bits, products of n differences, and the sums of them that predicates need, fit in n
    /// words.
    static constexpr int max_bits = 61;

    std::array<std::int64_t, N> value;
    int unit;
    bool fit;

    /// `largest` is largest_size(coordinates), finite, so coordinates are below 2^(field − 1022).
    /// Proof: proofs/integers/Widths.v, word_coordinates_exact.
    constexpr word_coordinates(const std::array<double, N>& coordinates, std::uint64_t largest) {
        const auto field = static_cast<int>(largest >> 52);
        unit = field - 1022 - max_bits;
        fit = field > 61;  // both powers of two are normal numbers
        if (!fit) return;
        const double from_unit = power_of_two(unit), to_unit = power_of_two(-unit);
        std::uint64_t any = 0, differing = 0;
        for (std::size_t i = 0; i < N; ++i) {
            value[i] = static_cast<std::int64_t>(coordinates[i] * to_unit);
            const double back = static_cast<double>(value[i]) * from_unit;
            differing |=
                std::bit_cast<std::uint64_t>(back) ^ std::bit_cast<std::uint64_t>(coordinates[i]);
            any |= static_cast<std::uint64_t>(value[i]);
        }
        fit = differing << 1 == 0;  // zeros may differ in sign
        least_bits_ = any == 0 ? 0 : max_bits - detail::countr_zero(any);
    }

    constexpr int least_bits() const { return least_bits_; }

  private:
    int least_bits_ = max_bits;
};

/// The largest common unit of finite coordinates, and their width in it.
struct common_unit {
    int unit = 0;
    int bits = 0;

    template <std::size_t N>
    constexpr explicit common_unit(const std::array<double, N>& coordinates) {
        int last = (std::numeric_limits<int>::max)(), end = (std::numeric_limits<int>::min)();
        for (const double x : coordinates) {
            const binary_double d(x);
            if (d.magnitude == 0) continue;
            last = (std::min)(last, d.last_bit());
            end = (std::max)(end, d.end_bit());
        }
        if (last > end) return;  // all are zero
        unit = last;
        bits = end - last;
    }

    /// x as a number of the level. Precondition: the level is wide enough. Proof:
    /// proofs/integers/Widths.v, converted_exact.
    template <class Level>
    constexpr sized_integer<Level, Level::coordinate_bits, 1> converted(double x) const {
        using storage = typename sized_integer<Level, Level::coordinate_bits, 1>::storage;
        const binary_double d(x);
        if (d.magnitude == 0) return {storage(0), unit};
        const int shift = d.exponent - unit;  // negative: the bits shifted out are zeros
        const auto magnitude = d.magnitude >> std::clamp(-shift, 0, 63);
        if constexpr (Level::kind == integer_kind::any_length) {
            return {storage(magnitude, (std::max)(shift, 0), d.negative), unit};
        } else {
            const auto size = shifted_word<storage>(magnitude, (std::max)(shift, 0));
            return {d.negative ? -size : size, unit};
        }
    }
};

inline constexpr int full_range_bits = 1024 + 1074;  ///< all doubles are multiples of 2^-1074

}  // namespace errbound::integers
