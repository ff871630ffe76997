// Numbers of every kind, made by integer arithmetic only.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "ccd/lab/queries.hpp"

namespace everywhere {

/// Small integers, numbers with all 24 bits of a float, of every size, and their adjacent numbers.
/// With `of_any_size`, also any finite bits, and zeros of both signs.
template <class T>
T any_number(ccd::lab::source& random, bool of_any_size) {
    using limits = std::numeric_limits<T>;
    const auto small = static_cast<T>(random.between(-9, 9));
    switch (random.between(0, of_any_size ? 7 : 4)) {
        case 0:
        case 1:
            return small;
        case 2:
            return std::nextafter(small, random.one_in(2) ? limits::max() : limits::lowest());
        case 3:
            return static_cast<T>(random.between(-0xffffff, 0xffffff)) / 64;
        case 4:
            return static_cast<T>(random.symmetric());
        case 5: {  // sequential draws: compilers evaluate arguments in different orders
            const auto factor = static_cast<T>(random.between(-15, 15));
            return std::ldexp(factor, random.between(limits::min_exponent - limits::digits,
                                                     limits::max_exponent - 5));
        }
        case 6:
            return random.one_in(2) ? T(0) : -T(0);
        default:
            for (;;) {
                const auto x = [&] {
                    if constexpr (sizeof(T) == sizeof(double))
                        return std::bit_cast<double>(random.bits());
                    else
                        return std::bit_cast<float>(static_cast<std::uint32_t>(random.bits()));
                }();
                if (std::isfinite(x)) return x;
            }
    }
}

}  // namespace everywhere
