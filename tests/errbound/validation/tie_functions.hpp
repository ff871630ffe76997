// Functions of tracked numbers, by every rule, against the proofs' table: tie.hpp.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <errbound/functions.hpp>
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

/// The operations on states of a rule, of which `some` are for those on three, and `exact` exact.
template <class T, class Rule, class Functions>
class functions_of {
    using number = tracked<T, Rule>;
    using state = operand_state<T, Rule>;

  public:
    functions_of(const format<T>& f, const states<T, Rule>& s)
        : all_(s.all), some_(spread(s.all)), values_(f.values) {
        for (const T& v : values_) exact_.push_back({v, Rule::template exact<T>(v)});
    }
    std::vector<operation> operations() const {
        std::vector<operation> made{
            of_one("sqrt", all_,
                   [](hash& h, const state& x) { put(h, Functions::root(restored(x))); }),
            of_one("sqrt_exact", values_,
                   [](hash& h, const T& v) {
                       put(h, Functions::root(number(v)));
                       put(h, Functions::root(number(T(v * v))));
                   }),
            of_one("abs", all_,
                   [](hash& h, const state& x) { put(h, Functions::size(restored(x))); }),
            of_two("min", all_, all_,
                   [](hash& h, const state& x, const state& y) {
                       put(h, Functions::lesser(restored(x), restored(y)));
                   }),
            of_two("max", all_, all_,
                   [](hash& h, const state& x, const state& y) {
                       put(h, Functions::greater(restored(x), restored(y)));
                   }),
            fused("fma", some_),
            fused("fma_exact", exact_)};
        for (operation& o : made) o.name = std::string(Rule::name) + "." + o.name;
        return made;
    }

  private:
    static void put(hash& h, const number& x) {
        format<T>::put(h, x.value());
        states<T, Rule>::put(h, x.bound());
    }
    static operation fused(std::string name, const std::vector<state>& of) {
        const std::uint64_t n = of.size();
        return {std::move(name), n * n * n, [&of, n](hash& h, std::uint64_t i) {
                    put(h, Functions::fused(restored(of[i / (n * n)]), restored(of[i / n % n]),
                                            restored(of[i % n])));
                }};
    }

    const std::vector<state>& all_;
    std::vector<state> some_, exact_;
    const std::vector<T>& values_;
};

template <class T, class Rule, class Functions = library_functions>
std::vector<std::string> differences_of_functions(const table& expected) {
    const format<T> f;
    const states<T, Rule> s(f);
    const functions_of<T, Rule, Functions> functions(f, s);
    return differences<T>(expected, functions.operations());
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
}

}  // namespace tie
