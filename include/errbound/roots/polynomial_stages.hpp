// Polynomials of users, and their form for the two stages of errbound/roots/real_roots.hpp.
#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <errbound/number_traits.hpp>
#include <errbound/roots/integer_polynomial.hpp>
#include <errbound/rules/tight.hpp>
#include <errbound/tracked.hpp>
#include <initializer_list>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

namespace errbound {

/// Σ c_i x^i. Precondition (asserted): coefficients are finite.
template <class Coefficient>
class polynomial {
  public:
    using coefficient_type = Coefficient;

    polynomial() = default;
    polynomial(std::initializer_list<Coefficient> c) : polynomial(std::vector<Coefficient>(c)) {}
    explicit polynomial(std::vector<Coefficient> c) : c_(std::move(c)) {
        if constexpr (std::is_floating_point_v<Coefficient>)
            assert(
                std::all_of(c_.begin(), c_.end(), [](Coefficient x) { return std::isfinite(x); }));
    }

    const std::vector<Coefficient>& coefficients() const& { return c_; }
    std::vector<Coefficient> coefficients() && { return std::move(c_); }

  private:
    std::vector<Coefficient> c_;
};
/// Mixed types, as in {1, 2.5}, become their common type.
template <class... Numbers>
polynomial(Numbers...) -> polynomial<std::common_type_t<Numbers...>>;

}  // namespace errbound

namespace errbound::roots {

using floating_coefficient = tracked<double, tight>;

/// The exact doubles, without zeros at the end.
inline std::vector<floating_coefficient> floating_coefficients(const std::vector<double>& p) {
    std::vector<floating_coefficient> c(p.begin(), p.end());
    while (!c.empty() && c.back().value() == 0) c.pop_back();
    return c;
}
/// The coefficients of p, or of a positive multiple in double's range, with error bounds. Zeros are
/// exact.
template <exact_number Integer>
std::vector<floating_coefficient> floating_coefficients(const integer_form<Integer>& p) {
    constexpr double epsilon = number_traits<double>::epsilon();
    std::size_t size = p.size();
    while (size > 0 && p[size - 1] == 0) --size;
    int unit = 0;  // test first: some types throw on overflowing conversions, as Boost 1.83 does
    for (std::size_t i = 0; i < size; ++i)
        if (p[i] != 0) unit = (std::max)(unit, floor_log2(p[i]));
    const bool in_range = unit < 500;
    std::vector<floating_coefficient> c;
    c.reserve(size);
    for (std::size_t i = 0; i < size; ++i) {
        if (p[i] == 0) {
            c.emplace_back(0.0);
        } else if (in_range) {
            // Conversions of other types may have errors of some units in the last place.
            const double x = static_cast<double>(p[i]), size_of_x = std::abs(x);
            c.push_back(size_of_x < 0x1p52
                            ? floating_coefficient(x)
                            : floating_coefficient::within(x, 4 * epsilon * size_of_x));
        } else {
            const double x = nearby_double(p[i], -unit);
            c.push_back(floating_coefficient::within(
                x, 2 * epsilon * std::abs(x) + number_traits<double>::underflow_unit()));
        }
    }
    return c;
}

/// Number of leading coefficients that are exactly zero: the multiplicity of the root 0.
inline std::size_t leading_zeros(const std::vector<floating_coefficient>& c) {
    const auto first = std::find_if(c.begin(), c.end(), [](const floating_coefficient& x) {
        return x.value() != 0 || x.error() != 0;
    });
    return static_cast<std::size_t>(first - c.begin());
}

template <exact_number Integer>
class staged_polynomial {
  public:
    using number = floating_coefficient;

    staged_polynomial() = default;
    /// From finite doubles, which are exact; integers are computed on demand.
    explicit staged_polynomial(const std::vector<double>& coefficients)
        : floating_(floating_coefficients(coefficients)) {}
    explicit staged_polynomial(integer_form<Integer> p)
        : floating_(floating_coefficients(p)), exact_(std::move(p)) {
        trim(exact_);
    }

    bool is_zero() const { return floating_.empty(); }
    std::size_t size() const { return floating_.size(); }
    const std::vector<number>& floating() const { return floating_; }
    /// A positive multiple with integer coefficients.
    const integer_form<Integer>& exact() {
        if (exact_.empty() && !floating_.empty()) {
            int unit = (std::numeric_limits<int>::max)();
            for (const number& c : floating_)
                unit = (std::min)(unit, integers::binary_double(c.value()).last_bit());
            integer_form<Integer> all;  // assigned as a whole: memory may run out before
            for (const number& c : floating_)
                all.push_back(dyadic<Integer>::from(c.value()).in_units(unit));
            exact_ = std::move(all);
        }
        return exact_;
    }

    /// Divides by x as often as possible; returns the number of divisions.
    int divide_by_x() {
        const auto count = static_cast<std::ptrdiff_t>(leading_zeros(floating_));
        if (count == 0) return 0;
        floating_.erase(floating_.begin(), floating_.begin() + count);
        if (!exact_.empty()) exact_.erase(exact_.begin(), exact_.begin() + count);
        return static_cast<int>(count);
    }

  private:
    std::vector<number> floating_;
    integer_form<Integer> exact_;
};

/// p for both stages; a positive multiple if coefficients are rational.
template <class Integer, class C>
staged_polynomial<Integer> staged(const polynomial<C>& p) {
    const std::vector<C>& c = p.coefficients();
    if constexpr (std::is_floating_point_v<C>) {
        static_assert(std::numeric_limits<C>::digits <= std::numeric_limits<double>::digits,
                      "errbound: floating-point coefficients must be float or double");
        return staged_polynomial<Integer>(std::vector<double>(c.begin(), c.end()));
    } else if constexpr (std::numeric_limits<C>::is_integer) {
        return staged_polynomial<Integer>(integer_form<Integer>(c.begin(), c.end()));
    } else {
        static_assert(
            exact_number<C>,
            "errbound: coefficients must be float, double or exact numbers; for tracked ones "
            "only count_roots(p, a, b)");
        Integer common = 1;
        for (const C& x : c) common = lcm(common, Integer(denominator(x)));
        integer_form<Integer> whole;
        for (const C& x : c)
            whole.push_back(Integer(Integer(numerator(x)) * (common / Integer(denominator(x)))));
        return staged_polynomial<Integer>(std::move(whole));
    }
}

template <class Number>
Number value_at(const std::vector<Number>& coefficients, const Number& x) {
    Number sum(0);
    for (auto c = coefficients.rbegin(); c != coefficients.rend(); ++c) sum = sum * x + *c;
    return sum;
}

}  // namespace errbound::roots
