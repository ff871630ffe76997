// What a bound rule is: how a certified bound passes through operations.
//
// A type with
//   name                                         a string, for tables and messages
//   template <class T> struct bound              what it stores beside a value
//   exact(value)                                 the bound of a number that is exact
//   within(value, error)                         of a number known to be within error of value
//   error(value, bound)                          an upper bound of |value − true value|;
//                                                infinity or NaN: nothing is known
//                                                (tracked::error() returns infinity for both)
//   add, subtract, multiply(result, a, b)        the bound of the rounded result of a ∘ b
//   divide(result, a, b)                         likewise; leave it out if the rule has none
//   scale(result, a, e)                          the bound of result = a·2^e, rounded once
// and, only where the defaults do not serve,
//   negate(bound)                                the bound of −value; default: the same bound
//   sign(value, bound)                           the certain sign, for a rule that knows more than
//                                                |value − true value| <= error; default: what value
//                                                and error tell. Uncertain where value or error is
//                                                not finite; zero only if the true value is zero
//   correction(value, bound)                     what the rule knows of true value − value,
//                                                signed and no larger than the error; default: 0
//   square_root(result, a)                       the bound of the rounded √a, unknown where a may
//                                                be negative; default: what the error of a tells
//   fused(result, a, b, c)                       the bound of ab + c, rounded once; default: what
//                                                the errors of a, b and c tell
//   keeps_first_order                            true where the rule keeps errors with their signs
//                                                or sources: √a and ab + c are then made of the
//                                                rule's operations, which `divide` is among
//   is_crowded(bound)                            of such a rule: true where √a is better one source
//   displacement(value)                          the bound of a number of that value that is known
//                                                to be 0: with it, bounds of numbers of 8 and 16
//                                                bits are floats (tracked.hpp)
//   template <class T> class dot_bound           what bounds s = 0, s += ab, s += cd, ... better
//                                                than one operation after the other: for each step
//                                                add_product(ab, s before, s after, a, b), at the
//                                                end finished(s), which returns bound<T>
//   minimal_precision                            the number of bits of T that the proof needs
//   has_division                                 false where `divide` only says why there is none
//   holds_in_directed_rounding                   true where the proof does not need rounding to
//                                                nearest: validation then tries every direction
//   holds_without_subnormals                     true where sums may underflow: T then is a type
//                                                without gradual underflow
//   error_is                                     error_meaning::estimate or nothing, where no
//                                                bound is promised
//   claimed_rate                                 of an estimate: the probability, by what it is
//                                                made for, that the error is no larger
// Of T a rule may use + − × ÷ (with two operands: a += b is not in every type), negation,
// comparisons, construction from int and what number_traits<T> has. All are static; see
// rules/tight.hpp for one that fits on a page, and examples/own_rule.cpp. A rule that differs from
// another in a part is derived from it: rules/derived.hpp. The state may be of any size, terms by
// source for instance: rules/affine.hpp.
#pragma once

#include <concepts>
#include <cstdint>
#include <errbound/number_traits.hpp>
#include <errbound/sign.hpp>

namespace errbound {

/// What a rule sees of an operand: its value and the bound that the rule itself gave it.
/// References: valid during the rule's call only.
template <class T, class Rule>
struct rule_operand {
    const T& value;
    const typename Rule::template bound<T>& bound;
};

/// What a rule means by its error().
enum class error_meaning : std::uint8_t {
    bound,     ///< |value − true value| is no more; a certain sign is the true one
    estimate,  ///< about as large as |value − true value|; signs go by it, and may be wrong
    nothing,   ///< zero whatever the true error: signs are guesses
};

template <class Rule>
inline constexpr error_meaning meaning_of_error = [] {
    if constexpr (requires { Rule::error_is; })
        return Rule::error_is;
    else
        return error_meaning::bound;
}();

/// The probability that a rule claims for its estimates; 0 where it claims none, or promises more.
template <class Rule>
inline constexpr double claimed_rate = [] {
    if constexpr (requires { Rule::claimed_rate; })
        return Rule::claimed_rate;
    else
        return 0.0;
}();

/// Whether the rule promises a bound at all.
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

/// Says in words what a type lacks that is taken for a rule.
template <class Rule, class T>
struct rule_check {
    static_assert(
        rule_has_bound<Rule, T>,
        "errbound: a bound rule needs a template bound<T>, what it stores beside a value");
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

/// Whether Rule is a bound rule for numbers of type T, as the head of this file says. That its
/// bounds hold is for a proof and for errbound/validation.
template <class Rule, class T = double>
concept bound_rule = detail::rule_has_bound<Rule, T> && detail::rule_has_name<Rule, T> &&
    detail::rule_has_exact<Rule, T> && detail::rule_has_within<Rule, T> &&
    detail::rule_has_error<Rule, T> && detail::rule_has_add<Rule, T> &&
    detail::rule_has_subtract<Rule, T> && detail::rule_has_multiply<Rule, T> &&
    detail::rule_has_scale<Rule, T> && detail::rule_sign_is_one<Rule, T>;

}  // namespace errbound
