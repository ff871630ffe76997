// Number types whose operations are timed side by side: plain double, tracked numbers under each
// rule, and intervals of other libraries, which have separate source files.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <errbound/functions.hpp>
#include <errbound/sign.hpp>
#include <functional>
#include <memory>
#include <numeric>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/bench/harness.hpp"

namespace bench {

/// Terms of a dot product, and coefficients of a polynomial.
inline constexpr std::size_t term_count = 8;
inline constexpr std::array<std::string_view, 10> operation_names{
    "add",      "multiply",           "divide", "sqrt", "fma", "hypot", "pow 5",
    "dot of 8", "horner of degree 7", "sign_of"};
inline constexpr std::size_t operation_count = operation_names.size();
/// Operands of a pass: few enough for the first cache, even for numbers of many terms.
inline constexpr std::size_t operands_per_pass = 32;

/// A number type and, for each operation, a pass over its operands; empty if it lacks the
/// operation.
struct contestant {
    std::string name;
    std::array<std::function<void()>, operation_count> passes;
};

/// An arithmetic of its operators.
template <class Number>
struct by_operators {
    /// The product of two exact numbers. It has a rounding error.
    static Number made(double x, double y) { return Number(x) * Number(y); }
    static void add(Number& r, const Number& a, const Number& b) { r = a + b; }
    static void multiply(Number& r, const Number& a, const Number& b) { r = a * b; }
    static void divide(Number& r, const Number& a, const Number& b) { r = a / b; }
};

/// An arithmetic of operators and of functions found by argument-dependent lookup.
template <class Number>
struct operators : by_operators<Number> {
    static void root(Number& r, const Number& a) {
        using std::sqrt;
        r = sqrt(a);
    }
    static void fused(Number& r, const Number& a, const Number& b, const Number& c) {
        using std::fma;
        r = fma(a, b, c);
    }
    static void length(Number& r, const Number& a, const Number& b) {
        using std::hypot;
        r = hypot(a, b);
    }
    static void fifth_power(Number& r, const Number& a) {
        using std::pow;
        r = pow(a, 5);
    }
    static void dot(Number& r, const Number* a, const Number* b) {
        using terms = std::span<const Number, term_count>;
        r = errbound::dot(terms(a, term_count), terms(b, term_count));
    }
    static void polynomial(Number& r, const Number* c, const Number& x) {
        r = errbound::horner(std::span<const Number, term_count>(c, term_count), x);
    }
    static errbound::sign_type sign(const Number& a) { return sign_of(a); }
};

/// Operations made of sums and products, for an Arithmetic without its own.
template <class Number, class Arithmetic>
struct composed {
    static Number made(double x, double y) {
        Number r;
        Arithmetic::multiply(r, Number(x), Number(y));
        return r;
    }
    static void length(Number& r, const Number& a, const Number& b) {
        static Number square;
        Arithmetic::multiply(square, a, a);
        Arithmetic::fused(r, b, b, square);
        Arithmetic::root(r, r);
    }
    static void fifth_power(Number& r, const Number& a) {
        Arithmetic::multiply(r, a, a);
        Arithmetic::multiply(r, r, r);
        Arithmetic::multiply(r, r, a);
    }
    static void dot(Number& r, const Number* a, const Number* b) {
        static Number product;
        Arithmetic::multiply(r, a[0], b[0]);
        for (std::size_t i = 1; i < term_count; ++i) {
            Arithmetic::multiply(product, a[i], b[i]);
            Arithmetic::add(r, r, product);
        }
    }
    static void polynomial(Number& r, const Number* c, const Number& x) {
        r = c[term_count - 1];
        for (std::size_t i = term_count - 1; i-- > 0;) {
            Arithmetic::multiply(r, r, x);
            Arithmetic::add(r, r, c[i]);
        }
    }
};

/// The operands and results of a contestant.
template <class Number>
struct operands {
    std::vector<Number> a, b, c, r;
    std::vector<errbound::sign_type> signs;
};

/// Numbers between 1 and 2, the same for every contestant.
template <class Number, class Arithmetic>
std::shared_ptr<operands<Number>> random_operands() {
    const auto x = std::make_shared<operands<Number>>();
    std::mt19937_64 random(1);
    const auto draw = [&random] {
        return 1 + std::ldexp(static_cast<double>(random() >> 12), -52);
    };
    for (auto* const numbers : {&x->a, &x->b, &x->c, &x->r})
        for (std::size_t i = 0; i < operands_per_pass; ++i)
            numbers->push_back(Arithmetic::made(draw(), draw()));
    x->signs.resize(operands_per_pass);
    return x;
}

/// A contestant with the operations of Arithmetic, which has the interface of `operators`.
template <class Number, class Arithmetic = operators<Number>, bool Divides = true>
contestant contestant_of(std::string name) {
    const auto x = random_operands<Number, Arithmetic>();
    const auto pass = [x](auto operation) -> std::function<void()> {
        return [x, operation] {
            for (std::size_t i = 0; i < operands_per_pass; ++i) operation(*x, i);
            keep(x->r);
            keep(x->signs);
        };
    };
    // The first term of the i-th dot product.
    constexpr auto first = [](std::size_t i) { return i % (operands_per_pass - term_count + 1); };
    using A = Arithmetic;
    return {std::move(name),
            {pass([](auto& s, auto i) { A::add(s.r[i], s.a[i], s.b[i]); }),
             pass([](auto& s, auto i) { A::multiply(s.r[i], s.a[i], s.b[i]); }),
             [&]() -> std::function<void()> {
                 if constexpr (Divides)
                     return pass([](auto& s, auto i) { A::divide(s.r[i], s.a[i], s.b[i]); });
                 return {};
             }(),
             pass([](auto& s, auto i) { A::root(s.r[i], s.a[i]); }),
             pass([](auto& s, auto i) { A::fused(s.r[i], s.a[i], s.b[i], s.c[i]); }),
             pass([](auto& s, auto i) { A::length(s.r[i], s.a[i], s.b[i]); }),
             pass([](auto& s, auto i) { A::fifth_power(s.r[i], s.a[i]); }),
             pass([first](auto& s, auto i) { A::dot(s.r[i], &s.a[first(i)], &s.b[first(i)]); }),
             pass([first](auto& s, auto i) { A::polynomial(s.r[i], &s.a[first(i)], s.b[i]); }),
             pass([](auto& s, auto i) { s.signs[i] = A::sign(s.a[i]); })}};
}

contestant boost_interval_contestant();
contestant mpfi_contestant();
contestant arb_contestant();

}  // namespace bench
