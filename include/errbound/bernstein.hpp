// Polynomials on [0, 1] in Bernstein form, of compile-time degree, over any scalar with + − ×. A
// polynomial of degree N stores SCALED coefficients h_i, so that no operation divides:
//     p(s, t) = Σ h_i s^(N−i) t^i,   p(t) = p(1 − t, t),   h_i = C(N, i)·b_i,   b_i: control values
// The h_i are also the power-basis coefficients in x = t/s, which maps [0, 1] to [0, ∞]. Proof:
// proofs/bsc/Bernstein.v, form_ends, power_basis, hull_bounds.
#pragma once

#include <array>
#include <cstddef>
#include <errbound/sign.hpp>
#include <errbound/tracked.hpp>
#include <utility>

namespace errbound {

constexpr int binomial(int n, int k) {
    int c = 1;
    for (int i = 1; i <= k; ++i) c = c * (n - k + i) / i;
    return c;
}

template <class S, int N>
struct bernstein {
    static_assert(N >= 0);
    static constexpr int degree = N;
    std::array<S, std::size_t{N + 1}> h{};  ///< C(N, i)·b_i

    constexpr const S& operator[](int i) const { return h[static_cast<std::size_t>(i)]; }
    constexpr S& operator[](int i) { return h[static_cast<std::size_t>(i)]; }

    static constexpr bernstein from_control_values(const std::array<S, std::size_t{N + 1}>& b) {
        bernstein p;
        for (int i = 0; i <= N; ++i) {
            const std::size_t k = static_cast<std::size_t>(i);
            p.h[k] = i == 0 || i == N ? b[k] : S(b[k] * S(binomial(N, i)));
        }
        return p;
    }

