// The tracked scalar: a value and a certified bound on its rounding error.
//
//   using number = errbound::tracked<double>;            // rule `tight`
//   number x = 0.1, y = number::within(0.2, 1e-12);      // exact; known to within 1e-12
//   sign_of(x * y - x);                                  // never a guess
//
// A literal is the double nearest to it: 0.1 above means that double, not a tenth. No exceptions,
// no allocation, no global state, no virtual calls. For x of any rule that promises a bound
// (promises_bound in rules/rule.hpp: all of these but `none`), in a sound environment
// (environment.hpp): the number that exact arithmetic would have given lies within x.error() of
// x.value().
#pragma once

#include <algorithm>
#include <concepts>
#include <errbound/detail/rounded.hpp>
#include <errbound/number_traits.hpp>
#include <errbound/rules/interval.hpp>
#include <errbound/rules/none.hpp>
#include <errbound/rules/residual.hpp>
#include <errbound/rules/rule.hpp>
#include <errbound/rules/safe.hpp>
#include <errbound/rules/sharp.hpp>
#include <errbound/rules/tight.hpp>
#include <errbound/sign.hpp>
#include <limits>

namespace errbound {

/// T: float, double, long double or any type with the same operations and a number_traits.
/// Rule: how bounds propagate, a bound_rule (errbound/rules/rule.hpp says what that is).
template <class T = double, class Rule = tight>
class tracked {
    static_assert(!std::is_integral_v<T> && std::is_same_v<T, std::remove_cvref_t<T>>,
                  "errbound: the first argument of tracked is a floating-point type, float or "
                  "double, or one of your own with a number_traits");
    static_assert(bound_rule<Rule, T> || sizeof(detail::rule_check<Rule, T>) == 0,
                  "errbound: the second argument of tracked is a bound rule");
    static_assert(
        has_subnormals<T> || detail::holds_without_subnormals<Rule>,
        "errbound: this number type has no subnormal numbers, so that sums may underflow, "
        "which this bound rule does not count; use the rule `tight`");

  public:
    using value_type = T;
    using rule_type = Rule;
    using bound_type = typename Rule::template bound<T>;

    /// Exactly zero.
    constexpr tracked() : tracked(T(0)) {}
    /// Exactly `value`. Implicit, so that generic code may mix numbers and tracked numbers.
    constexpr tracked(const T& value) : tracked(exactly(detail::rounded(value))) {}
    /// `value`, for literals such as 2: exact if T holds it (every int in double, up to 2^24 in
    /// float), else within the rounding error of its conversion.
    constexpr tracked(int value) requires(!std::same_as<T, int>) : tracked(from_int(value)) {}
    /// A number that is known to lie within `error` of `value`; unknown unless error >= 0.
    static constexpr tracked within(const T& value, const T& error) {
        const T v = detail::rounded(value);
        return {v, Rule::within(v, error)};
    }
    /// `value` with what the rule has said of it, for rules that wrap others: bound() of a number
    /// of that value.
    static constexpr tracked from_bound(const T& value, const bound_type& bound) {
        return {value, bound};
    }

    /// The value that plain arithmetic would have computed.
    constexpr const T& value() const { return value_; }
    /// An upper bound of |value() − exact value|; infinity or NaN where nothing is known.
    constexpr T error() const { return Rule::error(value_, bound_); }
    /// What the rule stores, for those who study bounds.
    constexpr const bound_type& bound() const { return bound_; }

    friend constexpr tracked operator+(const tracked& a, const tracked& b) {
        const T v = a.value_ + b.value_;
        return {v, Rule::template add<T>(v, a.as_operand(), b.as_operand())};
    }
    friend constexpr tracked operator-(const tracked& a, const tracked& b) {
        const T v = a.value_ - b.value_;
        return {v, Rule::template subtract<T>(v, a.as_operand(), b.as_operand())};
    }
    friend constexpr tracked operator*(const tracked& a, const tracked& b) {
        const T v = detail::rounded_product(a.value_, b.value_);
        return {v, Rule::template multiply<T>(v, a.as_operand(), b.as_operand())};
    }
    /// Does not compile for a rule without division. Unknown where b may be zero.
    friend constexpr tracked operator/(const tracked& a, const tracked& b) {
        static_assert(detail::rule_has_divide<Rule, T>,
                      "errbound: this bound rule has no divide(result, a, b)");
        const T v = a.value_ / b.value_;
        return {v, Rule::template divide<T>(v, a.as_operand(), b.as_operand())};
    }
    constexpr tracked operator-() const {
        if constexpr (requires { Rule::negate(bound_); })
            return {-value_, Rule::negate(bound_)};
        else
            return {-value_, bound_};
    }
    constexpr tracked operator+() const { return *this; }
    constexpr tracked& operator+=(const tracked& b) { return *this = *this + b; }
    constexpr tracked& operator-=(const tracked& b) { return *this = *this - b; }
    constexpr tracked& operator*=(const tracked& b) { return *this = *this * b; }
    constexpr tracked& operator/=(const tracked& b) { return *this = *this / b; }

