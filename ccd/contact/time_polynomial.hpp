// Motion as polynomials in t with unbounded integer coefficients. Internal.
#pragma once

#include <algorithm>
#include <ccd/curves.hpp>
#include <ccd/query.hpp>
#include <cstddef>
#include <errbound/integers/binary_double.hpp>
#include <errbound/integers/dyadic.hpp>
#include <errbound/roots/integer_polynomial.hpp>
#include <limits>
#include <span>
#include <utility>

#include "ccd/exact/unbounded_integers.hpp"

namespace ccd::detail {

/// Σ c_i t^i with a nonzero last coefficient: a ring, as ccd/methods/forms.hpp requires of scalars.
class time_polynomial {
  public:
    using form = errbound::roots::integer_form<integer>;

    time_polynomial() = default;
    explicit time_polynomial(form ascending) : c_(std::move(ascending)) {
        errbound::roots::trim(c_);
    }

    bool is_zero() const { return c_.empty(); }
    const form& coefficients() const { return c_; }

    friend time_polynomial operator+(const time_polynomial& p, const time_polynomial& q) {
        return combined(p, q, [](integer& a, const integer& b) { a += b; });
    }
    friend time_polynomial operator-(const time_polynomial& p, const time_polynomial& q) {
        return combined(p, q, [](integer& a, const integer& b) { a -= b; });
    }
    friend time_polynomial operator*(const time_polynomial& p, const time_polynomial& q) {
        if (p.c_.empty() || q.c_.empty()) return {};
        form product(p.c_.size() + q.c_.size() - 1);
        integer term;  // reused, so that it allocates once
        for (std::size_t i = 0; i < p.c_.size(); ++i) {
            for (std::size_t j = 0; j < q.c_.size(); ++j) {
                term = p.c_[i];
                term *= q.c_[j];
                product[i + j] += term;
            }
        }
        return time_polynomial(std::move(product));
    }

  private:
    template <class Combine>
    static time_polynomial combined(const time_polynomial& p, const time_polynomial& q,
                                    const Combine& combine) {
        form sum = p.c_;
        sum.resize(std::max(p.c_.size(), q.c_.size()));
        for (std::size_t i = 0; i < q.c_.size(); ++i) combine(sum[i], q.c_[i]);
        return time_polynomial(std::move(sum));
    }

    form c_;
};

/// The coordinates of an axis are integers in units of 2^exponent.
struct axis_exponents {
    int x, y, z;
};

/// The greatest such exponent; any if all coordinates are zero.
inline int whole_exponent(std::span<const curve> points, double point<double>::*axis) {
    int last = std::numeric_limits<int>::max();
    for (const curve& p : points)
        for (const point<double>& position : p)
            last = std::min(last, errbound::integers::binary_double(position.*axis).last_bit());
    return last;
}
inline axis_exponents whole_exponents(std::span<const curve> points) {
    return {whole_exponent(points, &point<double>::x), whole_exponent(points, &point<double>::y),
            whole_exponent(points, &point<double>::z)};
}

/// Returns x/2^exponent. Precondition: it is an integer.
inline integer whole(double x, int exponent) {
    return errbound::dyadic<integer>::from(x).in_units(exponent);
}

/// The coefficient of t^j is C(m, j) times the j-th forward difference of the m + 1 control values.
inline time_polynomial coordinate_in_time(const curve& points, double point<double>::*axis,
                                          int exponent) {
    time_polynomial::form values;
    for (const point<double>& p : points) values.push_back(whole(p.*axis, exponent));
    const std::size_t degree = points.size() - 1;
    time_polynomial::form coefficients;
    integer binomial = 1;
    for (std::size_t j = 0; j <= degree; ++j) {
        coefficients.push_back(binomial * values[0]);
        for (std::size_t i = 0; i + j < degree; ++i) values[i] = values[i + 1] - values[i];
        binomial = binomial * integer(degree - j) / integer(j + 1);
    }
    return time_polynomial(std::move(coefficients));
}

}  // namespace ccd::detail
