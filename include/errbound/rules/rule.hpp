// Bound rules: how a certified bound passes through operations.
//   struct my_rule {
//       static constexpr const char* name = "my_rule";
//       template <class T> struct bound { T error; };
//       // exact, within, error, add, subtract, multiply, scale: see bound_rule below
//   };
//   using number = errbound::tracked<double, my_rule>;
//
// If a member is missing, the compiler names it. Examples are examples/own_rule.cpp, which is
// short, and rules/tight.hpp. To change one operation of a rule, derive from it
// (rules/derived.hpp).
#pragma once

#include <concepts>
#include <cstdint>
#include <errbound/number_traits.hpp>
#include <errbound/sign.hpp>

namespace errbound {

/// An operand's value and its bound by the same rule. Valid only during the rule's call.
template <class T, class Rule>
struct rule_operand {
    const T& value;
    const typename Rule::template bound<T>& bound;
};

enum class error_meaning : std::uint8_t {
    bound,     ///< at least |value − exact value|; certain signs are right
    estimate,  ///< about |value − exact value|; signs follow it and may be wrong
    nothing,   ///< zero for every finite value: signs are guesses
};

template <class Rule>
inline constexpr error_meaning meaning_of_error = [] {
    if constexpr (requires { Rule::error_is; })
        return Rule::error_is;
    else
        return error_meaning::bound;
}();

/// The probability with which the rule claims that an estimate covers the error; 0 if none.
template <class Rule>
inline constexpr double claimed_rate = [] {
    if constexpr (requires { Rule::claimed_rate; })
        return Rule::claimed_rate;
    else
        return 0.0;
}();

/// True if the errors of the rule are bounds, neither estimates nor always zero.
template <class Rule>
inline constexpr bool promises_bound = meaning_of_error<Rule> == error_meaning::bound;

namespace detail {

template <class Rule, class T>
concept rule_has_bound = requires {
    typename Rule::template bound<T>;
};
template <class X, class Rule, class T>
concept bound_of = std::same_as<X, typename Rule::template bound<T>>;
template <class Rule, class T>
concept rule_has_name = requires {
    { Rule::name } -> std::convertible_to<const char*>;
};
template <class Rule, class T>
concept rule_has_exact = requires(const T& value) {
    { Rule::template exact<T>(value) } -> bound_of<Rule, T>;
};
template <class Rule, class T>
concept rule_has_within = requires(const T& value) {
    { Rule::template within<T>(value, value) } -> bound_of<Rule, T>;
};
template <class Rule, class T>
concept rule_has_error = requires(const T& value, const typename Rule::template bound<T>& bound) {
    { Rule::template error<T>(value, bound) } -> std::convertible_to<T>;
};
template <class Rule, class T>
concept rule_has_add = requires(const T& result, rule_operand<T, Rule> a) {
    { Rule::template add<T>(result, a, a) } -> bound_of<Rule, T>;
};
template <class Rule, class T>
concept rule_has_subtract = requires(const T& result, rule_operand<T, Rule> a) {
    { Rule::template subtract<T>(result, a, a) } -> bound_of<Rule, T>;
};
template <class Rule, class T>
concept rule_has_multiply = requires(const T& result, rule_operand<T, Rule> a) {
    { Rule::template multiply<T>(result, a, a) } -> bound_of<Rule, T>;
};
template <class Rule, class T>
concept rule_has_divide = requires(const T& result, rule_operand<T, Rule> a) {
    { Rule::template divide<T>(result, a, a) } -> bound_of<Rule, T>;
};
template <class Rule, class T>
concept rule_has_scale = requires(const T& result, rule_operand<T, Rule> a) {
    { Rule::template scale<T>(result, a, 1) } -> bound_of<Rule, T>;
};
template <class Rule, class T>
concept rule_has_sign = requires(const T& value, const typename Rule::template bound<T>& bound) {
    Rule::sign(value, bound);
};
template <class Rule, class T>
concept rule_sign_is_one = !rule_has_sign<Rule, T> ||
                           requires(const T& value, const typename Rule::template bound<T>& bound) {
    { Rule::sign(value, bound) } -> std::same_as<sign_type>;
};

template <class Rule, class T>
concept rule_has_displacement = requires(const T& value) {
    { Rule::template displacement<T>(value) } -> bound_of<Rule, T>;
};
template <class Rule, class T>
concept rule_has_correction = requires(const T& value,
                                       const typename Rule::template bound<T>& bound) {
    { Rule::template correction<T>(value, bound) } -> std::convertible_to<T>;
};

template <class Rule, class T>
concept rule_has_dot = requires(typename Rule::template dot_bound<T> so_far, const T& value,
                                rule_operand<T, Rule> a) {
    so_far.add_product(value, value, value, a, a);
    { so_far.finished(value) } -> bound_of<Rule, T>;
};

template <class Rule, class T>
concept rule_has_square_root = requires(const T& value, rule_operand<T, Rule> a) {
    { Rule::template square_root<T>(value, a) } -> bound_of<Rule, T>;
};
template <class Rule, class T>
concept rule_has_fused = requires(const T& value, rule_operand<T, Rule> a) {
    { Rule::template fused<T>(value, a, a, a) } -> bound_of<Rule, T>;
};

template <class Rule>
inline constexpr bool keeps_first_order = [] {
    if constexpr (requires { Rule::keeps_first_order; })
        return Rule::keeps_first_order;
    else
        return false;
}();

template <class Rule>
inline constexpr bool holds_without_subnormals = [] {
    if constexpr (requires { Rule::holds_without_subnormals; })
        return Rule::holds_without_subnormals;
    else
        return false;
}();

template <class Rule, class T>
struct rule_check {
    static_assert(rule_has_bound<Rule, T>,
                  "errbound: a bound rule needs a template bound<T>, its state for a value");
    static_assert(rule_has_name<Rule, T>, "errbound: a bound rule needs a name, a string");
    static_assert(rule_has_exact<Rule, T>,
                  "errbound: a bound rule needs exact(value), which returns bound<T>");
    static_assert(rule_has_within<Rule, T>,
                  "errbound: a bound rule needs within(value, error), which returns bound<T>");
    static_assert(rule_has_error<Rule, T>,
                  "errbound: a bound rule needs error(value, bound), which returns T");
    static_assert(rule_has_add<Rule, T>,
                  "errbound: a bound rule needs add(result, a, b), which returns bound<T>");
    static_assert(rule_has_subtract<Rule, T>,
                  "errbound: a bound rule needs subtract(result, a, b), which returns bound<T>");
    static_assert(rule_has_multiply<Rule, T>,
                  "errbound: a bound rule needs multiply(result, a, b), which returns bound<T>");
    static_assert(rule_has_scale<Rule, T>,
                  "errbound: a bound rule needs scale(result, a, e), which returns bound<T>");
    static_assert(rule_sign_is_one<Rule, T>,
                  "errbound: a bound rule's sign(value, bound) returns a sign_type");
};

}  // namespace detail

// A rule may use + − × ÷ of T (no a += b), negation, comparisons, construction from int,
// number_traits<T>. All members are static. Functions are templates over T, called as
// Rule::add<T>(result, a, b); for exact, within, error, negate, sign and is_crowded, T is deduced,
// too. Operands a, b and c are rule_operand<T, Rule>. Functions are usually constexpr.
//   name                                    for tables and messages
//   template <class T> struct bound         the state stored with a value, of any size
//   exact(value)                            the bound of an exact number
//   within(value, error)                    the bound of a number within error of value
//   error(value, bound)                     at least |value − exact value|; infinity or NaN if
//                                           unbounded, or if value is not finite.
//   add, subtract, multiply(result, a, b)   the bound of the rounded result of a ∘ b
//   divide(result, a, b)                    as above; omit it if the rule has no division
//   scale(result, a, e)                     the bound of result = a·2^e, rounded once
// Optional, with defaults:
//   negate(bound)                           the bound of −value; default: the same bound
//   sign(value, bound)                      the certain sign; default: that of value if |value| >
//                                           error, zero if both are 0, otherwise uncertain.
//   correction(value, bound)                the known part of the difference exact value − value,
//                                           at most error(value, bound) in size; default: 0
//   square_root(result, a)                  the bound of the rounded √a, unknown if a may be
//                                           negative; default: from the error of a
//   fused(result, a, b, c)                  the bound of ab + c, rounded once; default: from errors
//   keeps_first_order                       true if bounds store signed errors (residual) or
//                                           sources of errors (affine). tracked then also bounds
//                                           √a and ab + c by add, subtract, multiply and divide,
//                                           unless the rule has square_root or fused. The better
//                                           bound counts (functions.hpp).
//   is_crowded(bound)                       with keeps_first_order: true if the bound has no room
//                                           for another source; √a then becomes one new source.
//   displacement(value)                     the bound of a number with this value whose exact
//                                           value is 0. Numbers of 8 and 16 bits then have bounds
//                                           in float: tracked adds the error of rounding the result
//   template <class T> class dot_bound      bounds s = 0, s += ab, ...: a call of
//                                           add_product(ab, s before, s after, a, b) per step,
//                                           then finished(s), which returns bound<T>
//   minimal_precision                       the bits of T that the proof needs
//   has_division                            false if `divide` only stops compilation, with a reason
//   holds_in_directed_rounding              true if the proof holds in any rounding direction
//   holds_without_subnormals                true if the rule also holds without subnormal numbers
//   error_is                                error_meaning::estimate or nothing
//   claimed_rate                            the claimed probability that estimates cover the error

/// True if Rule is a bound rule for T, with the members in the table above. Soundness (bounds that
/// hold) needs a proof; errbound/validation tests it.
template <class Rule, class T = double>
concept bound_rule = detail::rule_has_bound<Rule, T> && detail::rule_has_name<Rule, T> &&
    detail::rule_has_exact<Rule, T> && detail::rule_has_within<Rule, T> &&
    detail::rule_has_error<Rule, T> && detail::rule_has_add<Rule, T> &&
    detail::rule_has_subtract<Rule, T> && detail::rule_has_multiply<Rule, T> &&
    detail::rule_has_scale<Rule, T> && detail::rule_sign_is_one<Rule, T>;

}  // namespace errbound
