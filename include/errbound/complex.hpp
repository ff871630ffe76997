// Complex numbers of tracked parts (optional header): size, angle, and the number of a size and an
// angle.
//
//   using number = errbound::tracked<double>;
//   const std::complex<number> z(number(3), number(4));
//   abs(z * z).error();                    // found by its argument: no std:: is needed
//
// + − × ÷, `norm`, `conj` and `real` are those of std::complex. Write `abs(z)`, or `using
// std::abs;` before it in generic code: std::abs(z) does not compile. There are no complex sqrt,
// exp, log or pow.
#pragma once

#include <complex>
#include <errbound/elementary.hpp>
#include <errbound/functions.hpp>

namespace errbound {

/// |z|: hypot of the parts, without overflow or underflow on the way.
template <class T, class Rule>
tracked<T, Rule> abs(const std::complex<tracked<T, Rule>>& z) {
    return hypot(z.real(), z.imag());
}

/// The angle of z in [−π, π]; unknown where z may be 0. See atan2 for numbers near the cut.
template <class T, class Rule>
tracked<T, Rule> arg(const std::complex<tracked<T, Rule>>& z) {
    return atan2(z.imag(), z.real());
}

/// The number of size r and angle θ: r·cos θ and r·sin θ.
template <class T, class Rule>
std::complex<tracked<T, Rule>> polar(const tracked<T, Rule>& r, const tracked<T, Rule>& angle) {
    return {r * cos(angle), r * sin(angle)};
}

}  // namespace errbound
