// The tracked scalar: a value and a certified bound on its rounding error.
//   using number = errbound::tracked<double>;            // rule `tight`
//   number x = 0.1, y = number::within(0.2, 1e-12);      // exact; known to within 1e-12
//   sign_of(x * y - x);                                  // never a guess
//
// In a sound environment (environment.hpp), the result x of exact arithmetic lies within x.error()
// of x.value(). This holds under every rule for which promises_bound (rules/rule.hpp) is true. A
// literal is the double nearest to it: 0.1 above is that double, not a tenth. No exceptions and no
// virtual calls; except under `affine` and `explained`, no allocation and no global state.
#pragma once

#include <algorithm>
#include <concepts>
#include <errbound/detail/bits.hpp>
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
#include <type_traits>

namespace errbound {

namespace detail {

/// A built-in arithmetic type, other than bool and T, that converts to and from T.
template <class Number, class T>
concept number_other_than =
    !std::same_as<Number, T> && !std::same_as<Number, bool> && !std::is_class_v<Number> &&
    !std::is_enum_v<Number> && requires(const Number& x, const T& converted) {
    static_cast<T>(x);
    static_cast<Number>(converted);
};

/// True if `value` was converted to v exactly, or if v is not finite.
template <class T, class Number>
constexpr bool is_exactly(const T& v, Number value) {
    using traits = number_traits<T>;
    if (!traits::is_finite(v)) return true;
    if constexpr (static_cast<Number>(0.5) != Number(0)) {
        return static_cast<Number>(v) == value;  // exact: one type holds the other's numbers
    } else {
        static_assert(std::integral<Number>, "errbound: this integer type is not built in");
        // A conversion back may overflow, so count bits. Trailing zeros need no digits.
        if constexpr (std::numeric_limits<Number>::digits <= traits::digits) return true;
        using bits = std::make_unsigned_t<Number>;
        const bits size = value < 0 ? bits(bits(0) - bits(value)) : bits(value);
        return detail::bit_width(size) - detail::countr_zero(size) <= traits::digits;
    }
}

/// The type in which Rule stores bounds of T's numbers. For 8- and 16-bit T it is the type that
/// computes T's operations, float, if the rule has a `displacement` (see rounded_from). Bounds of
/// at most 11 bits would grow with each of their own roundings.
template <class T, class Rule>
struct type_of_bounds {
    using type = T;
};
template <class T, class Rule>
requires rule_has_displacement<Rule, typename type_that_computes<T>::type>
struct type_of_bounds<T, Rule> {
    using type = typename type_that_computes<T>::type;
};
template <class T, class Rule>
inline constexpr bool bounds_are_wider = !std::is_same_v<typename type_of_bounds<T, Rule>::type, T>;

struct use_compare_or_by_value;  // the name appears in the compiler's message
struct use_sign_of_or_compare {};

}  // namespace detail

/// T: any type with a number_traits. Rule: how bounds propagate (errbound/rules/rule.hpp).
template <class T = double, class Rule = tight>
class tracked {
    static_assert(!std::is_integral_v<T> && std::is_same_v<T, std::remove_cvref_t<T>>,
                  "errbound: the first argument of tracked must be a floating-point type: "
                  "float, double, or a custom type with a number_traits");
    static_assert(bound_rule<Rule, T> || sizeof(detail::rule_check<Rule, T>) == 0,
                  "errbound: the second argument of tracked must be a bound rule");
    static_assert(
        has_subnormals<T> || detail::holds_without_subnormals<Rule>,
        "errbound: this number type has no subnormal numbers, so sums may underflow, which this "
        "bound rule does not cover; use the rule `tight`");

  public:
    using value_type = T;
    using rule_type = Rule;
    using bound_type =
        typename Rule::template bound<typename detail::type_of_bounds<T, Rule>::type>;

