// A double as an integer times a power of two.
#pragma once

#include <bit>
#include <cstdint>
#include <errbound/detail/bits.hpp>
#include <limits>

namespace errbound::integers {

/// ±magnitude·2^exponent, magnitude below 2^53; the exponent of infinities and NaN is `not_finite`.
struct binary_double {
    static constexpr int not_finite = 2047 - 1075;

    std::uint64_t magnitude;
    int exponent;
    bool negative;

    constexpr explicit binary_double(double x) {
        const auto bits = std::bit_cast<std::uint64_t>(x);
        const std::uint64_t field = bits >> 52 & 2047, fraction = bits & ((1ULL << 52) - 1);
        magnitude = fraction | std::uint64_t{field != 0} << 52;
        exponent = static_cast<int>(field) + (field == 0) - 1075;
        negative = bits >> 63 != 0;
    }
    /// The odd part n of x = n·2^last_bit(). Precondition: x is not zero.
    constexpr std::int64_t odd_part() const {
        const auto odd = static_cast<std::int64_t>(magnitude >> detail::countr_zero(magnitude));
        return negative ? -odd : odd;
    }
    /// Position of the lowest bit set; for 0 above that of all other doubles.
    constexpr int last_bit() const {
        return magnitude == 0 ? (std::numeric_limits<int>::max)()
                              : exponent + detail::countr_zero(magnitude);
    }
    /// One above the position of the highest bit set; for 0 below that of all other doubles.
    constexpr int end_bit() const { return exponent + detail::bit_width(magnitude); }
};

}  // namespace errbound::integers
