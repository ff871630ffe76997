// Functions that mutants.py inserts into copies of the code. Each constant, comparison and branch
// has a number, and is changed if the environment has that number. Expressions evaluated at compile
// time stay unchanged. At the end, the program reports whether the changed expression was evaluated
// at run time.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <type_traits>

namespace mutants {

inline const int chosen = [] {
    const char* number = std::getenv("ERRBOUND_MUTANT");
    return number == nullptr ? 0 : std::atoi(number);
}();

struct place {
    bool reached = false;
    ~place() {
        if (reached) std::fputs("reached\n", stderr);
    }
};
inline place changed;

inline bool reached() {
    return changed.reached = true;
}
constexpr bool on(int mutant) {
    return !std::is_constant_evaluated() && chosen == mutant && reached();
}

/// A constant: the next number; for a fraction, less by an eighth; for 0, 1.
template <int K, class T>
constexpr T number(T n) {
    if (!on(K)) return n;
    if constexpr (std::is_floating_point_v<T>)
        return n == 0 ? T(1) : n * T(0.875);
    else
        return T(n + 1);
}
/// An enumerator or its replacement.
template <int K, class T>
constexpr T either(T original, T other) {
    return on(K) ? other : original;
}

/// a OP b becomes a OP tag OP b with the same precedence: `operand` stores a until b is evaluated.
/// Both operands are evaluated.
template <class Tag, class A>
struct operand {
    const A& a;
};
#define MUTANTS_OPERATOR(tag, opening, closing, original, changed)      \
    template <int K>                                                    \
    struct tag {};                                                      \
    template <class A, int K>                                           \
    constexpr operand<tag<K>, A> operator opening(const A& a, tag<K>) { \
        return {a};                                                     \
    }                                                                   \
    template <class A, class B, int K>                                  \
    constexpr auto operator closing(operand<tag<K>, A> x, const B& b) { \
        return on(K) ? changed : original;                              \
    }
MUTANTS_OPERATOR(less, <, >, x.a < b, x.a <= b)
MUTANTS_OPERATOR(at_most, <, >, x.a <= b, x.a < b)
MUTANTS_OPERATOR(greater, <, >, x.a > b, x.a >= b)
MUTANTS_OPERATOR(at_least, <, >, x.a >= b, x.a > b)
MUTANTS_OPERATOR(equal, ==, ==, x.a == b, !(x.a == b))
MUTANTS_OPERATOR(unequal, !=, !=, x.a != b, !(x.a != b))
MUTANTS_OPERATOR(both, &&, &&, bool(x.a) && bool(b), bool(x.a) || bool(b))
MUTANTS_OPERATOR(any, ||, ||, bool(x.a) || bool(b), bool(x.a) && bool(b))
MUTANTS_OPERATOR(both_bits, &, &, (x.a) & (b), x.a | b)
MUTANTS_OPERATOR(any_bit, |, |, x.a | b, (x.a) & (b))
MUTANTS_OPERATOR(plus, +, +, x.a + b, x.a - b)
MUTANTS_OPERATOR(minus, -, -, x.a - b, x.a + b)
#undef MUTANTS_OPERATOR

/// !b becomes negation ->* b.
template <int K>
struct negation {};
template <class B, int K>
constexpr bool operator->*(negation<K>, const B& b) {
    return on(K) ? bool(b) : !b;
}

template <int K, class T>
constexpr T greatest(const T& a, const T& b) {
    return (a < b) != on(K) ? b : a;
}
template <int K, class T>
constexpr T least(const T& a, const T& b) {
    return (b < a) != on(K) ? b : a;
}
template <int K, class T>
constexpr T greatest(std::initializer_list<T> all) {
    T found = *all.begin();
    for (const T& x : all) found = greatest<K>(found, x);
    return found;
}
template <int K, class T>
constexpr T least(std::initializer_list<T> all) {
    T found = *all.begin();
    for (const T& x : all) found = least<K>(found, x);
    return found;
}

}  // namespace mutants