    constexpr tracked() : tracked(T(0)) {}
    /// Exactly `value`. Implicit, so that generic code may mix numbers and tracked numbers.
    constexpr tracked(const T& value) : tracked(exactly(detail::rounded(value))) {}
    /// Converts a number of another type, such as the literal 2. Exact if T holds it (every int in
    /// double, up to 2^24 in float); otherwise the error bounds the conversion's rounding.
    template <detail::number_other_than<T> Number>
    constexpr tracked(Number value) : tracked(from_other(value)) {}
    /// A number known to lie within `error` of `value`. The error is infinite unless error >= 0.
    static constexpr tracked within(const T& value, const T& error) {
        const T v = detail::rounded(value);
        return {v, Rule::within(wide(v), wide(error))};
    }
    /// A number with this bound(), for rules that wrap others.
    static constexpr tracked from_bound(const T& value, const bound_type& bound) {
        return {value, bound};
    }

    /// The result of plain arithmetic.
    constexpr const T& value() const { return value_; }
    /// An upper bound of |value() − exact value|, if promises_bound<Rule>. If no bound is known,
    /// the error is infinite (NaN in a format without infinities), so `x.error() <= tolerance` is
    /// false. In all other cases it is not NaN.
    constexpr T error() const {
        const wide e = own_error();
        if constexpr (widens) {
            const T nearest(e);
            if (wide(nearest) < e)  // ε·nearest + η is at least a unit in its last place
                return nearest +
                       (nearest * number_traits<T>::epsilon() + number_traits<T>::underflow_unit());
            return e == e ? nearest : number_traits<T>::infinity();
        } else {
            return e == e ? e : number_traits<T>::infinity();
        }
    }
    /// The rule's own state, for studying bounds.
    constexpr const bound_type& bound() const { return bound_; }

