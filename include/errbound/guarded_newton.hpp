// Roots of a cubic on [0, 1] in plain floating point: monotone pieces between the derivative's
// roots, then Newton's method guarded by bisection in a piece whose ends differ in sign.
//
// Nothing here is certified: values, turning points and roots carry the rounding errors that they
// carry. Who needs a promise brings tolerances of their own. No allocation; bounded.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace errbound {

/// a0 + a1·t + a2·t² + a3·t³.
template <class T>
using power_cubic = std::array<T, 4>;

template <class T>
constexpr T value_at(const power_cubic<T>& f, const T& t) {
    return ((f[3] * t + f[2]) * t + f[1]) * t + f[0];
}
template <class T>
constexpr T slope_at(const power_cubic<T>& f, const T& t) {
    return (3 * f[3] * t + 2 * f[2]) * t + f[1];
}

/// The first `count` of `at`, in ascending order.
template <class T>
struct piece_ends {
    std::array<T, 4> at{};
    std::size_t count = 0;
};

/// The ends of f's monotone pieces: 0, the roots of f' in (0, 1), 1. Overflows where (Σ|a_i|)²
/// does.
///
/// The derivative 3·a3·t² + 2·a2·t + a1 has the roots w/(3·a3) and a1/w with w = −(a2 ± √(a2² −
/// 3·a1·a3)), the sign being that of a2, so that nothing cancels. Leading coefficients that are
/// zero divide to ±∞ or NaN, which do not lie in (0, 1); the other quotient is then the lower
/// degree's root.
template <class T>
piece_ends<T> monotone_pieces(const power_cubic<T>& f) {
    piece_ends<T> ends;
    ends.at[ends.count++] = T(0);
    const T discriminant = f[2] * f[2] - 3 * f[1] * f[3];
    if (discriminant > 0) {
        const T w = -(f[2] + std::copysign(std::sqrt(discriminant), f[2]));
        std::array<T, 2> turns{w / (3 * f[3]), f[1] / w};
        if (turns[1] < turns[0]) std::swap(turns[0], turns[1]);
        for (const T& t : turns)
            if (0 < t && t < 1) ends.at[ends.count++] = t;
    }
    ends.at[ends.count++] = T(1);
    return ends;
}

/// A root of f in [low, high], where f is monotone and f(low), f(high) differ in sign. A Newton
/// step that leaves the bracket, or is more than half as long as the last one, becomes a halving of
/// the bracket: so every two steps halve one of them, and 2·digits steps find the root to about ε.
template <class T>
T guarded_newton(const power_cubic<T>& f, T low, T high) {
    const bool rising = value_at(f, low) < 0;
    T t = low + (high - low) / 2, last_step = high - low;
    for (int i = 0; i < 2 * std::numeric_limits<T>::digits; ++i) {
        const T y = value_at(f, t);
        if (y == 0) return t;
        ((y < 0) == rising ? low : high) = t;
        T next = t - y / slope_at(f, t);
        if (!(low < next && next < high && 2 * std::abs(next - t) <= last_step))
            next = low + (high - low) / 2;
        if (next == t) return t;
        last_step = std::abs(next - t);
        t = next;
    }
    return t;
}

}  // namespace errbound
