// A rule over a rule: records where the error of a tracked number comes from.
//   using number = errbound::tracked<double, errbound::explained<errbound::tight>>;
//   ... a computation, in scopes (scope.hpp) ...
//   std::cout << text_of(errbound::explain(x));        // a table (explanation.hpp)
//
// Values, bounds and signs are those of the wrapped rule, bit for bit. The explained error is the
// rule's bound, overestimation included. Numbers allocate; operations throw std::bad_alloc. Not for
// device code or SIMD packs. Cost: linear in the operands' sources, 0.1 µs for a sum or product
// with one source and 1.5 µs with 32 (docs/measured.md); 24 bytes per source (T double).
#pragma once

#include <array>
#include <cstddef>
#include <errbound/explain/ledger.hpp>
#include <errbound/functions.hpp>
#include <errbound/tracked.hpp>
#include <string_view>
#include <utility>

namespace errbound {

/// Rule: the wrapped rule. Limit: sources per number; the smallest beyond it become "the rest".
///
/// A source is a scope and a kind of operation. A result has the operands' contributions times
/// the derivative (1, the other factor, 1/b and v/b for v = a/b, 2^e), and the operation's own: the
/// rule's bound for exact operands. The rest of the bound is distributed in proportion. So
/// contributions add up to at least error(). With a `correction`, signed parts are carried too and
/// may cancel: they add up to the correction, and their sizes to error() or more.
///
/// To explain a derived rule (rules/derived.hpp), wrap it; do not derive from a wrapped one. A
/// function that returns tracked::within makes a new "input"; as_one_operation (functions.hpp)
/// keeps sources. Thread scheduling may change amounts by roundings.
template <class Rule = tight, std::size_t Limit = 64>
struct explained {
    static_assert(Limit > 0, "errbound: an explained number needs at least one source");

    static constexpr const char* name = Rule::name;
    static constexpr error_meaning error_is = meaning_of_error<Rule>;
    static constexpr bool has_division = detail::rule_divides<Rule, double>;
    static constexpr bool holds_without_subnormals = detail::holds_without_subnormals<Rule>;
    static constexpr bool holds_in_directed_rounding = [] {
        if constexpr (requires { Rule::holds_in_directed_rounding; })
            return Rule::holds_in_directed_rounding;
        else
            return false;
    }();
    static constexpr int minimal_precision = [] {
        if constexpr (requires { Rule::minimal_precision; })
            return Rule::minimal_precision;
        else
            return 2;
    }();

    using wrapped_rule = Rule;
    template <class T>
    using of_rule = typename Rule::template bound<T>;
    template <class T>
    using amount = detail::amount_of<T>;
    template <class T>
    using ledger = detail::ledger<amount<T>>;

    template <class T>
    struct bound {
        typename Rule::template bound<T> of_rule;
        ledger<T> contributions;
    };

    template <class T>
    static bound<T> exact(const T& value) {
        return from_outside<T>(value, Rule::template exact<T>(value));
    }
    template <class T>
    static bound<T> within(const T& value, const T& error) {
        return from_outside<T>(value, Rule::template within<T>(value, error));
    }
    template <class T>
    static bound<T> displacement(const T& value) requires detail::rule_has_displacement<Rule, T> {
        const auto b = Rule::template displacement<T>(value);
        return closed<T>(detail::operations::rounded, value, b, b, {});
    }
    template <class T>
    static constexpr T error(const T& value, const bound<T>& b) {
        return Rule::template error<T>(value, b.of_rule);
    }
    template <class T>
    static constexpr auto sign(const T& value,
                               const bound<T>& b) requires detail::rule_has_sign<Rule, T> {
        return Rule::sign(value, b.of_rule);
    }
    template <class T>
    static constexpr T correction(const T& value,
                                  const bound<T>& b) requires detail::rule_has_correction<Rule, T> {
        return Rule::template correction<T>(value, b.of_rule);
    }
    template <class T>
    static bound<T> negate(const bound<T>& b) {
        bound<T> result = b;
        if constexpr (requires { Rule::negate(b.of_rule); })
            result.of_rule = Rule::negate(b.of_rule);
        result.contributions.negate();
        return result;
    }

    template <class T>
    static bound<T> add(const T& v, rule_operand<T, explained> a, rule_operand<T, explained> b) {
        return booked<T>(
            detail::operations::plus, v, a, b,
            [&](auto x, auto y) { return Rule::template add<T>(v, x, y); },
            [](const amount<T>& x) { return x; }, [](const amount<T>& y) { return y; });
    }
    template <class T>
    static bound<T> subtract(const T& v, rule_operand<T, explained> a,
                             rule_operand<T, explained> b) {
        return booked<T>(
            detail::operations::minus, v, a, b,
            [&](auto x, auto y) { return Rule::template subtract<T>(v, x, y); },
            [](const amount<T>& x) { return x; }, [](const amount<T>& y) { return amount<T>(-y); });
    }
    template <class T>
    static bound<T> multiply(const T& v, rule_operand<T, explained> a,
                             rule_operand<T, explained> b) {
        const amount<T> of_a = static_cast<amount<T>>(a.value),
                        of_b = static_cast<amount<T>>(b.value);
        return booked<T>(
            detail::operations::times, v, a, b,
            [&](auto x, auto y) { return Rule::template multiply<T>(v, x, y); },
            [&](const amount<T>& x) { return amount<T>(x * of_b); },
            [&](const amount<T>& y) { return amount<T>(y * of_a); });
    }
    template <class T>
    static bound<T> divide(const T& v, rule_operand<T, explained> a,
                           rule_operand<T, explained> b) requires detail::rule_has_divide<Rule, T> {
        const amount<T> of_b = static_cast<amount<T>>(b.value),
                        quotient = static_cast<amount<T>>(v);
        return booked<T>(
            detail::operations::divided_by, v, a, b,
            [&](auto x, auto y) { return Rule::template divide<T>(v, x, y); },
            [&](const amount<T>& x) { return amount<T>(x / of_b); },
            [&](const amount<T>& y) { return amount<T>(-(y / of_b) * quotient); });
    }
    template <class T>
    static bound<T> scale(const T& v, rule_operand<T, explained> a, int e) {
        const auto exact_a = Rule::template exact<T>(a.value);
        const auto result = Rule::template scale<T>(v, {a.value, a.bound.of_rule}, e);
        const auto own = Rule::template scale<T>(v, {a.value, exact_a}, e);
        ledger<T> contributions;
        carry<T>(contributions, v, result, a,
                 [e](const amount<T>& x) { return number_traits<amount<T>>::scale(x, e); });
        return closed<T>(detail::operations::scaled, v, result, own, std::move(contributions));
    }

