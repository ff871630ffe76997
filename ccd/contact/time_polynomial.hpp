// Motion as polynomials in t with unbounded integer coefficients. Internal.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <errbound/integers/dyadic.hpp>
#include <errbound/roots/integer_polynomial.hpp>
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

    /// Σ C(m, i)(1 − t)^(m−i) t^i values_i. The coefficient of t^j is C(m, j) times the j-th
    /// forward difference of the m + 1 control values.
    static time_polynomial from_control_values(form values) {
        const std::size_t degree = values.size() - 1;
        form coefficients;
        integer binomial = 1;
        for (std::size_t j = 0; j <= degree; ++j) {
            coefficients.push_back(binomial * values[0]);
            for (std::size_t i = 0; i + j < degree; ++i) values[i] = values[i + 1] - values[i];
            binomial = binomial * integer(degree - j) / integer(j + 1);
        }
        return time_polynomial(std::move(coefficients));
    }

    bool is_zero() const { return c_.empty(); }
    const form& coefficients() const { return c_; }

    /// A positive multiple of the quotient by the largest power of p that divides this. Returns
    /// this if p is constant.
    time_polynomial without_factor(const time_polynomial& p) const {
        if (p.c_.size() < 2) return *this;
        form factor = p.c_, quotient = c_;
        errbound::roots::make_primitive(factor);
        for (form next = quotient; !next.empty();) {
            quotient = std::move(next);
            next = errbound::roots::divided(quotient, factor);
        }
        return time_polynomial(std::move(quotient));
    }

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

/// The coordinates of an axis are integers in units of 2^units[axis].
using axis_units = std::array<int, 3>;

}  // namespace ccd::detail
