// Functions of tracked numbers, by every rule, compared with the proofs' table: tie.hpp.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <errbound/functions.hpp>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "tests/errbound/validation/tie.hpp"

namespace tie {

using errbound::tracked;

/// The tracked number with this value and bound; no constructor makes it.
template <class T, class Rule>
tracked<T, Rule> restored(const operand_state<T, Rule>& state) {
    return std::bit_cast<tracked<T, Rule>>(state);
}

/// At most ten thousand evenly spread states, so that 64 bits number the triples.
template <class State>
std::vector<State> spread(const std::vector<State>& all) {
    const std::size_t most = std::min<std::size_t>(all.size(), 10007);
    std::vector<State> some;
    for (std::size_t i = 0; i < most; ++i) some.push_back(all[i * all.size() / most]);
    return some;
}

inline const std::vector<int> powers = [] {
    std::vector<int> all;
    for (int n = -9; n <= 12; ++n) all.push_back(n);
    all.push_back(std::numeric_limits<int>::min());
    return all;
}();

/// Draws numbers of a kind: any, exact, or small numbers with small errors and exact ones. The last
/// keep results finite.
template <class T, class Rule>
class number_draws {
    using number = tracked<T, Rule>;

  public:
    number_draws(const format<T>& f, const std::vector<operand_state<T, Rule>>& states) {
        const auto is_small = [](const T& v) { return number_traits<T>::abs(v) <= T(2); };
        for (const auto& state : states) {
            any_.push_back(restored(state));
            if (is_small(state.value) && any_.back().error() <= T(1)) small_.push_back(any_.back());
        }
        for (const T& v : f.values)
            if (is_small(v)) exact_.push_back(number(v));
    }
    /// The i-th list of pairs. One in four is the pair before it with its first number negated.
    std::pair<std::vector<number>, std::vector<number>> pairs(std::uint64_t i) const {
        sequence numbers(i + 1);
        const std::uint64_t kind = numbers.draw(4), count = numbers.draw(20);
        std::pair<std::vector<number>, std::vector<number>> drawn;
        auto& [a, b] = drawn;
        for (std::uint64_t n = 0; n < count; ++n) {
            const bool again = numbers.draw(4) == 0 && n > 0;
            a.push_back(again ? -a.back() : draw(numbers, kind));
            b.push_back(again ? b.back() : draw(numbers, kind));
        }
        return drawn;
    }
    /// A polynomial's coefficients and argument.
    std::pair<std::vector<number>, number> polynomial(std::uint64_t i) const {
        sequence numbers(i + 1);
        const std::uint64_t kind = numbers.draw(4), count = numbers.draw(7);
        const number x = draw(numbers, kind);
        std::vector<number> c;
        for (std::uint64_t n = 0; n < count; ++n) c.push_back(draw(numbers, kind));
        return {c, x};
    }

  private:
    const number& draw(sequence& numbers, std::uint64_t kind) const {
        const auto& from = kind == 0              ? any_
                           : kind == 1            ? exact_
                           : numbers.draw(2) == 0 ? small_
                                                  : exact_;
        return from[numbers.draw(from.size())];
    }

    std::vector<number> any_, small_, exact_;
};

/// The functions of a rule's states; functions of three numbers take `some_`.
template <class T, class Rule>
class functions_of {
    using number = tracked<T, Rule>;
    using state = operand_state<T, Rule>;

  public:
    functions_of(const format<T>& f, const states<T, Rule>& s)
        : all_(s.all), some_(spread(s.all)), values_(f.values), numbers_(f, some_) {
        for (const T& v : values_) exact_.push_back({v, Rule::template exact<T>(v)});
        for (const state& x : some_)
            if (x.value == T(0)) zeros_.push_back(x);
    }
    std::vector<operation> operations() const {
        std::vector<operation> made = of_one_number();
        for (auto& more : {of_more_numbers(), of_lists()})
            made.insert(made.end(), more.begin(), more.end());
        for (operation& o : made) o.name = table_name<Rule>() + "." + o.name;
        return made;
    }

