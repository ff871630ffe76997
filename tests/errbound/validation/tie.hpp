// Compares the C++ code with the proofs' definitions, in every case of a tiny format and in a
// selection of cases of larger ones. proofs/tie/tie.ml, a program of those definitions, writes the
// hashes of the results to proofs/tie.txt. It enumerates the same cases in the same order.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <errbound/error_free.hpp>
#include <errbound/rules/derived.hpp>
#include <errbound/tracked.hpp>
#include <errbound/validation/rule_list.hpp>
#include <errbound/validation/tiny_float.hpp>
#include <functional>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "tests/proofs/table.hpp"

namespace tie {

using errbound::number_traits;
using errbound::rule_operand;
using errbound::validation::tiny_float;

/// So few terms that results must be shortened.
using affine = errbound::affine_of<3>;
using tied_rules =
    errbound::rule_types<errbound::tight, errbound::sharp, errbound::safe, errbound::interval,
                         errbound::residual, errbound::relative, affine>;

/// The rule's name in the table, which has one name for every limit on the terms of `affine`.
template <class Rule>
std::string table_name() {
    const std::string name = Rule::name;
    return name.substr(0, name.find('<'));
}

/// A rule with a given error and the default sign_of.
struct given_error : errbound::derived_rule<given_error, errbound::tight> {
    template <class T>
    static bound<T> within(const T&, const T& error) {
        return {error};
    }
};

/// All cases of an operation if there are at most `exhaustive`; otherwise `samples` random ones.
struct selection {
    std::uint64_t exhaustive, samples;
    std::uint64_t of(std::uint64_t total) const {
        return total <= exhaustive ? total : std::min(total, samples);
    }
};

// A format has values, bounds (the values that are not negative), the selections of cases, and the
// number of lists of numbers. `put` hashes all zeros, and all NaN, as one.

template <class T>
struct format;

template <int P, int E>
struct format<tiny_float<P, E>> {
    using T = tiny_float<P, E>;
    static constexpr selection of_rules{.exhaustive = P + E == 6 ? 1 << 24 : 1 << 20,
                                        .samples = 1 << 20};
    static constexpr selection of_functions{.exhaustive = 1 << 18, .samples = 1 << 18};
    static constexpr std::uint64_t lists = 20000;
    static constexpr int nan = ((1 << E) - 1) * (1 << (P - 1)) + 1;
    std::string name = "tiny_float<" + std::to_string(P) + "," + std::to_string(E) + ">";
    std::vector<T> values, bounds;

    format() {
        for (int c = 0; c < T::codes; ++c)
            if (c <= nan || (c >= T::codes / 2 && c < nan + T::codes / 2)) {
                values.push_back(T::from_code(c));
                if (c < T::codes / 2) bounds.push_back(T::from_code(c));
            }
    }
    static void put(hash& h, T x) {
        const int code = std::isnan(double(x)) ? nan : x == 0 ? 0 : x.code();
        h.put(static_cast<std::uint32_t>(code));
    }
};

template <std::floating_point F>
struct format<F> {
    using T = F;
    using limits = std::numeric_limits<T>;
    static constexpr bool one_word = sizeof(T) == 4;
    static constexpr selection of_rules{.exhaustive = 0, .samples = 2000};
    static constexpr selection of_functions{.exhaustive = 0, .samples = 1000};
    static constexpr std::uint64_t lists = 250;
    std::string name = one_word ? "float" : "double";
    std::vector<T> values{T(0),          limits::infinity(),   limits::quiet_NaN(),
                          limits::max(), limits::denorm_min(), limits::min(),
                          T(1)};
    std::vector<T> bounds = values;

