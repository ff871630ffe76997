// Angles exceptionally close to multiples of π/2: hard cases for argument reduction.
#pragma once

#include <mpfr.h>

#include <errbound/number_traits.hpp>
#include <errbound/validation/ball.hpp>
#include <utility>
#include <vector>

namespace errbound::validation {

/// Positive angles m·2^unit below 2^(exponent + 1), unit = exponent + 1 − p, for T of precision p.
/// Let x = 2^unit·2/π, and let q_k be the denominators of its continued fraction. m is q_k, 2q_k,
/// q_k + q_(k−1) or 2q_k + q_(k−1), for q_k >= 2^(p−8). No positive n below q_(k+1) gives an n·x
/// nearer to an integer than n = q_k does. Precondition: exponent >= 0. Cost: about 100 µs for
/// double.
template <class T>
std::vector<T> hard_angles(int exponent) {
    constexpr int p = number_traits<T>::digits;
    const int unit = exponent + 1 - p;
    mpfr_number scaled(exponent + 3 * p + 64), rest(3 * p + 64), whole(3 * p + 64);
    mpfr_const_pi(scaled.get(), MPFR_RNDN);
    mpfr_ui_div(scaled.get(), 2, scaled.get(), MPFR_RNDN);
    mpfr_mul_2si(scaled.get(), scaled.get(), unit, MPFR_RNDN);
    mpfr_frac(rest.get(), scaled.get(), MPFR_RNDN);
    mpfr_number before(2 * p + 64), last(2 * p + 64), m(2 * p + 64);
    mpfr_set_ui(last.get(), 1, MPFR_RNDN);
    std::vector<T> angles;
    const auto add = [&](unsigned times, unsigned times_before) {
        mpfr_mul_ui(m.get(), last.get(), times, MPFR_RNDN);
        if (times_before != 0) mpfr_add(m.get(), m.get(), before.get(), MPFR_RNDN);
        if (mpfr_get_exp(m.get()) > p) return;
        T integer(0);
        while (mpfr_zero_p(m.get()) == 0) {
            const double leading = mpfr_get_d(m.get(), MPFR_RNDZ);
            integer += static_cast<T>(leading);
            mpfr_sub_d(m.get(), m.get(), leading, MPFR_RNDN);
        }
        angles.push_back(number_traits<T>::scale(integer, unit));
    };
    while (mpfr_get_exp(last.get()) <= p) {
        if (mpfr_get_exp(last.get()) > p - 8)
            for (const unsigned times : {1U, 2U})
                for (const unsigned times_before : {0U, 1U}) add(times, times_before);
        mpfr_ui_div(rest.get(), 1, rest.get(), MPFR_RNDN);
        mpfr_floor(whole.get(), rest.get());
        mpfr_sub(rest.get(), rest.get(), whole.get(), MPFR_RNDN);
        mpfr_fma(m.get(), whole.get(), last.get(), before.get(), MPFR_RNDN);
        before = std::exchange(last, m);
    }
    return angles;
}

}  // namespace errbound::validation
