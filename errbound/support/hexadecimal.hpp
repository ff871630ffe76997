// Doubles as exact text, equal for all C libraries, whose printf's differ, at least for subnormals.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

namespace errbound::support {

/// C's hexadecimal literals with one digit before the point, 0 for subnormals, and no trailing
/// zeros: -0x1.8p+1, 0x0.8p-1022, 0x0p+0; inf and nan.
inline std::string hexadecimal(double x) {
    const std::string sign = std::signbit(x) ? "-" : "";
    if (!std::isfinite(x)) return sign + (std::isnan(x) ? "nan" : "inf");
    constexpr int fraction_bits = 52, bias = 1023;
    const auto bits = std::bit_cast<std::uint64_t>(x);
    const int biased = static_cast<int>(bits >> fraction_bits & 0x7ff);
    std::string digits;
    for (std::uint64_t rest = bits << (64 - fraction_bits); rest != 0; rest <<= 4)
        digits += "0123456789abcdef"[rest >> 60];
    int exponent = biased - bias;
    if (biased == 0) exponent = digits.empty() ? 0 : 1 - bias;
    return sign + (biased == 0 ? "0x0" : "0x1") + (digits.empty() ? "" : ".") + digits +
           (exponent < 0 ? "p" : "p+") + std::to_string(exponent);
}

}  // namespace errbound::support
