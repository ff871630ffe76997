// A number of the static filter next to the exact number. When its sign is evaluated, the filter's
// bound is compared with the error.
#pragma once

#include <algorithm>
#include <cmath>
#include <errbound/filters/static_filter.hpp>
#include <limits>

#include "tests/support/big_integer.hpp"

/// The unit and the findings of a thread's audited numbers.
struct audit {
    int unit = 0;     ///< of coordinates: 2^unit
    double used = 0;  ///< the largest ratio of an error, without the last rounding, to its bound
    bool violated = false;

    static audit& current() {
        thread_local audit state;
        return state;
    }

    /// `exact` is in units of 2^(unit·degree).
    template <class Filtered>
    void check(const Filtered& x, big_integer exact, int degree) {
        using T = typename Filtered::value_type;
        constexpr int digits = std::numeric_limits<T>::digits;
        const T value = x.value, bound = x.bound();
        if (!std::isfinite(value) || !std::isfinite(bound)) return;
        // A double's last bit lies at its exponent − 53 or, in a subnormal number, −1074.
        const auto last_bit = [](double y) {
            return y == 0 ? 0 : std::max(std::ilogb(y) - 52, -1074);
        };
        const int shift = std::max(0, degree * unit - std::min(last_bit(value), last_bit(bound)));
        const int fine = degree * unit - shift;
        exact <<= shift;
        // All are multiplied by 2^digits, so that u|value|, the last rounding, becomes |value|.
        big_integer beyond = abs(big_integer(value, fine) - exact), allowed(bound, fine);
        beyond <<= digits;
        allowed <<= digits;
        beyond = beyond - abs(big_integer(value, fine));
        if (sign(beyond) > 0) {
            if (allowed < beyond) violated = true;
            if (sign(allowed) > 0) used = std::max(used, ratio(beyond, allowed));
        }
        const errbound::sign_type s = sign_of(x);
        if (certain(s) && static_cast<int>(s) - 1 != sign(exact)) violated = true;
    }
};

/// The exact number is in units of 2^(unit·Degree); Degree is the degree in the coordinates.
template <class Filtered, int Degree>
struct audited {
    static constexpr int degree = Degree;
    Filtered filtered;
    big_integer exact;

    friend errbound::sign_type sign_of(const audited& x) {
        audit::current().check(as_filtered(x.filtered), x.exact, Degree);
        return static_cast<errbound::sign_type>(1 + sign(x.exact));
    }
    /// The exact number in the unit of a higher degree.
    template <int To>
    big_integer raised() const {
        big_integer r = exact;
        if constexpr (To > Degree) r <<= (Degree - To) * audit::current().unit;
        return r;
    }
};

template <class T>
struct audited_coordinate : audited<errbound::filters::filtered_coordinate<T>, 1> {
    explicit audited_coordinate(double x)
        : audited<errbound::filters::filtered_coordinate<T>, 1>{
              {static_cast<T>(x)}, big_integer(x, audit::current().unit)} {}
};

template <class X, int A, class Y, int B>
auto operator*(const audited<X, A>& x, const audited<Y, B>& y) {
    const auto product = x.filtered * y.filtered;
    return audited<decltype(x.filtered * y.filtered), A + B>{product, x.exact * y.exact};
}
template <class X, int A, class Y, int B>
auto operator+(const audited<X, A>& x, const audited<Y, B>& y) {
    constexpr int degree = A < B ? B : A;
    const auto sum = x.filtered + y.filtered;
    return audited<decltype(x.filtered + y.filtered), degree>{
        sum, x.template raised<degree>() + y.template raised<degree>()};
}
template <class X, int A, class Y, int B>
auto operator-(const audited<X, A>& x, const audited<Y, B>& y) {
    constexpr int degree = A < B ? B : A;
    const auto difference = x.filtered - y.filtered;
    return audited<decltype(x.filtered - y.filtered), degree>{
        difference, x.template raised<degree>() - y.template raised<degree>()};
}
