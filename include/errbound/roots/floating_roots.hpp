// Approximate roots of quadratics and cubics in plain floating point, which callers must guard.
// Power basis: coefficient i of a bernstein<S, N> belongs to t^i, the form of
// errbound/bernstein.hpp at s = 1, and value_at(p, S(1), t) is the value at t.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <errbound/bernstein.hpp>
#include <errbound/number_traits.hpp>
#include <limits>
#include <utility>

namespace errbound::roots {

template <class S, int N>
requires(N >= 1) constexpr bernstein<S, N - 1> power_derivative(const bernstein<S, N>& p) {
    bernstein<S, N - 1> r;
    r[0] = p[1];
    for (int i = 1; i < N; ++i) r[i] = p[i + 1] * S(i + 1);
    return r;
}

/// The two roots of c0 + c1·t + c2·t², unordered, then its vertex, which also replaces complex
/// roots. Roots that do not exist are infinite or NaN. Both roots are exact for one quadratic whose
/// coefficients differ by at most 16·ε·m, where m is the largest of |c0|, |c1|, |c2|. Proof: the
/// discriminant has an error of at most δ = 4ε(c1² + 4|c0·c2|); before division, q² + c1·q + c0·c2
/// = δ/4. The roots' sum has an error of |δ/(4·c2·q)|; |q| is at least |c1|/2, and at least
/// √|c0·c2| if that is larger and the roots are real.
template <class T>
constexpr std::array<T, 3> quadratic_roots(T c0, T c1, T c2) {
    using traits = number_traits<T>;
    const T m = (traits::max)(traits::abs(c0), (traits::max)(traits::abs(c1), traits::abs(c2)));
    c0 /= m, c1 /= m, c2 /= m;  // 0/0 = NaN if all are zero
    const T discriminant = c1 * c1 - 4 * c0 * c2;
    const T root = discriminant > 0 ? std::sqrt(discriminant) : T(0);
    const T q = -(c1 + std::copysign(root, c1)) / 2;
    return {q / c2, c0 / q, -c1 / (2 * c2)};
}

/// The first `count` of `at`, ascending: 0, the computed roots of f' in (0, 1), 1.
template <class T>
struct piece_ends {
    std::array<T, 4> at{};
    std::size_t count = 0;
};

/// Intervals of [0, 1] on which f is monotone, up to rounding.
template <class T>
constexpr piece_ends<T> monotone_pieces(const bernstein<T, 3>& f) {
    const auto slope = power_derivative(f);
    std::array<T, 3> turns = quadratic_roots(slope[0], slope[1], slope[2]);
    if (turns[1] < turns[0]) std::swap(turns[0], turns[1]);
    piece_ends<T> ends;
    ends.at[ends.count++] = T(0);
    for (const T t : {turns[0], turns[1]})
        if (t > ends.at[ends.count - 1] && t < 1) ends.at[ends.count++] = t;
    ends.at[ends.count++] = T(1);
    return ends;
}

/// A point of [low, high] near a root of p. Precondition: end values have opposite signs. A Newton
/// step that leaves the bracket, or is longer than half the last step, becomes a halving: 2·digits
/// steps suffice.
template <class T, int N>
constexpr T guarded_newton(const bernstein<T, N>& p, T low, T high) {
    const bernstein<T, N - 1> slope = power_derivative(p);
    const bool rising = value_at(p, T(1), low) < 0;
    T t = low + (high - low) / 2, last_step = high - low;
    for (int i = 0; i < 2 * std::numeric_limits<T>::digits; ++i) {
        const T y = value_at(p, T(1), t);
        if (y == 0) return t;
        ((y < 0) == rising ? low : high) = t;
        T next = t - y / value_at(slope, T(1), t);
        if (!(low < next && next < high && 2 * std::abs(next - t) <= last_step))
            next = low + (high - low) / 2;
        if (next == t) return t;
        last_step = std::abs(next - t);
        t = next;
    }
    return t;
}

}  // namespace errbound::roots