  private:
    static void put(hash& h, const number& x) {
        format<T>::put(h, x.value());
        states<T, Rule>::put(h, x.bound());
    }
    template <class Function>
    static operation two(std::string name, const std::vector<state>& of, Function function) {
        return of_two(std::move(name), of, of, [function](hash& h, const state& x, const state& y) {
            put(h, function(restored(x), restored(y)));
        });
    }
    template <class Function>
    static operation three(std::string name, const std::vector<state>& first,
                           const std::vector<state>& third, Function function) {
        const std::uint64_t n = third.size(), m = first.size() * n;
        return {std::move(name), first.size() * m, [=, &first, &third](hash& h, std::uint64_t i) {
                    put(h, function(restored(first[i / m]), restored(first[i / n % first.size()]),
                                    restored(third[i % n])));
                }};
    }

    std::vector<operation> of_one_number() const {
        return {of_one("sqrt", all_, [](hash& h, const state& x) { put(h, sqrt(restored(x))); }),
                of_one("sqrt_exact", values_,
                       [](hash& h, const T& v) {
                           put(h, sqrt(number(v)));
                           put(h, sqrt(number(T(v * v))));
                       }),
                of_one("abs", all_, [](hash& h, const state& x) { put(h, abs(restored(x))); }),
                of_two("pow", some_, powers,
                       [](hash& h, const state& x, int n) { put(h, pow(restored(x), n)); })};
    }
    std::vector<operation> of_more_numbers() const {
        const auto least = [](const auto& x, const auto& y) { return min(x, y); };
        const auto most = [](const auto& x, const auto& y) { return max(x, y); };
        const auto middle = [](const auto& x, const auto& y) { return midpoint(x, y); };
        const auto with_sign = [](const auto& x, const auto& y) { return copysign(x, y); };
        const auto fused = [](const auto& x, const auto& y, const auto& z) { return fma(x, y, z); };
        const auto between = [](const auto& x, const auto& y, const auto& t) {
            return lerp(x, y, t);
        };
        std::vector<operation> made{two("min", all_, least),
                                    two("max", all_, most),
                                    two("midpoint", all_, middle),
                                    two("copysign", all_, with_sign),
                                    three("fma", some_, some_, fused),
                                    three("fma_exact", exact_, exact_, fused),
                                    three("lerp", some_, some_, between),
                                    three("lerp_at_exact", some_, exact_, between)};
        if constexpr (number_traits<T>::digits >= 8) {
            const auto length = [](const auto& x, const auto& y) { return hypot(x, y); };
            made.push_back(two("hypot", all_, length));
            made.push_back(two("hypot_of_zeros", zeros_, length));
        }
        return made;
    }
    std::vector<operation> of_lists() const {
        return {{"dot", format<T>::lists,
                 [this](hash& h, std::uint64_t i) {
                     const auto [a, b] = numbers_.pairs(i);
                     put(h, dot(a, b));
                 }},
                {"horner", format<T>::lists, [this](hash& h, std::uint64_t i) {
                     const auto [c, x] = numbers_.polynomial(i);
                     put(h, horner(c, x));
                 }}};
    }

    const std::vector<state>& all_;
    std::vector<state> some_, exact_, zeros_;
    const std::vector<T>& values_;
    number_draws<T, Rule> numbers_;
};

/// The number of groups of the rule, its operations and functions, that differ from the table.
template <class T, class Rule>
int count_differences_of(bool first_alone) {
    const format<T> f;
    const states<T, Rule> s(f);
    const functions_of<T, Rule> functions(f, s);
    std::vector<line> lines;
    add_lines<T>(lines, operations_of<T, Rule>(f, s), format<T>::of_rules);
    add_lines<T>(lines, functions.operations(), format<T>::of_functions);
    return count_differences(lines, first_alone);
}

}  // namespace tie
