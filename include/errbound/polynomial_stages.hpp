// Polynomials as users write them, and as the two stages of errbound/real_roots.hpp want them.
#pragma once

#include <algorithm>
#include <cmath>
#include <errbound/integer_polynomial.hpp>
#include <errbound/number_traits.hpp>
#include <errbound/rules/tight.hpp>
#include <errbound/tracked.hpp>
#include <initializer_list>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

namespace errbound {

/// Σ c_i x^i. Coefficients are finite.
template <class Coefficient>
class polynomial {
  public:
    using coefficient_type = Coefficient;

    /// Identically zero.
    polynomial() = default;
    polynomial(std::initializer_list<Coefficient> c) : c_(c) {}
    explicit polynomial(std::vector<Coefficient> c) : c_(std::move(c)) {}

    /// In ascending order.
    const std::vector<Coefficient>& coefficients() const { return c_; }

  private:
    std::vector<Coefficient> c_;
};

/// One polynomial for both stages: exact, and in floating point with error bounds.
template <exact_number Integer>
class staged_polynomial {
  public:
    using number = tracked<double, tight>;

    /// Of finite doubles, which are exact; integers are made of them when asked for.
    explicit staged_polynomial(const std::vector<double>& coefficients)
        : floating_(coefficients.begin(), coefficients.end()) {
        while (!floating_.empty() && floating_.back().value() == 0) floating_.pop_back();
    }
    explicit staged_polynomial(integer_form<Integer> p) : exact_(std::move(p)) {
        trim(exact_);
        int highest = std::numeric_limits<int>::min();
        for (const Integer& c : exact_)
            if (c != 0) highest = std::max(highest, floor_log2(c));
        // A positive multiple, where double's range asks for one.
        const int unit = std::max(0, highest - number_traits<double>::max_exponent / 2);
        for (const Integer& c : exact_) {
            const double x = nearby_double(c, -unit);
            const bool same = unit == 0 && std::abs(x) < 0x1p53;
            const double error = number_traits<double>::epsilon() * std::abs(x);
            floating_.push_back(
                same || c == 0
                    ? number(x)
                    : number::within(x, 2 * error + number_traits<double>::underflow_unit()));
        }
    }

    bool is_zero() const { return floating_.empty(); }
    std::size_t size() const { return floating_.size(); }
    const std::vector<number>& floating() const { return floating_; }
    /// A positive multiple.
    const integer_form<Integer>& exact() {
        if (exact_.empty() && !floating_.empty()) {
            int unit = std::numeric_limits<int>::max();
            for (const number& c : floating_)
                if (c.value() != 0) unit = std::min(unit, decomposed(c.value()).exponent);
            for (const number& c : floating_)
                exact_.push_back(dyadic<Integer>::from(c.value()).in_units(unit));
        }
        return exact_;
    }

    /// Divides by x as often as that goes; how often.
    int divide_by_x() {
        const auto first = std::find_if(floating_.begin(), floating_.end(), [](const number& c) {
            return c.value() != 0 || c.error() != 0;
        });
        const auto count = first - floating_.begin();
        floating_.erase(floating_.begin(), first);
        if (!exact_.empty()) exact_.erase(exact_.begin(), exact_.begin() + count);
        return static_cast<int>(count);
    }

  private:
    std::vector<number> floating_;
    integer_form<Integer> exact_;
};

/// p with its coefficients as both stages want them; a positive multiple where they are rational.
template <class Integer, class C>
staged_polynomial<Integer> staged(const polynomial<C>& p) {
    const std::vector<C>& c = p.coefficients();
    if constexpr (std::is_floating_point_v<C>) {
        static_assert(std::numeric_limits<C>::digits <= std::numeric_limits<double>::digits);
        return staged_polynomial<Integer>(std::vector<double>(c.begin(), c.end()));
    } else if constexpr (std::numeric_limits<C>::is_integer) {
        return staged_polynomial<Integer>(integer_form<Integer>(c.begin(), c.end()));
    } else {
        static_assert(exact_number<C>);
        Integer common = 1;
        for (const C& x : c) common = lcm(common, Integer(denominator(x)));
        integer_form<Integer> whole;
        for (const C& x : c)
            whole.push_back(Integer(Integer(numerator(x)) * (common / Integer(denominator(x)))));
        return staged_polynomial<Integer>(std::move(whole));
    }
}

/// The value by Horner's rule.
template <class Number>
Number value_at(const std::vector<Number>& coefficients, const Number& x) {
    Number sum(0);
    for (auto c = coefficients.rbegin(); c != coefficients.rend(); ++c) sum = sum * x + *c;
    return sum;
}

}  // namespace errbound
