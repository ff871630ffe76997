// Functions of explained numbers; contributions of the arguments are kept.
//   sqrt(x);                                           // as for any tracked number
//   errbound::as_one_operation("norm", f, x, y, z);    // a custom function as one source
//
// A function is called again with exact arguments for its own contribution, and once per argument
// with only that argument's error. Functions made of sums and products (midpoint, pow) keep these
// as sources.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <errbound/conversion.hpp>
#include <errbound/explain/explained.hpp>
#include <errbound/functions.hpp>
#include <iterator>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

namespace errbound {

namespace detail {

template <class T, class Rule>
auto known_correction(const tracked<T, Rule>& x) {
    using wide = typename type_of_bounds<T, Rule>::type;
    if constexpr (rule_has_correction<Rule, wide>)
        return Rule::template correction<wide>(wide(x.value()), x.bound());
    else
        return T(0);
}
template <class T, class Rule>
bool are_equal(const tracked<T, Rule>& x, const tracked<T, Rule>& y) {
    return x.value() == y.value() && x.error() == y.error() &&
           known_correction(x) == known_correction(y);
}

/// The part of a function's error that comes from an argument's error.
template <class T, class Rule>
amount_of<T> beyond(const tracked<T, Rule>& with_error, const tracked<T, Rule>& own) {
    using amount = amount_of<T>;
    const amount more = static_cast<amount>(with_error.error()) - static_cast<amount>(own.error());
    return more > 0 && number_traits<amount>::is_finite(more) ? more : amount(0);
}

/// A function's results under the wrapped rule: for the arguments, for exact arguments, and for
/// each argument's error without the others.
template <class T, class Rule, std::size_t Count>
struct repeated_calls {
    tracked<T, Rule> result, own;
    std::array<tracked<T, Rule>, Count> of_one;
};

template <class T, class Rule, std::size_t Limit, std::size_t Count>
tracked<T, explained<Rule, Limit>> booked_function(
    std::string_view name, const std::array<const tracked<T, explained<Rule, Limit>>*, Count>& x,
    const repeated_calls<T, Rule, Count>& f) {
    using rule = explained<Rule, Limit>;
    using number = tracked<T, rule>;
    typename rule::template ledger<T> contributions;
    for (std::size_t i = 0; i < Count; ++i) {
        const number negative = -*x[i];
        if (are_equal(f.result, rule::unwrapped(*x[i])))
            return rule::wrapped(f.result, x[i]->bound().contributions);
        if (are_equal(f.result, rule::unwrapped(negative)))
            return rule::wrapped(f.result, negative.bound().contributions);
    }
    for (std::size_t i = 0; i < Count; ++i)
        if (number_traits<T>::is_finite(f.result.error()))
            contributions.carry_sizes(x[i]->bound().contributions, beyond(f.of_one[i], f.own));
        else
            contributions.carry_unknown(x[i]->bound().contributions);
    return rule::closed(all_sources::instance().function_named(name), f.result, f.own,
                        std::move(contributions));
}

}  // namespace detail

/// f(x, others...) as one operation with that name; f takes and returns numbers of the wrapped
/// rule. A result equal to ± an argument keeps that one's contributions. Names are stored for the
/// program's lifetime. Cost: two calls of f plus one per argument.
template <class T, class Rule, std::size_t Limit, class F,
          std::same_as<tracked<T, explained<Rule, Limit>>>... Others>
tracked<T, explained<Rule, Limit>> as_one_operation(std::string_view name, const F& f,
                                                    const tracked<T, explained<Rule, Limit>>& x,
                                                    const Others&... others) {
    using plain = tracked<T, Rule>;
    constexpr std::size_t count = 1 + sizeof...(others);
    const std::array<const tracked<T, explained<Rule, Limit>>*, count> arguments{&x, &others...};
    std::array<plain, count> given, exact;
    for (std::size_t i = 0; i < count; ++i) {
        given[i] = explained<Rule, Limit>::unwrapped(*arguments[i]);
        exact[i] = plain(arguments[i]->value());
    }
    detail::repeated_calls<T, Rule, count> calls{std::apply(f, given), std::apply(f, exact), {}};
    for (std::size_t i = 0; i < count; ++i) {
        std::array<plain, count> one = exact;
        one[i] = given[i];
        calls.of_one[i] = std::apply(f, one);
    }
    return detail::booked_function<T, Rule, Limit, count>(name, arguments, calls);
}

template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> sqrt(const tracked<T, explained<Rule, Limit>>& x) {
    return as_one_operation(
        "sqrt", [](const auto& y) { return sqrt(y); }, x);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> abs(const tracked<T, explained<Rule, Limit>>& x) {
    return as_one_operation(
        "abs", [](const auto& y) { return abs(y); }, x);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>>(min)(const tracked<T, explained<Rule, Limit>>& a,
                                        const tracked<T, explained<Rule, Limit>>& b) {
    return as_one_operation(
        "min", [](const auto& x, const auto& y) { return min<>(x, y); }, a, b);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>>(max)(const tracked<T, explained<Rule, Limit>>& a,
                                        const tracked<T, explained<Rule, Limit>>& b) {
    return as_one_operation(
        "max", [](const auto& x, const auto& y) { return max<>(x, y); }, a, b);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> fma(const tracked<T, explained<Rule, Limit>>& a,
                                       const tracked<T, explained<Rule, Limit>>& b,
                                       const tracked<T, explained<Rule, Limit>>& c) {
    return as_one_operation(
        "fma", [](const auto& x, const auto& y, const auto& z) { return fma(x, y, z); }, a, b, c);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> lerp(const tracked<T, explained<Rule, Limit>>& a,
                                        const tracked<T, explained<Rule, Limit>>& b,
                                        const tracked<T, explained<Rule, Limit>>& t) {
    return as_one_operation(
        "lerp", [](const auto& x, const auto& y, const auto& s) { return lerp(x, y, s); }, a, b, t);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> hypot(const tracked<T, explained<Rule, Limit>>& x,
                                         const tracked<T, explained<Rule, Limit>>& y) {
    return as_one_operation(
        "hypot", [](const auto& a, const auto& b) { return hypot(a, b); }, x, y);
}
template <class T, class Rule, std::size_t Limit>
tracked<T, explained<Rule, Limit>> copysign(const tracked<T, explained<Rule, Limit>>& x,
                                            const tracked<T, explained<Rule, Limit>>& y) {
    return as_one_operation(
        "copysign", [](const auto& a, const auto& b) { return copysign(a, b); }, x, y);
}

namespace detail {

template <class Range>
concept explained_numbers =
    tracked_numbers<Range> && is_explained<typename number_of<Range>::rule_type>;

template <class Range>
auto unwrapped_numbers(const Range& range) {
    return [&range](std::size_t i) {
        return number_of<Range>::rule_type::unwrapped(number_at(range, i));
    };
}
template <class Range>
auto exact_numbers(const Range& range) {
    using number = number_of<Range>;
    using plain = tracked<typename number::value_type, typename number::rule_type::wrapped_rule>;
    return [&range](std::size_t i) { return plain(number_at(range, i).value()); };
}

/// Adds x's contributions to a result, times the derivative by x.
template <class Amount, class T, class Rule, std::size_t Limit>
void carry_times(ledger<Amount>& to, const tracked<T, Rule>& result,
                 const tracked<T, explained<Rule, Limit>>& x, const Amount& derivative) {
    if (number_traits<T>::is_finite(result.error()))
        to.carry(x.bound().contributions, [&](const Amount& y) { return Amount(y * derivative); });
    else
        to.carry_unknown(x.bound().contributions);
}

}  // namespace detail

template <detail::explained_numbers A, detail::explained_numbers B>
requires std::same_as<detail::number_of<A>, detail::number_of<B>> detail::number_of<A> dot(
    const A& a, const B& b) {
    using number = detail::number_of<A>;
    using T = typename number::value_type;
    using rule = typename number::rule_type;
    using amount = detail::amount_of<T>;
    const auto count = static_cast<std::size_t>(std::size(a));
    assert(count == static_cast<std::size_t>(std::size(b)));
    const auto result = detail::dot_of<T, typename rule::wrapped_rule>(
        count, detail::unwrapped_numbers(a), detail::unwrapped_numbers(b));
    const auto own = detail::dot_of<T, typename rule::wrapped_rule>(count, detail::exact_numbers(a),
                                                                    detail::exact_numbers(b));
    typename rule::template ledger<T> contributions;
    for (std::size_t i = 0; i < count; ++i) {
        const number &x = detail::number_at(a, i), &y = detail::number_at(b, i);
        detail::carry_times(contributions, result, x, static_cast<amount>(y.value()));
        detail::carry_times(contributions, result, y, static_cast<amount>(x.value()));
    }
    return rule::closed(detail::all_sources::instance().function_named("dot"), result, own,
                        std::move(contributions));
}

template <detail::explained_numbers C>
detail::number_of<C> horner(const C& c, const std::type_identity_t<detail::number_of<C>>& x) {
    using number = detail::number_of<C>;
    using T = typename number::value_type;
    using rule = typename number::rule_type;
    using plain = tracked<T, typename rule::wrapped_rule>;
    using amount = detail::amount_of<T>;
    const auto count = static_cast<std::size_t>(std::size(c));
    const plain result = detail::horner_of<T, typename rule::wrapped_rule>(
        count, detail::unwrapped_numbers(c), rule::unwrapped(x));
    const plain own = detail::horner_of<T, typename rule::wrapped_rule>(
        count, detail::exact_numbers(c), plain(x.value()));
    typename rule::template ledger<T> contributions;
    const auto at = static_cast<amount>(x.value());
    amount power(1), value(0), derivative(0);
    for (std::size_t i = 0; i < count; ++i, power = power * at)
        detail::carry_times(contributions, result, number(detail::number_at(c, i)), power);
    for (std::size_t i = count; i-- > 0;) {
        derivative = derivative * at + value;
        value = value * at + static_cast<amount>(detail::number_at(c, i).value());
    }
    detail::carry_times(contributions, result, x, derivative);
    return rule::closed(detail::all_sources::instance().function_named("horner"), result, own,
                        std::move(contributions));
}

/// convert of conversion.hpp. A new rule must be `explained`, too; otherwise contributions end.
template <class To, class NewRule = void, class From, class Rule, std::size_t Limit>
requires(std::is_void_v<NewRule> ||
         is_explained<NewRule>) auto convert(const tracked<From, explained<Rule, Limit>>& x) {
    using rule = std::conditional_t<std::is_void_v<NewRule>, explained<Rule, Limit>, NewRule>;
    const auto result =
        convert<To, typename rule::wrapped_rule>(explained<Rule, Limit>::unwrapped(x));
    const auto own = convert<To, typename rule::wrapped_rule>(tracked<From, Rule>(x.value()));
    typename rule::template ledger<To> contributions;
    if (number_traits<To>::is_finite(result.error()))
        contributions.carry_sizes(x.bound().contributions, detail::beyond(result, own));
    else
        contributions.carry_unknown(x.bound().contributions);
    return rule::closed(detail::all_sources::instance().function_named("convert"), result, own,
                        std::move(contributions));
}

}  // namespace errbound
