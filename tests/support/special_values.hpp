// Numbers that find trouble, and their exact values.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <boost/multiprecision/gmp.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

using rational = boost::multiprecision::number<boost::multiprecision::gmp_rational,
                                               boost::multiprecision::et_off>;

/// Of finite numbers.
template <class T>
rational exactly(T x) {
    int e = 0;
    T rest = std::frexp(x, &e);
    boost::multiprecision::mpz_int whole = 0;
    // Some bits at a time: long double has 113 on some processors, more than any integer type.
    constexpr int bits = 30;
    for (int taken = 0; taken < std::numeric_limits<T>::digits; taken += bits, e -= bits) {
        rest = std::ldexp(rest, bits);
        const auto part = static_cast<std::int32_t>(rest);
        rest -= static_cast<T>(part);
        whole = (whole << bits) + part;
    }
    boost::multiprecision::mpz_int power = 1;
    power <<= std::abs(e);
    return e >= 0 ? rational(rational(whole) * rational(power)) : rational(whole, power);
}

/// Values that find trouble: zeros, powers of two and their neighbours, subnormals, huge numbers,
/// and mantissas with few bits (many exact results) or all bits.
template <class T>
T special_value(std::mt19937_64& random) {
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
