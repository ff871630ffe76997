// Arithmetics whose operations are timed side by side: plain double, tracked numbers under each
// rule, and intervals of other libraries, each of these in a source file of its own.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <errbound/sign.hpp>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/bench/harness.hpp"

namespace bench {

inline constexpr std::array operation_names{"add", "subtract", "multiply", "divide", "sqrt",
                                            "fma", "abs",      "min",      "sign_of"};
inline constexpr std::size_t operation_count = operation_names.size();
/// Operands of a pass: few enough for the first cache, those of many terms too.
inline constexpr std::size_t operands_per_pass = 32;

/// An arithmetic, and a pass over its operands for each operation; empty where it has none.
struct contestant {
    std::string key, heading;
    std::array<std::function<void()>, operation_count> passes;
};

/// By its operators, and functions that are found by their arguments.
template <class Number>
struct operators {
    /// The product of two exact numbers between 1 and 2, which is not exact.
    static Number made(double x, double y) { return Number(x) * Number(y); }
    static void add(Number& r, const Number& a, const Number& b) { r = a + b; }
    static void subtract(Number& r, const Number& a, const Number& b) { r = a - b; }
    static void multiply(Number& r, const Number& a, const Number& b) { r = a * b; }
    static void divide(Number& r, const Number& a, const Number& b) { r = a / b; }
    static void root(Number& r, const Number& a) {
        using std::sqrt;
        r = sqrt(a);
    }
    static void fused(Number& r, const Number& a, const Number& b, const Number& c) {
        using std::fma;
        r = fma(a, b, c);
    }
    static void absolute(Number& r, const Number& a) {
        using std::abs;
        r = abs(a);
    }
    static void lesser(Number& r, const Number& a, const Number& b) {
        using std::min;
        r = min(a, b);
    }
    static errbound::sign_type sign(const Number& a) { return sign_of(a); }
};

/// One whose operations are those of Arithmetic, as `operators` has them.
template <class Number, class Arithmetic = operators<Number>, bool Divides = true>
contestant contestant_of(std::string key, std::string heading) {
    struct operands {
        std::vector<Number> a, b, c, r;
        std::vector<errbound::sign_type> signs;
    };
    const auto x = std::make_shared<operands>();
    std::mt19937_64 random(1);
    const auto draw = [&random] {
        return 1 + std::ldexp(static_cast<double>(random() >> 12), -52);
    };
    for (auto* const numbers : {&x->a, &x->b, &x->c, &x->r})
        for (std::size_t i = 0; i < operands_per_pass; ++i)
            numbers->push_back(Arithmetic::made(draw(), draw()));
    x->signs.resize(operands_per_pass);
    const auto pass = [x](auto operation) -> std::function<void()> {
        return [x, operation] {
            for (std::size_t i = 0; i < operands_per_pass; ++i) operation(*x, i);
            keep(x->r);
            keep(x->signs);
        };
    };
    contestant result{std::move(key), std::move(heading), {}};
    using A = Arithmetic;
    result.passes = {pass([](auto& s, auto i) { A::add(s.r[i], s.a[i], s.b[i]); }),
                     pass([](auto& s, auto i) { A::subtract(s.r[i], s.a[i], s.b[i]); }),
                     pass([](auto& s, auto i) { A::multiply(s.r[i], s.a[i], s.b[i]); }),
                     {},
                     pass([](auto& s, auto i) { A::root(s.r[i], s.a[i]); }),
                     pass([](auto& s, auto i) { A::fused(s.r[i], s.a[i], s.b[i], s.c[i]); }),
                     pass([](auto& s, auto i) { A::absolute(s.r[i], s.a[i]); }),
                     pass([](auto& s, auto i) { A::lesser(s.r[i], s.a[i], s.b[i]); }),
                     pass([](auto& s, auto i) { s.signs[i] = A::sign(s.a[i]); })};
    if constexpr (Divides)
        result.passes[3] = pass([](auto& s, auto i) { A::divide(s.r[i], s.a[i], s.b[i]); });
    return result;
}

contestant explained_contestant();
contestant explained_contestant_of_32_sources();
contestant boost_interval_contestant();
contestant mpfi_contestant();
contestant arb_contestant();

}  // namespace bench