    friend constexpr bernstein operator+(const bernstein& p, const bernstein& q) {
        bernstein r;
        for (int i = 0; i <= N; ++i) r[i] = p[i] + q[i];
        return r;
    }
    friend constexpr bernstein operator-(const bernstein& p, const bernstein& q) {
        bernstein r;
        for (int i = 0; i <= N; ++i) r[i] = p[i] - q[i];
        return r;
    }
    constexpr bernstein operator-() const {
        bernstein r;
        for (int i = 0; i <= N; ++i) r[i] = -h[static_cast<std::size_t>(i)];
        return r;
    }
};

/// A convolution. The factors' scalars may differ. Proof: proofs/bsc/Bernstein.v, product_form.
template <class S, class T, int A, int B>
constexpr auto operator*(const bernstein<S, A>& p, const bernstein<T, B>& q) {
    using product = decltype(p[0] * q[0]);
    bernstein<product, A + B> r;
    // Store the first term: adding it to zero would add a rounding bound.
    for (int k = 0; k <= A + B; ++k) {
        const int first = k > B ? k - B : 0;
        product sum = p[first] * q[k - first];
        for (int i = first + 1; i <= A && i <= k; ++i) sum = sum + p[i] * q[k - i];
        r[k] = sum;
    }
    return r;
}

/// The same polynomial, one degree higher: p·(s + t). Proof: proofs/bsc/Bernstein.v, elevated_form.
template <class S, int N>
constexpr bernstein<S, N + 1> elevated(const bernstein<S, N>& p) {
    bernstein<S, N + 1> r;
    r[0] = p[0];
    for (int i = 1; i <= N; ++i) r[i] = p[i] + p[i - 1];
    r[N + 1] = p[N];
    return r;
}

/// Coefficient i is (i + 1)·h_(i+1) − (N − i)·h_i. Proof: proofs/bsc/Bernstein.v, derivative_form.
template <class S, int N>
requires(N >= 1) constexpr bernstein<S, N - 1> derivative(const bernstein<S, N>& p) {
    const auto times = [](const S& x, int n) { return n == 1 ? x : S(x * S(n)); };
    bernstein<S, N - 1> r;
    for (int i = 0; i < N; ++i) r[i] = times(p[i + 1], i + 1) - times(p[i], N - i);
    return r;
}

namespace detail {

/// Horner's rule from term I on: sum holds the earlier terms, power is t^I. Types may grow.
template <int I, class S, int N, class T, class Sum, class Power>
constexpr auto value_from_term(const bernstein<S, N>& p, const T& s, const T& t, const Sum& sum,
                               const Power& power) {
    const auto next = sum * s + p[I] * power;
    if constexpr (I == N)
        return next;
    else
        return value_from_term<I + 1>(p, s, t, next, power * t);
}

}  // namespace detail

/// (s + t)^N · p(t/(s + t)). Cost: 3N − 1 products. Proof: proofs/bsc/Bernstein.v, value_at_form.
template <class S, int N, class T>
constexpr auto value_at(const bernstein<S, N>& p, const T& s, const T& t) {
    if constexpr (N == 0)
        return p[0];
    else
        return detail::value_from_term<1>(p, s, t, p[0], t);
}

/// p(t) for t in [0, 1].
template <class S, int N>
constexpr S value_at(const bernstein<S, N>& p, const S& t) {
    return value_at(p, S(S(1) - t), t);
}

/// Exchanges the ends of [0, 1]. Proof: proofs/bsc/Bernstein.v, reversed_form.
template <class S, int N>
constexpr bernstein<S, N> reversed(const bernstein<S, N>& p) {
    bernstein<S, N> r;
    for (int i = 0; i <= N; ++i) r[i] = p[N - i];
    return r;
}

/// p on [0, w/(v + w)], times (v + w)^N, for v, w > 0. Proof: proofs/bsc/Bernstein.v,
/// left_part_form.
template <class S, int N>
constexpr bernstein<S, N> left_part(const bernstein<S, N>& p, const S& v, const S& w) {
    const S whole = v + w;
    bernstein<S, N> r;
    r[0] = p[0];
    S power = w;
    for (int i = 1; i <= N; ++i) {
        r[i] = r[i - 1] * v + p[i] * power;
        for (int j = i - 1; j > 0; --j) r[j] = r[j] * whole + r[j - 1] * v;
        r[0] = r[0] * whole;
        if (i < N) power = power * w;
    }
    return r;
}

/// Both parts of p, split at w/(v + w), each times (v + w)^N.
template <class S, int N>
constexpr std::pair<bernstein<S, N>, bernstein<S, N>> split(const bernstein<S, N>& p, const S& v,
                                                            const S& w) {
    return {left_part(p, v, w), reversed(left_part(reversed(p), w, v))};
}

/// p on [0, 1/2], times 2^N; all products are exact. Proof: proofs/bsc/Bernstein.v, left_half_form.
template <class S, int N>
constexpr bernstein<S, N> left_half(const bernstein<S, N>& p) {
    bernstein<S, N> r;
    r[0] = p[0];
    for (int i = 1; i <= N; ++i) {
        r[i] = r[i - 1] + p[i];
        for (int j = i - 1; j > 0; --j) r[j] = scale(r[j], 1) + r[j - 1];
        r[0] = scale(r[0], 1);
    }
    return r;
}

/// Both halves of p, each times 2^N.
template <class S, int N>
constexpr std::pair<bernstein<S, N>, bernstein<S, N>> halves(const bernstein<S, N>& p) {
    return {left_half(p), reversed(left_half(reversed(p)))};
}

/// Scales a tracked form by a power of two, so that products of up to eight forms stay in range.
template <class S, int N>
constexpr bernstein<S, N> normalized(const bernstein<S, N>& p) {
    if constexpr (is_tracked<S>) {
        using T = typename S::value_type;
        using traits = number_traits<T>;
        T largest = traits::abs(p[0].value());
        for (int i = 1; i <= N; ++i) largest = (traits::max)(largest, traits::abs(p[i].value()));
        constexpr int room = traits::max_exponent / 16;
        if (!(largest > 0) || !traits::is_finite(largest)) return p;
        const int e = traits::exponent(largest);
        if (e >= -room && e <= room) return p;
        bernstein<S, N> r;
        for (int i = 0; i <= N; ++i) r[i] = scale(p[i], -e);
        return r;
    } else {
        return p;
    }
}

/// The sign on (0, 1): certain if the signs of all coefficients are certain and no two are
/// opposite. Proof: proofs/bsc/Bernstein.v, sign_inside_right.
template <class S, int N>
constexpr sign_type sign_inside(const bernstein<S, N>& p) {
    sign_type all = sign_type::zero;
    for (int i = 0; i <= N; ++i) {
        const sign_type s = sign_of(p[i]);
        if (!certain(s)) return s;
        if (s == sign_type::zero || s == all) continue;
        if (all != sign_type::zero) return sign_type::uncertain;
        all = s;
    }
    return all;
}

/// The sign on [0, 1]: certain if all coefficients have it. Proof: proofs/bsc/Bernstein.v,
/// sign_throughout_right.
template <class S, int N>
constexpr sign_type sign_throughout(const bernstein<S, N>& p) {
    const sign_type first = sign_of(p[0]);
    for (int i = 1; i <= N && certain(first); ++i)
        if (sign_of(p[i]) != first) return sign_type::uncertain;
    return first;
}

/// True if the coefficients exclude roots in [0, 1]. Proof: proofs/bsc/Bernstein.v, rootless_hull.
template <class S, int N>
constexpr bool certainly_rootless(const bernstein<S, N>& p) {
    const sign_type hull = sign_throughout(p);
    return hull == sign_type::positive || hull == sign_type::negative;
}

}  // namespace errbound
