// Rules as the library has them but for one term that is left out, for tie_test.cpp: the comparison
// must find each. Number 0 leaves out nothing.
#pragma once

#include <errbound/rules/derived.hpp>
#include <errbound/rules/interval.hpp>
#include <errbound/rules/residual.hpp>
#include <errbound/rules/safe.hpp>
#include <errbound/rules/sharp.hpp>
#include <errbound/rules/tight.hpp>

namespace tie_mutants {

using errbound::number_traits;
using errbound::rule_operand;

/// Of a rule whose bound is an error.
template <class T, class Rule>
bool is_zero(const rule_operand<T, Rule>& a) {
    return a.value == 0 && a.bound.error == 0;
}

template <int Without>
struct tight : errbound::derived_rule<tight<Without>, errbound::tight> {
    using Self = tight;
    static constexpr int mutants = 15;
    template <class T>
    using bound = errbound::tight::bound<T>;

    template <class T>
    static bound<T> exact(const T& v) {
        return {Without == 1 ? T(0) : v - v};
    }
    template <class T>
    static bound<T> within(const T& v, const T& e) {
        if (Without == 2) return {e + (v - v)};
        return errbound::tight::within(v, e);
    }
    template <class T>
    static bound<T> add(const T& v, rule_operand<T, Self> a, rule_operand<T, Self> b) {
        const T own = Without == 3 ? T(0) : rounding(v);
        const T of_b = Without == 5 ? T(0) : b.bound.error;
        return {errbound::detail::sum_of_bounds<T>(inflated<4>(own + (a.bound.error + of_b)), own,
                                                   a.bound.error, of_b)};
    }
    template <class T>
    static bound<T> multiply(const T& v, rule_operand<T, Self> a, rule_operand<T, Self> b) {
        using traits = number_traits<T>;
        if (Without != 6 && (is_zero(a) || is_zero(b))) return {rounding(v)};
        const T b_size = Without == 7 ? traits::abs(b.value) : traits::abs(b.value) + b.bound.error;
        const T inherited =
            (Without == 8 ? T(0) : traits::abs(a.value) * b.bound.error) + a.bound.error * b_size;
        const T lost = Without == 9 ? T(0) : 4 * traits::underflow_unit();
        return {inflated<0>(rounding(v) + inherited + lost)};
    }
    template <class T>
    static bound<T> divide(const T& v, rule_operand<T, Self> a, rule_operand<T, Self> b) {
        using traits = number_traits<T>;
        const T distance = traits::abs(b.value) - (Without == 10 ? T(0) : b.bound.error);
        if (!(distance > 0)) return {traits::infinity()};
        if (is_zero(a)) return {rounding(v)};
        const T quotient = inflated<11>(traits::abs(v) + traits::underflow_unit());
        const T lost = Without != 12 && b.bound.error > 0 ? 4 * traits::underflow_unit() : T(0);
        const T inherited = (a.bound.error + quotient * b.bound.error + lost) / distance;
        const T underflow = Without == 14 ? T(0) : 4 * traits::underflow_unit();
        return {inflated<0>(rounding(v) + inflated<13>(inherited) + underflow)};
    }
    template <class T>
    static bound<T> scale(const T& v, rule_operand<T, Self> a, int e) {
        if (Without == 15) return {number_traits<T>::scale(a.bound.error, e)};
        return errbound::tight::scale<T>(v, Self::original(a), e);
    }

  private:
    template <class T>
    static T rounding(const T& v) {
        using traits = number_traits<T>;
        return traits::abs(v) * (traits::epsilon() * (1 + traits::epsilon()));
    }
    template <int Mutant, class T>
    static T inflated(const T& b) {
        return Mutant != 0 && Without == Mutant ? b : b * (1 + 8 * number_traits<T>::epsilon());
    }
};

template <int Without>
struct sharp : errbound::derived_rule<sharp<Without>, errbound::sharp> {
    using Self = sharp;
    static constexpr int mutants = 5;
    template <class T>
    using bound = errbound::sharp::bound<T>;