    format() {
        values.push_back(-limits::infinity());
        values.push_back(-limits::max());
        sequence numbers;
        for (int i = 0; i < 150; ++i) values.push_back(number(numbers, true));
        for (int i = 0; i < 100; ++i) bounds.push_back(number(numbers, false));
    }
    static T number(sequence& numbers, bool with_sign) {
        constexpr std::uint64_t bias = limits::max_exponent - 1, p = limits::digits;
        const std::uint64_t kind = numbers.draw(8);
        const std::uint64_t exponent = kind < 3    ? bias - 2 + numbers.draw(5)
                                       : kind < 5  ? bias - p - 2 + numbers.draw(5)
                                       : kind == 5 ? numbers.draw(4)
                                       : kind == 6 ? bias / 2 - p + numbers.draw(2 * p)
                                                   : 2 * bias - numbers.draw(4);
        const std::uint64_t sign = with_sign ? numbers.draw(2) : 0;
        const bool is_short = numbers.draw(4) == 0;
        constexpr int upper_bits = one_word ? 23 : 20;
        const std::uint64_t upper = numbers.draw(std::uint64_t{1} << upper_bits);
        const std::uint64_t lower = numbers.draw(std::uint64_t{1} << 32);
        const std::uint64_t first = sign << 31 | exponent << upper_bits | (is_short ? 0 : upper);
        if constexpr (one_word)
            return std::bit_cast<T>(static_cast<std::uint32_t>(first));
        else
            return std::bit_cast<T>(first << 32 | (is_short ? 0 : lower));
    }
    static void put(hash& h, T x) {
        if (std::isnan(x))  // the one NaN of the proofs
            x = std::bit_cast<T>(std::bit_cast<word>(limits::infinity()) + 1);
        else if (x == 0)
            x = 0;
        const auto bits = std::bit_cast<word>(x);
        if constexpr (!one_word) h.put(static_cast<std::uint32_t>(std::uint64_t{bits} >> 32));
        h.put(static_cast<std::uint32_t>(bits));
    }

  private:
    using word = std::conditional_t<one_word, std::uint32_t, std::uint64_t>;
};

/// One operation: its number of cases, and a function that hashes the results of one.
struct operation {
    std::string name;
    std::uint64_t total;
    std::function<void(hash&, std::uint64_t)> run;
};

template <class First, class Second, class Case>
operation of_two(std::string name, const std::vector<First>& first,
                 const std::vector<Second>& second, Case put) {
    return {std::move(name), first.size() * second.size(),
            [&first, &second, put](hash& h, std::uint64_t i) {
                put(h, first[i / second.size()], second[i % second.size()]);
            }};
}
template <class State, class Case>
operation of_one(std::string name, const std::vector<State>& states, Case put) {
    return {std::move(name), states.size(),
            [&states, put](hash& h, std::uint64_t i) { put(h, states[i]); }};
}

inline const std::vector<int> exponents = [] {
    std::vector<int> all;
    for (int e = -12; e <= 12; ++e) all.push_back(e);
    return all;
}();

template <class T, class Rule>
struct operand_state {
    T value;
    typename Rule::template bound<T> bound;
    rule_operand<T, Rule> as_operand() const { return {value, bound}; }
};

/// `exact` holds exact operands if a selection of all states would have few of them.
template <class T, class Rule>
struct state_lists {
    using bound_type = typename Rule::template bound<T>;
    using state = operand_state<T, Rule>;
    std::vector<state> all, exact;
};

/// For rules whose bound is an error.
template <class T, class Rule>
struct states : state_lists<T, Rule> {
    explicit states(const format<T>& f) {
        for (const T& v : f.values)
            for (const T& e : f.bounds) this->all.push_back({v, {e}});
    }
    static void put(hash& h, const typename Rule::template bound<T>& b) {
        format<T>::put(h, b.error);
    }
};

template <class T>
struct states<T, errbound::safe> : state_lists<T, errbound::safe> {
    explicit states(const format<T>& f) {
        using traits = number_traits<T>;
        const T infinity = traits::infinity();
        for (const T& v : {T(0), T(1), T(-traits::largest()), infinity, T(infinity - infinity)})
            for (const T& b : f.bounds)
                for (const int k : {0, 1, 2, 5, (1 << 29) - 1, 1 << 29})
                    this->all.push_back({v, {b, k}});
    }
    static void put(hash& h, const errbound::safe::bound<T>& b) {
        format<T>::put(h, b.magnitude);
        h.put(static_cast<std::uint32_t>(b.operations));
    }
    const auto& with_errors() const { return this->all; }
};

template <class T>
struct states<T, errbound::interval> : state_lists<T, errbound::interval> {
    /// Numbers with infinite errors; intervals whose value is one of the ends.
    explicit states(const format<T>& f) {
        for (const T& v : f.values) this->exact.push_back({v, {v, v}});
        const T infinity = number_traits<T>::infinity();
        for (const T& v : f.values) this->all.push_back({v, {-infinity, infinity}});
        for (const T& lower : f.values)
            for (const T& upper : f.values)
                if (lower <= upper)
                    for (const T& v : {lower, upper}) this->all.push_back({v, {lower, upper}});
    }
    static void put(hash& h, const errbound::interval::bound<T>& b) {
        format<T>::put(h, b.lower);
        format<T>::put(h, b.upper);
    }
    const auto& with_errors() const { return this->all; }
};

template <class T>
struct states<T, errbound::residual> : state_lists<T, errbound::residual> {
    explicit states(const format<T>& f) {
        for (const T& v : f.values) this->exact.push_back({v, {T(0), T(0)}});
        for (const T& c : f.values)
            for (const T& r : f.bounds) bounds_.push_back({T(0), {c, r}});
        for (const T& v : f.values)
            for (const auto& b : bounds_) this->all.push_back({v, b.bound});
    }
    static void put(hash& h, const errbound::residual::bound<T>& b) {
        format<T>::put(h, b.correction);
        format<T>::put(h, b.remainder);
    }
    const auto& with_errors() const { return bounds_; }