    /// x·2^e: exact unless it underflows, and then the bound says so.
    friend constexpr tracked scale(const tracked& x, int e) {
        const int power = std::max(e, -std::numeric_limits<int>::max());  // rules negate it
        const T v = number_traits<T>::scale(x.value_, power);
        return {v, Rule::template scale<T>(v, x.as_operand(), power)};
    }

    /// The certain sign; the rule's own where it has one. Strict: a value that equals its bound may
    /// belong to zero. Proof of the default: proofs/IeeeRules.v, sign_of_known.
    friend constexpr sign_type sign_of(const tracked& x) {
        if constexpr (detail::rule_has_sign<Rule, T>) return Rule::sign(x.value_, x.bound_);
        const T e = x.error();
        if (x.value_ > e) return sign_type::positive;
        if (x.value_ < -e) return sign_type::negative;
        return x.value_ == 0 && e == 0 ? sign_type::zero : sign_type::uncertain;
    }
    /// The certain sign of a − b. There is no operator<: it would have to guess. For choices that
    /// may be wrong without harm there is by_value.
    friend constexpr sign_type compare(const tracked& a, const tracked& b) {
        return sign_of(a - b);
    }

  private:
    static constexpr tracked exactly(const T& value) { return {value, Rule::exact(value)}; }
    static constexpr tracked from_int(int value) {
        using traits = number_traits<T>;
        const T converted = static_cast<T>(value);
        // |value| <= 2^31, so that the way back fits a long long, unless it overflowed.
        if (!traits::is_finite(converted)) return tracked(converted);
        if (static_cast<long long>(converted) == value) return tracked(converted);
        return within(converted, 2 * traits::epsilon() * traits::abs(converted));
    }

    constexpr tracked(const T& value, const bound_type& bound) : value_(value), bound_(bound) {}
    constexpr rule_operand<T, Rule> as_operand() const { return {value_, bound_}; }

    T value_;
    [[no_unique_address]] bound_type bound_;
};

/// Orders tracked numbers by their values alone, NaN last: for choices that may be wrong without
/// harm, as of pivots, or for sorting. std::sort(begin, end, errbound::by_value{}).
struct by_value {
    /// Whether a comes before b.
    template <class T, class Rule>
    constexpr bool operator()(const tracked<T, Rule>& a, const tracked<T, Rule>& b) const {
        return a.value() < b.value() || (a.value() == a.value() && !(b.value() == b.value()));
    }
};

/// Whether generic code may treat it as a tracked number: it has value_type, value(), sign_of and
/// scale. Specialise for a type that wraps one.
template <class>
inline constexpr bool is_tracked = false;
template <class T, class Rule>
inline constexpr bool is_tracked<tracked<T, Rule>> = true;

}  // namespace errbound

/// Those of T; numbers are exact.
template <class T, class Rule>
struct std::numeric_limits<errbound::tracked<T, Rule>> : std::numeric_limits<T> {
  private:
    using of_value = std::numeric_limits<T>;
    using number = errbound::tracked<T, Rule>;

  public:
    static constexpr bool is_iec559 = false;
    static constexpr number min() noexcept { return of_value::min(); }
    static constexpr number max() noexcept { return of_value::max(); }
    static constexpr number lowest() noexcept { return of_value::lowest(); }
    static constexpr number epsilon() noexcept { return of_value::epsilon(); }
    static constexpr number round_error() noexcept { return of_value::round_error(); }
    static constexpr number infinity() noexcept { return of_value::infinity(); }
    static constexpr number quiet_NaN() noexcept { return of_value::quiet_NaN(); }
    static constexpr number signaling_NaN() noexcept { return of_value::signaling_NaN(); }
    static constexpr number denorm_min() noexcept { return of_value::denorm_min(); }
};