    template <class T>
    static bound<T> add(const T& v, rule_operand<T, Self> a, rule_operand<T, Self> b) {
        using traits = number_traits<T>;
        const T own = Without == 1 ? T(0) : rounding(v);
        const T factor = Without == 2 ? 1 + traits::epsilon() : 1 + 2 * traits::epsilon();
        return {errbound::detail::sum_of_bounds<T>((own + (a.bound.error + b.bound.error)) * factor,
                                                   own, a.bound.error, b.bound.error)};
    }
    template <class T>
    static bound<T> multiply(const T& v, rule_operand<T, Self> a, rule_operand<T, Self> b) {
        using traits = number_traits<T>;
        if (is_zero(a) || is_zero(b)) return {rounding(v)};
        const T inherited = traits::abs(a.value) * b.bound.error +
                            a.bound.error * (traits::abs(b.value) + b.bound.error);
        const T lost = Without == 3 ? T(0) : 2 * traits::underflow_unit();
        return {inflated<T>((rounding(v) + lost) + inherited)};
    }
    template <class T>
    static bound<T> divide(const T& v, rule_operand<T, Self> a, rule_operand<T, Self> b) {
        using traits = number_traits<T>;
        const T distance = traits::abs(b.value) - b.bound.error;
        if (!(distance > 0)) return {traits::infinity()};
        if (is_zero(a)) return {rounding(v)};
        const T quotient = inflated<T>(traits::abs(v) + traits::underflow_unit());
        const T lost = Without != 4 && b.bound.error > 0 ? traits::underflow_unit() : T(0);
        const T inherited = (a.bound.error + (quotient * b.bound.error + lost)) / distance;
        const T underflow = Without == 5 ? T(0) : 2 * traits::underflow_unit();
        return {inflated<T>((rounding(v) + underflow) + inflated<T>(inherited))};
    }

  private:
    template <class T>
    static T rounding(const T& v) {
        return number_traits<T>::abs(v) * number_traits<T>::unit_roundoff();
    }
    template <class T>
    static T inflated(const T& b) {
        return b * (1 + 4 * number_traits<T>::epsilon());
    }
};

template <int Without>
struct safe : errbound::derived_rule<safe<Without>, errbound::safe> {
    using Self = safe;
    static constexpr int mutants = 5;
    template <class T>
    using bound = errbound::safe::bound<T>;

    template <class T>
    static bound<T> add(const T& v, rule_operand<T, Self> a, rule_operand<T, Self> b) {
        bound<T> sum = errbound::safe::add<T>(v, Self::original(a), Self::original(b));
        if (Without == 1) sum.magnitude = a.bound.magnitude + b.bound.magnitude;
        if (Without == 2) --sum.operations;
        return sum;
    }
    template <class T>
    static bound<T> multiply(const T& v, rule_operand<T, Self> a, rule_operand<T, Self> b) {
        using traits = number_traits<T>;
        bound<T> product = errbound::safe::multiply<T>(v, Self::original(a), Self::original(b));
        if (Without == 3 && product.magnitude == traits::smallest_normal())
            product.magnitude = a.bound.magnitude * b.bound.magnitude;
        return product;
    }
    template <class T>
    static T error(const T& v, const bound<T>& b) {
        using traits = number_traits<T>;
        const T x = T(b.operations) * traits::epsilon();
        if (!(x <= 1) || (Without != 4 && b.operations == 1 << 29) || !traits::is_finite(v))
            return traits::infinity();
        if (b.operations == 0) return T(0);
        const T factor = 1 + 4 * traits::epsilon();
        const T lost = Without == 5 ? T(0) : traits::underflow_unit();
        return (b.magnitude * (x * (1 + x) * factor) + lost) * factor;
    }
};

template <int Without>
struct interval : errbound::derived_rule<interval<Without>, errbound::interval> {
    using Self = interval;
    static constexpr int mutants = 4;
    template <class T>
    using bound = errbound::interval::bound<T>;