    friend constexpr tracked operator+(const tracked& a, const tracked& b) {
        const T v = a.value_ + b.value_;
        if constexpr (widens)
            return rounded_from(v, a.widened() + b.widened());
        else
            return {v, Rule::template add<T>(v, a.as_operand(), b.as_operand())};
    }
    friend constexpr tracked operator-(const tracked& a, const tracked& b) {
        const T v = a.value_ - b.value_;
        if constexpr (widens)
            return rounded_from(v, a.widened() - b.widened());
        else
            return {v, Rule::template subtract<T>(v, a.as_operand(), b.as_operand())};
    }
    friend constexpr tracked operator*(const tracked& a, const tracked& b) {
        const T v = detail::rounded_product(a.value_, b.value_);
        if constexpr (widens)
            return rounded_from(v, a.widened() * b.widened());
        else
            return {v, Rule::template multiply<T>(v, a.as_operand(), b.as_operand())};
    }
    /// Does not compile for a rule without division. The error is infinite if b may be zero.
    friend constexpr tracked operator/(const tracked& a, const tracked& b) {
        static_assert(detail::rule_has_divide<Rule, T>,
                      "errbound: this bound rule has no divide(result, a, b)");
        const T v = a.value_ / b.value_;
        if constexpr (widens)
            return rounded_from(v, a.widened() / b.widened());
        else
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

    /// x·2^e. Exact unless it underflows; then the bound includes the loss.
    friend constexpr tracked scale(const tracked& x, int e) {
        const int power = (std::max)(e, -(std::numeric_limits<int>::max)());  // rules negate it
        const T v = number_traits<T>::scale(x.value_, power);
        if constexpr (widens)
            return rounded_from(v, scale(x.widened(), power));
        else
            return {v, Rule::template scale<T>(v, x.as_operand(), power)};
    }

    /// The certain sign, if promises_bound<Rule>, by the rule's own `sign` if it has one.
    /// `uncertain` if the bound allows more than one sign, also if |value| equals a nonzero error.
    /// Proof of the default: proofs/rules/IeeeRules.v, sign_of_known.
    friend constexpr sign_type sign_of(const tracked& x) {
        const wide v(x.value_);
        if constexpr (detail::rule_has_sign<Rule, wide>) return Rule::sign(v, x.bound_);
        const wide e = x.own_error();  // comparisons with NaN are false
        if (v > e) return sign_type::positive;
        if (v < -e) return sign_type::negative;
        return v == 0 && e == 0 ? sign_type::zero : sign_type::uncertain;
    }
    /// The sign of a − b. Operator < is deleted, as it would have to guess; see by_value.
    friend constexpr sign_type compare(const tracked& a, const tracked& b) {
        return sign_of(a - b);
    }
    friend detail::use_compare_or_by_value operator<=>(const tracked&, const tracked&) = delete;

  private:
    static constexpr bool widens = detail::bounds_are_wider<T, Rule>;
    using wide = typename detail::type_of_bounds<T, Rule>::type;

    static constexpr tracked exactly(const T& value) { return {value, Rule::exact(wide(value))}; }
    constexpr wide own_error() const { return Rule::error(wide(value_), bound_); }
    constexpr tracked<wide, Rule> widened() const requires widens {
        return tracked<wide, Rule>::from_bound(wide(value_), bound_);
    }
    /// Replaces x's value by v; the exact number stays. Adds to x a number with the value d = v −
    /// x.value() whose exact number is 0. Infinite error if the sum's value is not v.
    static constexpr tracked rounded_from(const T& v,
                                          const tracked<wide, Rule>& x) requires widens {
        const wide d = wide(v) - x.value();
        if (d == 0) return {v, x.bound()};
        const auto sum =
            x + tracked<wide, Rule>::from_bound(d, Rule::template displacement<wide>(d));
        if (sum.value() == wide(v)) return {v, sum.bound()};
        return {v, Rule::within(wide(v), number_traits<wide>::infinity())};
    }
    template <class Number>
    static constexpr tracked from_other(Number value) {
        using traits = number_traits<T>;
        const T v = detail::rounded(static_cast<T>(value));
        if (detail::is_exactly<T>(v, value)) return exactly(v);
        // In some rounding directions an overflow gives the largest number.
        if (traits::abs(v) == traits::largest()) return within(v, traits::infinity());
        // One rounding is off by at most ε|v| in any direction, two by less than 2ε|v|.
        const T relative = detail::rounded_product(traits::abs(v), T(2 * traits::epsilon()));
        return within(v, T(relative + traits::underflow_unit()));
    }

    constexpr tracked(const T& value, const bound_type& bound) : value_(value), bound_(bound) {}
    constexpr rule_operand<T, Rule> as_operand() const { return {value_, bound_}; }

    T value_;
    [[no_unique_address]] bound_type bound_;
};

/// Deleted, as == would have to guess. Test sign_of(x) == sign_type::zero (certainly zero) or
/// x.value() == 0. (errbound/eigen.hpp defines == of two tracked numbers.)
template <class T, class Rule, class Number>
detail::use_sign_of_or_compare operator==(const tracked<T, Rule>&, const Number&) = delete;

/// Orders tracked numbers by value, NaN last. For pivoting, sorting and other choices that may be
/// wrong without harm: std::sort(begin, end, errbound::by_value{}).
struct by_value {
    template <class T, class Rule>
    constexpr bool operator()(const tracked<T, Rule>& a, const tracked<T, Rule>& b) const {
        return a.value() < b.value() || (a.value() == a.value() && !(b.value() == b.value()));
    }
};

/// True if generic code may treat the type as a tracked number: it has value_type, value(), sign_of
/// and scale. Specialise it for a type that wraps a tracked number.
template <class>
inline constexpr bool is_tracked = false;
template <class T, class Rule>
inline constexpr bool is_tracked<tracked<T, Rule>> = true;

}  // namespace errbound

/// Same as numeric_limits<T>, except is_iec559. Finite constants have zero error, others infinite.
template <class T, class Rule>
struct std::numeric_limits<errbound::tracked<T, Rule>> : std::numeric_limits<T> {
  private:
    using of_value = std::numeric_limits<T>;
    using number = errbound::tracked<T, Rule>;

  public:
    static constexpr bool is_iec559 = false;
    static constexpr number(min)() noexcept { return (of_value::min)(); }
    static constexpr number(max)() noexcept { return (of_value::max)(); }
    static constexpr number lowest() noexcept { return of_value::lowest(); }
    static constexpr number epsilon() noexcept { return of_value::epsilon(); }
    static constexpr number round_error() noexcept { return of_value::round_error(); }
    static constexpr number infinity() noexcept { return of_value::infinity(); }
    static constexpr number quiet_NaN() noexcept { return of_value::quiet_NaN(); }
    static constexpr number signaling_NaN() noexcept { return of_value::signaling_NaN(); }
    static constexpr number denorm_min() noexcept { return of_value::denorm_min(); }
};
