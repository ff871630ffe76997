// What a bound rule sees of an operand: its value and the bound that the rule itself gave it.
//
// A bound rule is a type with
//   name                                         a string, for tables and messages
//   template <class T> struct bound              what it stores beside a value
//   exact(value)                                 the bound of a number that is exact
//   within(value, error)                         of a number known to be within error of value
//   error(value, bound)                          an upper bound of |value − true value|;
//                                                infinity or NaN: nothing is known
//   add, subtract, multiply(result, a, b)        the bound of the rounded result of a ∘ b
//   divide(result, a, b)                         likewise; leave it out if the rule has none
//   scale(result, a, e)                          the bound of result = a·2^e, rounded once; asked
//                                                for by polynomials and BSC only
// and, only where the defaults do not serve,
//   negate(bound)                                the bound of −value; default: the same bound
//   sign(value, bound)                           the certain sign, for a rule that knows more than
//                                                |value − true value| <= error; default: what value
//                                                and error tell. Uncertain where value or error is
//                                                not finite; zero only if the true value is zero
//   minimal_precision                            the number of bits of T that the proof needs
//   has_division                                 false where `divide` only says why there is none
//   holds_in_directed_rounding                   true where the proof does not need rounding to
//                                                nearest: validation then tries every direction
// All are static; see rules/tight.hpp for one that fits on a page, and examples/own_rule.cpp.
#pragma once

#include <errbound/number_traits.hpp>

namespace errbound {

/// References: valid during the rule's call only.
template <class T, class Rule>
struct operand {
    const T& value;
    const typename Rule::template bound<T>& bound;
};

}  // namespace errbound