    template <class T>
    static bound<T> add(const T& v, rule_operand<T, Self> a, rule_operand<T, Self> b) {
        bound<T> sum = errbound::interval::add<T>(v, Self::original(a), Self::original(b));
        if (Without == 1 && number_traits<T>::is_finite(sum.lower))
            sum.lower = a.bound.lower + b.bound.lower;
        return sum;
    }
    template <class T>
    static bound<T> multiply(const T& v, rule_operand<T, Self> a, rule_operand<T, Self> b) {
        bound<T> product = errbound::interval::multiply<T>(v, Self::original(a), Self::original(b));
        if (Without == 2 && product.lower == product.upper) product.upper = v;
        if (Without == 2 && number_traits<T>::is_finite(product.upper) &&
            product.upper < a.bound.upper * b.bound.upper + number_traits<T>::epsilon())
            product.upper = a.bound.upper * b.bound.upper;
        return product;
    }
    template <class T>
    static bound<T> divide(const T& v, rule_operand<T, Self> a, rule_operand<T, Self> b) {
        if (Without == 3 && b.bound.lower == 0 && b.bound.upper > 0)
            return {a.bound.lower / b.bound.upper, a.bound.upper / b.bound.lower};
        const auto q = errbound::interval::divide<T>(v, Self::original(a), Self::original(b));
        if (Without == 4 && b.value < 0)  // the remainder's sign as it is
            return {v - (q.upper - v), v + (v - q.lower)};
        return q;
    }
};

template <int Without>
struct residual : errbound::derived_rule<residual<Without>, errbound::residual> {
    using Self = residual;
    static constexpr int mutants = 9;
    template <class T>
    using bound = errbound::residual::bound<T>;

    template <class T>
    static bound<T> add(const T& v, rule_operand<T, Self> a, rule_operand<T, Self> b) {
        using traits = number_traits<T>;
        using namespace errbound;
        const T own = two_sum<T>(a.value, b.value).error;
        const with_error<T> inherited = two_sum<T>(a.bound.correction, b.bound.correction);
        const with_error<T> correction = two_sum<T>(own, inherited.value);
        const T first = Without == 1 ? T(0) : traits::abs(inherited.error);
        const T second = Without == 2 ? T(0) : traits::abs(correction.error);
        const T lost = first + second, factor = Without == 3 ? T(1) : 1 + 8 * traits::epsilon();
        const T remainder =
            detail::sum_of_bounds<T>(((a.bound.remainder + b.bound.remainder) + lost) * factor,
                                     lost * factor, a.bound.remainder, b.bound.remainder);
        return {correction.value, remainder + (v - v)};
    }
    template <class T>
    static bound<T> subtract(const T& v, rule_operand<T, Self> a, rule_operand<T, Self> b) {
        const T value = -b.value;
        if (Without == 5) return errbound::residual::add<T>(v, Self::original(a), {value, b.bound});
        return errbound::residual::subtract<T>(v, Self::original(a), Self::original(b));
    }
    template <class T>
    static bound<T> multiply(const T& v, rule_operand<T, Self> a, rule_operand<T, Self> b) {
        const bound<T> used{b.bound.correction, Without == 6 ? T(0) : b.bound.remainder};
        bound<T> product = errbound::residual::multiply<T>(v, Self::original(a), {b.value, used});
        const bool exact = a.bound.correction == 0 && a.bound.remainder == 0 &&
                           b.bound.correction == 0 && b.bound.remainder == 0;
        if (Without == 9 && exact) product.remainder = T(0);  // error unknown
        return product;
    }
    template <class T>
    static bound<T> divide(const T& v, rule_operand<T, Self> a, rule_operand<T, Self> b) {
        const bound<T> used{b.bound.correction, Without == 7 ? T(0) : b.bound.remainder};
        return errbound::residual::divide<T>(v, Self::original(a), {b.value, used});
    }
    template <class T>
    static bound<T> scale(const T& v, rule_operand<T, Self> a, int e) {
        using traits = number_traits<T>;
        if (Without == 8)
            return {traits::scale(a.bound.correction, e),
                    traits::scale(a.bound.remainder, e) + (v - v)};
        return errbound::residual::scale<T>(v, Self::original(a), e);
    }
    template <class T>
    static errbound::sign_type sign(const T& v, const bound<T>& b) {
        if (Without == 4) return errbound::residual::sign<T>(v, {T(0), b.remainder});
        return errbound::residual::sign<T>(v, b);
    }
};

}  // namespace tie_mutants