  private:
    std::vector<operand_state<T, errbound::residual>> bounds_;
};

template <class T>
struct states<T, errbound::relative> : state_lists<T, errbound::relative> {
    explicit states(const format<T>& f) {
        constexpr int p = number_traits<T>::digits;
        using limits = std::numeric_limits<double>;
        for (const T& v : f.values) {
            this->exact.push_back({v, {0}});
            for (const double k : {0.0, 1.0, 2.0, 0.75, 3.5, 1 + limits::epsilon(), 100.0,
                                   std::ldexp(1, p - 1), std::ldexp(1.5, p), std::ldexp(1.75, p),
                                   std::ldexp(1, 60), limits::denorm_min(), limits::infinity()})
                this->all.push_back({v, {k}});
        }
    }
    static void put(hash& h, const errbound::relative::bound<T>& b) {
        format<double>::put(h, b.factors);
    }
    const auto& with_errors() const { return this->all; }
};

/// Numbers with up to Limit terms, of few sources, so that they have some in common. Some sources
/// come after all new ones.
template <class T, std::size_t Limit>
struct states<T, errbound::affine_of<Limit>> : state_lists<T, errbound::affine_of<Limit>> {
    using Rule = errbound::affine_of<Limit>;
    using bound_type = typename Rule::template bound<T>;

    explicit states(const format<T>& f) {
        for (const T& v : f.values) {
            this->exact.push_back({v, Rule::template exact<T>(v)});
            if (number_traits<T>::abs(v) <= T(2)) small_.push_back(v);
        }
        sequence numbers;
        for (int i = 0; i < 600; ++i) {
            const T value = number(f, numbers);
            this->all.push_back({value, bound_of(f, value, numbers)});
        }
    }
    /// Hashes all new sources as one.
    static void put(hash& h, const bound_type& b) {
        format<T>::put(h, b.radius);
        format<T>::put(h, b.rest);
        h.put(static_cast<std::uint32_t>(b.count));
        for (std::size_t i = 0; i < b.count; ++i) {
            const std::uint64_t source = b.terms[i].source;
            h.put(static_cast<std::uint32_t>(
                source >= late ? source - late + 200 : std::min<std::uint64_t>(source, 100)));
            format<T>::put(h, b.terms[i].coefficient);
        }
    }
    const auto& with_errors() const { return this->all; }

  private:
    static constexpr std::uint64_t late = std::uint64_t{1} << 40;

    T number(const format<T>& f, sequence& numbers) const {
        const std::vector<T>& from = numbers.draw(4) == 0 ? f.values : small_;
        return from[numbers.draw(from.size())];
    }
    bound_type bound_of(const format<T>& f, const T& value, sequence& numbers) const {
        using traits = number_traits<T>;
        const std::uint64_t kind = numbers.draw(8);
        if (kind == 0) return {traits::infinity(), traits::infinity(), 0, {}};
        if (kind == 1) return Rule::template exact<T>(value);
        bound_type b{T(0), T(0), static_cast<std::size_t>(numbers.draw(Limit + 1)), {}};
        std::uint64_t source = 0;
        for (std::size_t i = 0; i < b.count; ++i) {
            source += 1 + numbers.draw(2);
            if (kind == 3 && source < late && numbers.draw(2) == 0) source = late;
            const T c = number(f, numbers);
            b.terms[i] = {source, c == T(0) ? T(1) : c};
        }
        if (kind == 2) b.rest = traits::abs(number(f, numbers));
        b.radius = b.rest;
        for (std::size_t i = 0; i < b.count; ++i)
            b.radius = b.radius + traits::abs(b.terms[i].coefficient);
        return b;
    }

