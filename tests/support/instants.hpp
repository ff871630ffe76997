// Polynomials in time with whole coefficients, the instants at which they vanish, and the signs of
// other polynomials there. The oracle decides with them.
#pragma once

#include <array>
#include <boost/multiprecision/gmp.hpp>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace oracle::detail {

using integer =
    boost::multiprecision::number<boost::multiprecision::gmp_int, boost::multiprecision::et_off>;

// ---- Polynomials in t: coefficients of 1, t, t^2, ...; the last is nonzero, zero is empty ----

using polynomial = std::vector<integer>;

void trim(polynomial& p);
polynomial operator+(const polynomial& a, const polynomial& b);
polynomial operator-(polynomial a);
polynomial operator-(const polynomial& a, const polynomial& b);
polynomial operator*(const polynomial& a, const polynomial& b);

using vector = std::array<polynomial, 3>;

vector operator-(const vector& a, const vector& b);
polynomial dot(const vector& a, const vector& b);
vector cross(const vector& a, const vector& b);

// ---- Instants ----

/// A double's value as mantissa * 2^exponent: zero, or with an odd mantissa, so that the exponent
/// is the largest possible.
struct scaled {
    std::int64_t mantissa = 0;
    int exponent = std::numeric_limits<int>::max();

    explicit scaled(double x);
    /// x / 2^unit. Precondition: it is whole.
    integer in_units_of(int unit) const;
};

/// The instant numerator / 2^shift. The numerator is odd or the shift is 0.
struct dyadic {
    integer numerator;
    unsigned shift = 0;
};
/// Precondition: 0 <= t <= 1.
dyadic dyadic_of(double t);

/// One instant: the number `low` if p is empty, else the single root of p in (low, high). p is not
/// zero at the ends.
struct instant {
    polynomial p;
    dyadic low, high;

    int sign(const polynomial& g) const;
};

/// The distinct roots in the open interval (low, high) of a nonzero p.
std::vector<instant> roots_between(polynomial p, const dyadic& low, const dyadic& high);

/// An interval of times, with or without its ends.
struct stretch {
    dyadic low, high;
    bool with_low, with_high;

    /// The ends that belong to the stretch; if neither does, its middle.
    std::vector<instant> ends() const;
};

/// True if `holds` is true at an instant of the stretch. It is evaluated at `ends()` and, between
/// them, at the roots of the polynomials of `roots_of` that are not zero.
template <class Holds>
bool holds_somewhere(const stretch& when, std::span<const polynomial> roots_of,
                     const Holds& holds) {
    const auto any = [&](const std::vector<instant>& instants) {
        for (const instant& t : instants)
            if (holds(t)) return true;
        return false;
    };
    if (any(when.ends())) return true;
    for (const polynomial& p : roots_of)
        if (p.size() > 1 && any(roots_between(p, when.low, when.high))) return true;
    return false;
}

}  // namespace oracle::detail
