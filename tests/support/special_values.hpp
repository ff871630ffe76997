// Special values, and the exact values of numbers of every format.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <boost/multiprecision/gmp.hpp>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <errbound/number_traits.hpp>
#include <limits>
#include <random>

using rational = boost::multiprecision::number<boost::multiprecision::gmp_rational,
                                               boost::multiprecision::et_off>;
using whole_number =
    boost::multiprecision::number<boost::multiprecision::gmp_int, boost::multiprecision::et_off>;

inline rational power_of(int base, int exponent) {
    const whole_number power =
        boost::multiprecision::pow(whole_number(base), static_cast<unsigned>(std::abs(exponent)));
    return exponent < 0 ? rational(whole_number(1), power) : rational(power);
}

/// The exact value of x. Precondition: x is finite.
template <class T>
rational exactly(const T& x) {
    using traits = errbound::number_traits<T>;
    if constexpr (traits::digits < 24) {
        return exactly(static_cast<double>(x));
    } else {
        if (x == 0) return 0;
        constexpr int bits = 30;  // at a time: some formats have more than any integer type
        int e = traits::exponent(x);
        T rest = traits::scale(x, -e);
        whole_number whole = 0;
        for (; rest != 0; e -= bits) {
            rest = traits::scale(rest, bits);
            const auto part = static_cast<long long>(rest);
            rest -= T(static_cast<double>(part));
            whole = (whole << bits) + part;
        }
        return e < 0 ? rational(whole, whole_number(1) << -e) : rational(whole << e);
    }
}

/// True if x and y are equal, with the same sign, or both NaN.
template <class T>
bool same_bits(const T& x, const T& y) {
    const auto is_negative = [](const T& z) { return std::signbit(static_cast<double>(z)); };
    return x == y ? is_negative(x) == is_negative(y) : x != x && y != y;
}

/// Values that tend to reveal errors: zeros, powers of two and their neighbours, subnormals, huge
/// numbers, and mantissas with few bits (many exact results) or all bits. In small formats, any
/// code, including infinities and NaN.
template <class T>
T special_value(std::mt19937_64& random) {
    if constexpr (!std::floating_point<T>) {
        return T::from_code(static_cast<int>(random() % static_cast<unsigned>(T::codes)));
    } else {
        using limits = std::numeric_limits<T>;
        const int spread = static_cast<int>(random() % 4);
        const int range = spread == 0 ? 4 : spread == 1 ? 60 : limits::max_exponent - 2;
        const int e = static_cast<int>(random() % static_cast<unsigned>(2 * range + 1)) - range;
        const bool few_bits = random() % 3 == 0;
        const auto bits = static_cast<std::int64_t>(random() >> (few_bits ? 60 : 11));
        switch (random() % 12) {
            case 0:
                return T(0);
            case 1:
                return limits::denorm_min() * T(static_cast<int>(random() % 8));
            case 2:
                return limits::min() * T(static_cast<int>(random() % 5));
            case 3:
                return std::nextafter(std::ldexp(T(1), e), random() % 2 ? T(0) : limits::max());
            default:
                break;
        }
        const T m = T(bits) * (random() % 2 ? T(1) : T(-1));
        return std::ldexp(m, e - (few_bits ? 4 : 53));
    }
}
