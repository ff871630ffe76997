// Functions of tracked numbers, by every rule, against the proofs' table: tie.hpp.
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

/// The library's functions; mutants hide one each.
struct library_functions {
    template <class Number>
    static Number root(const Number& x) {
        return sqrt(x);
    }
    template <class Number>
    static Number size(const Number& x) {
        return abs(x);
    }
    template <class Number>
    static Number lesser(const Number& a, const Number& b) {
        return min(a, b);
    }
    template <class Number>
    static Number greater(const Number& a, const Number& b) {
        return max(a, b);
    }
    template <class Number>
    static Number fused(const Number& a, const Number& b, const Number& c) {
        return fma(a, b, c);
    }
    template <class Number>
    static Number middle(const Number& a, const Number& b) {
        return midpoint(a, b);
    }
    template <class Number>
    static Number between(const Number& a, const Number& b, const Number& t) {
        return lerp(a, b, t);
    }
    template <class Number>
    static Number length(const Number& x, const Number& y) {
        return hypot(x, y);
    }
    template <class Number>
    static Number with_sign(const Number& x, const Number& y) {
        return copysign(x, y);
    }
    template <class Number>
    static Number power(const Number& x, int n) {
        return pow(x, n);
    }
    template <class Number>
    static Number product(const std::vector<Number>& a, const std::vector<Number>& b) {
        return dot(a, b);
    }
    template <class Number>
    static Number polynomial(const std::vector<Number>& c, const Number& x) {
        return horner(c, x);
    }
};

/// The number of this value and bound, which a tracked number is made of, but takes from nobody.
template <class T, class Rule>
tracked<T, Rule> restored(const operand_state<T, Rule>& state) {
    return std::bit_cast<tracked<T, Rule>>(state);
}

/// At most ten thousand of them, evenly: the cases of three can be numbered.
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

/// Draws numbers of a kind: any; exact ones; or exact and others, small and known well, so that not
/// all that is made of them is infinite.
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
    /// The i-th list of pairs: one in four is that before it with its first number negated.
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
    /// A polynomial's coefficients, and where.
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

/// The operations on states of a rule, of which `some` are for those on three, and `exact` exact.
template <class T, class Rule, class Functions>
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
        for (auto& more : {of_two_numbers(), of_three_numbers(), of_lists()})
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
    static operation one(std::string name, const std::vector<state>& of, Function function) {
        return of_one(std::move(name), of,
                      [function](hash& h, const state& x) { put(h, function(restored(x))); });
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
        return {one("sqrt", all_, [](const number& x) { return Functions::root(x); }),
                of_one("sqrt_exact", values_,
                       [](hash& h, const T& v) {
                           put(h, Functions::root(number(v)));
                           put(h, Functions::root(number(T(v * v))));
                       }),
                one("abs", all_, [](const number& x) { return Functions::size(x); }),
                of_two("pow", some_, powers, [](hash& h, const state& x, int n) {
                    put(h, Functions::power(restored(x), n));
                })};
    }
    std::vector<operation> of_two_numbers() const {
        const auto length = [](const auto& x, const auto& y) { return Functions::length(x, y); };
        const auto midpoint = [](const number& x, const number& y) {
            return Functions::middle(x, y);
        };
        const auto copysign = [](const number& x, const number& y) {
            return Functions::with_sign(x, y);
        };
        std::vector<operation> made{
            two("min", all_,
                [](const number& x, const number& y) { return Functions::lesser(x, y); }),
            two("max", all_,
                [](const number& x, const number& y) { return Functions::greater(x, y); }),
            two("midpoint", all_, midpoint), two("copysign", all_, copysign)};
        if constexpr (number_traits<T>::digits >= 8) {
            made.push_back(two("hypot", all_, length));
            made.push_back(two("hypot_of_zeros", zeros_, length));
        }
        return made;
    }
    std::vector<operation> of_three_numbers() const {
        const auto fused = [](const number& x, const number& y, const number& z) {
            return Functions::fused(x, y, z);
        };
        const auto between = [](const number& x, const number& y, const number& t) {
            return Functions::between(x, y, t);
        };
        return {three("fma", some_, some_, fused), three("fma_exact", exact_, exact_, fused),
                three("lerp", some_, some_, between),
                three("lerp_at_exact", some_, exact_, between)};
    }
    std::vector<operation> of_lists() const {
        return {{"dot", format<T>::lists,
                 [this](hash& h, std::uint64_t i) {
                     const auto [a, b] = numbers_.pairs(i);
                     put(h, Functions::product(a, b));
                 }},
                {"horner", format<T>::lists, [this](hash& h, std::uint64_t i) {
                     const auto [c, x] = numbers_.polynomial(i);
                     put(h, Functions::polynomial(c, x));
                 }}};
    }

    const std::vector<state>& all_;
    std::vector<state> some_, exact_, zeros_;
    const std::vector<T>& values_;
    number_draws<T, Rule> numbers_;
};

template <class T, class Rule, class Functions = library_functions>
std::vector<std::string> differences_of_functions(const table& expected) {
    const format<T> f;
    const states<T, Rule> s(f);
    const functions_of<T, Rule, Functions> functions(f, s);
    return differences<T>(expected, functions.operations(), format<T>::of_functions);
}

template <class T>
void expect_the_proofs_functions() {
    const table expected = read_table();
    ASSERT_FALSE(expected.empty()) << ERRBOUND_TIE_TABLE;
    const std::vector<std::string> none;
    EXPECT_EQ((differences_of_functions<T, errbound::tight>(expected)), none);
    EXPECT_EQ((differences_of_functions<T, errbound::sharp>(expected)), none);
    EXPECT_EQ((differences_of_functions<T, errbound::safe>(expected)), none);
    EXPECT_EQ((differences_of_functions<T, errbound::interval>(expected)), none);
    EXPECT_EQ((differences_of_functions<T, errbound::residual>(expected)), none);
    EXPECT_EQ((differences_of_functions<T, errbound::relative>(expected)), none);
    EXPECT_EQ((differences_of_functions<T, affine>(expected)), none);
}

}  // namespace tie