    std::vector<T> small_;
};

/// The errors and signs that the rule computes from its bounds.
template <class T, class Rule>
void add_claims(const states<T, Rule>& s, std::vector<operation>& all) {
    using state = typename states<T, Rule>::state;
    if constexpr (requires { s.with_errors(); })
        all.push_back(of_one("error", s.with_errors(), [](hash& h, const state& x) {
            format<T>::put(h, Rule::template error<T>(x.value, x.bound));
        }));
    if constexpr (requires(const state& x) { Rule::template sign<T>(x.value, x.bound); })
        all.push_back(of_one("sign", s.all, [](hash& h, const state& x) {
            h.put(static_cast<std::uint32_t>(Rule::template sign<T>(x.value, x.bound)));
        }));
}

/// Every operation of a rule.
template <class T, class Rule>
std::vector<operation> operations_of(const format<T>& f, const states<T, Rule>& s) {
    using states_type = states<T, Rule>;
    using state = typename states_type::state;
    const auto binary = [](std::string name, const std::vector<state>& of, auto result) {
        return of_two(std::move(name), of, of, [result](hash& h, const state& a, const state& b) {
            states_type::put(h, result(a.value, a.as_operand(), b.value, b.as_operand()));
        });
    };
    const auto multiply = [](const T& x, const auto& a, const T& y, const auto& b) {
        return Rule::template multiply<T>(T(x * y), a, b);
    };
    std::vector<operation> all{
        of_one("exact", f.values,
               [](hash& h, const T& v) { states_type::put(h, Rule::template exact<T>(v)); }),
        of_two("within", f.values, f.values,
               [](hash& h, const T& v, const T& e) {
                   states_type::put(h, Rule::template within<T>(v, e));
               }),
        binary("add", s.all,
               [](const T& x, const auto& a, const T& y, const auto& b) {
                   return Rule::template add<T>(T(x + y), a, b);
               }),
        binary("subtract", s.all,
               [](const T& x, const auto& a, const T& y, const auto& b) {
                   return Rule::template subtract<T>(T(x - y), a, b);
               }),
        binary("multiply", s.all, multiply),
        of_two("scale", s.all, exponents, [](hash& h, const state& a, int e) {
            states_type::put(
                h, Rule::template scale<T>(number_traits<T>::scale(a.value, e), a.as_operand(), e));
        })};
    if constexpr (errbound::has_division<Rule>) {
        const auto divide = [](const T& x, const auto& a, const T& y, const auto& b) {
            return Rule::template divide<T>(T(x / y), a, b);
        };
        all.push_back(binary("divide", s.all, divide));
        if (!s.exact.empty()) {
            all.push_back(binary("multiply_exact", s.exact, multiply));
            all.push_back(binary("divide_exact", s.exact, divide));
        }
    }
    add_claims(s, all);
    for (operation& o : all) o.name = table_name<Rule>() + "." + o.name;
    return all;
}

/// Operations that belong to no rule.
template <class T>
std::vector<operation> other_operations(const format<T>& f) {
    using F = format<T>;
    return {of_two("sign_of", f.values, f.values,
                   [](hash& h, const T& v, const T& e) {
                       h.put(static_cast<std::uint32_t>(
                           sign_of(errbound::tracked<T, given_error>::within(v, e))));
                   }),
            of_two("two_sum", f.values, f.values,
                   [](hash& h, const T& x, const T& y) {
                       const auto sum = errbound::two_sum<T>(x, y);
                       F::put(h, sum.value);
                       F::put(h, sum.error);
                   }),
            of_two("two_product", f.values, f.values,
                   [](hash& h, const T& x, const T& y) {
                       const auto product = errbound::two_product<T>(x, y);
                       F::put(h, product.value);
                       F::put(h, product.error);
                       h.put(errbound::product_error_is_exact<T>(x, y, product));
                   }),
            of_two("remainder_of_division", f.values, f.values,
                   [](hash& h, const T& x, const T& y) {
                       const auto r = errbound::remainder_of_division<T>(x, y, T(x / y));
                       F::put(h, r.value);
                       h.put(r.exact);
                   }),
            of_one("none.error", f.values, [](hash& h, const T& v) {
                F::put(h, errbound::none::error<T>(v, errbound::none::exact<T>(v)));
            })};
}

/// Adds lines of these operations.
template <class T>
void add_lines(std::vector<line>& lines, const std::vector<operation>& all, selection selected) {
    const std::string format_name = format<T>().name + (errbound::has_fast_fma<T> ? ",fma " : " ");
    for (const operation& o : all) {
        const std::uint64_t total = o.total, cases = selected.of(total);
        lines.push_back({format_name + o.name, cases,
                         [=, run = o.run, numbers = sequence()](hash& h, std::uint64_t i) mutable {
                             run(h, cases == total ? i : numbers.draw(total));
                         }});
    }
}

}  // namespace tie