    template <class T>
    static tracked<T, Rule> unwrapped(const tracked<T, explained>& x) {
        return tracked<T, Rule>::from_bound(x.value(), x.bound().of_rule);
    }
    /// The wrapped rule's x, with contributions that add up to its error.
    template <class T>
    static tracked<T, explained> wrapped(const tracked<T, Rule>& x, ledger<T> contributions) {
        return tracked<T, explained>::from_bound(x.value(), {x.bound(), std::move(contributions)});
    }
    /// A function's result with its arguments' contributions. `own`: the result for exact
    /// arguments.
    template <class T>
    static tracked<T, explained> closed(std::uint32_t function, const tracked<T, Rule>& result,
                                        const tracked<T, Rule>& own, ledger<T> contributions) {
        using wide = typename detail::type_of_bounds<T, Rule>::type;
        return tracked<T, explained>::from_bound(
            result.value(), closed<wide>(function, wide(result.value()), result.bound(),
                                         own.bound(), std::move(contributions)));
    }

  private:
    /// An operation's result with its operands' contributions. `own`: the bound for exact operands.
    template <class T>
    static bound<T> closed(std::uint32_t operation, const T& v, const of_rule<T>& result,
                           const of_rule<T>& own, ledger<T> contributions) {
        const detail::source from{detail::current_scope(), operation};
        if (is_known<T>(v, result)) {
            using traits = number_traits<amount<T>>;
            const amount<T> known = correction_of<T>(v, own);
            const amount<T> unknown = error_of<T>(v, own) - traits::abs(known);
            contributions.book({from, known, (traits::max)(amount<T>(0), unknown)});
            contributions.limit(Limit);
            contributions.settle(from, correction_of<T>(v, result), error_of<T>(v, result));
        } else if (contributions.entries().empty()) {
            contributions.book_unknown(from);
        } else {
            contributions.limit(Limit);
        }
        return {result, std::move(contributions)};
    }
    template <class T>
    static amount<T> error_of(const T& v, const of_rule<T>& b) {
        return static_cast<amount<T>>(T(Rule::template error<T>(v, b)));
    }
    template <class T>
    static amount<T> correction_of([[maybe_unused]] const T& v,
                                   [[maybe_unused]] const of_rule<T>& b) {
        if constexpr (detail::rule_has_correction<Rule, T>)
            return static_cast<amount<T>>(T(Rule::template correction<T>(v, b)));
        else
            return amount<T>(0);
    }
    template <class T>
    static bool is_known(const T& v, const of_rule<T>& b) {
        return number_traits<T>::is_finite(T(Rule::template error<T>(v, b)));
    }

    template <class T>
    static bound<T> from_outside(const T& value, const of_rule<T>& b) {
        return closed<T>(detail::operations::input, value, b, b, {});
    }
    template <class T, class Times>
    static void carry(ledger<T>& to, const T& v, const of_rule<T>& result,
                      rule_operand<T, explained> a, const Times& times) {
        if (is_known<T>(v, result))
            to.carry(a.bound.contributions, times);
        else
            to.carry_unknown(a.bound.contributions);
    }
    template <class T, class BoundOf, class TimesA, class TimesB>
    static bound<T> booked(std::uint32_t operation, const T& v, rule_operand<T, explained> a,
                           rule_operand<T, explained> b, const BoundOf& bound_of,
                           const TimesA& times_a, const TimesB& times_b) {
        using operand = rule_operand<T, Rule>;
        const of_rule<T> exact_a = Rule::template exact<T>(a.value);
        const of_rule<T> exact_b = Rule::template exact<T>(b.value);
        const of_rule<T> result =
            bound_of(operand{a.value, a.bound.of_rule}, operand{b.value, b.bound.of_rule});
        const of_rule<T> own = bound_of(operand{a.value, exact_a}, operand{b.value, exact_b});
        ledger<T> contributions;
        carry<T>(contributions, v, result, a, times_a);
        carry<T>(contributions, v, result, b, times_b);
        return closed<T>(operation, v, result, own, std::move(contributions));
    }
};

template <class>
inline constexpr bool is_explained = false;
template <class Rule, std::size_t Limit>
inline constexpr bool is_explained<explained<Rule, Limit>> = true;

}  // namespace errbound
