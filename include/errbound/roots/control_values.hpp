// Polynomials by control values (Bernstein coefficients), for subdivision in floating point:
// halving is a triangle of midpoints, and all coefficients have the same error bound.
#pragma once

#include <array>
#include <cstddef>
#include <errbound/bernstein.hpp>
#include <utility>

namespace errbound::roots {

/// The control values b_0..b_N of a polynomial of degree N, times multiple(N).
template <class S, int N>
struct control_values {
    std::array<S, std::size_t{N + 1}> b;

    constexpr const S& operator[](int i) const { return b[static_cast<std::size_t>(i)]; }
    constexpr S& operator[](int i) { return b[static_cast<std::size_t>(i)]; }
};

/// The least common multiple of the binomials C(N, i), so that control values need no division.
constexpr int multiple(int degree) {
    int m = 1;
    for (int i = 0; i <= degree; ++i) {
        const int b = binomial(degree, i);
        int whole = m;
        while (whole % b != 0) whole += m;
        m = whole;
    }
    return m;
}

template <class S, int N>
constexpr control_values<S, N> control_values_of(const bernstein<S, N>& p) {
    control_values<S, N> c;
    for (int i = 0; i <= N; ++i) {
        const int factor = multiple(N) / binomial(N, i);
        c[i] = factor == 1 ? p[i] : S(p[i] * S(factor));
    }
    return c;
}

/// Midpoints of neighbours. Unrolled, since a loop would stall: it loads as pairs values just
/// stored singly.
template <class S, std::size_t... I>
constexpr std::array<S, sizeof...(I)> midpoints(const std::array<S, sizeof...(I) + 1>& row,
                                                std::index_sequence<I...>) {
    return {S((row[I] + row[I + 1]) * S(0.5))...};
}

/// The ends of each midpoint row are control values of the halves.
template <class S, int N, std::size_t Left>
constexpr void halve(const std::array<S, Left>& row, control_values<S, N>& left,
                     control_values<S, N>& right) {
    left.b[N + 1 - Left] = row.front();
    right.b[Left - 1] = row.back();
    if constexpr (Left > 1)
        halve(midpoints(row, std::make_index_sequence<Left - 1>()), left, right);
}

/// The control values on [0, 1/2] and on [1/2, 1] (de Casteljau). Proof:
/// proofs/filters/Subdivision.v, halves_cubic, halves_quartic.
template <class S, int N>
constexpr std::pair<control_values<S, N>, control_values<S, N>> halves(
    const control_values<S, N>& p) {
    std::pair<control_values<S, N>, control_values<S, N>> h;
    halve(p.b, h.first, h.second);
    return h;
}

}  // namespace errbound::roots
