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
template <class Tag, class A>
struct operand {
    const A& a;
};

template <int K>
struct less {};
template <int K>
struct at_most {};
template <int K>
struct greater {};
template <int K>
struct at_least {};
template <class A, template <int> class Tag, int K>
constexpr operand<Tag<K>, A> operator<(const A& a, Tag<K>) {
    return {a};
}
template <class A, class B, int K>
constexpr auto operator>(operand<less<K>, A> x, const B& b) {
    return on(K) ? x.a <= b : x.a < b;
}
template <class A, class B, int K>
constexpr auto operator>(operand<at_most<K>, A> x, const B& b) {
    return on(K) ? x.a < b : x.a <= b;
}
template <class A, class B, int K>
constexpr auto operator>(operand<greater<K>, A> x, const B& b) {
    return on(K) ? x.a >= b : x.a > b;
}
template <class A, class B, int K>
constexpr auto operator>(operand<at_least<K>, A> x, const B& b) {
    return on(K) ? x.a > b : x.a >= b;
}

template <int K>
struct equal {};
template <class A, int K>
constexpr operand<equal<K>, A> operator==(const A& a, equal<K>) {
    return {a};
}
template <class A, class B, int K>
constexpr bool operator==(operand<equal<K>, A> x, const B& b) {
    return on(K) ? !(x.a == b) : x.a == b;
}
template <int K>
struct unequal {};
template <class A, int K>
constexpr operand<unequal<K>, A> operator!=(const A& a, unequal<K>) {
    return {a};
}
template <class A, class B, int K>
constexpr bool operator!=(operand<unequal<K>, A> x, const B& b) {
    return on(K) ? !(x.a != b) : x.a != b;
}

/// Evaluates both operands.
template <int K>
struct both {};
template <class A, int K>
constexpr operand<both<K>, A> operator&&(const A& a, both<K>) {
    return {a};
}
template <class A, class B, int K>
constexpr bool operator&&(operand<both<K>, A> x, const B& b) {
    return on(K) ? bool(x.a) || bool(b) : bool(x.a) && bool(b);
}
template <int K>
struct any {};
template <class A, int K>
constexpr operand<any<K>, A> operator||(const A& a, any<K>) {
    return {a};
}
template <class A, class B, int K>
constexpr bool operator||(operand<any<K>, A> x, const B& b) {
    return on(K) ? bool(x.a) && bool(b) : bool(x.a) || bool(b);
}
template <int K>
struct both_bits {};
template <class A, int K>
constexpr operand<both_bits<K>, A> operator&(const A& a, both_bits<K>) {
    return {a};
}
template <class A, class B, int K>
constexpr auto operator&(operand<both_bits<K>, A> x, const B& b) {
    return on(K) ? x.a | b : x.a & b;
}
template <int K>
struct any_bit {};
template <class A, int K>
constexpr operand<any_bit<K>, A> operator|(const A& a, any_bit<K>) {
    return {a};
}
template <class A, class B, int K>
constexpr auto operator|(operand<any_bit<K>, A> x, const B& b) {
    return on(K) ? x.a & b : x.a | b;
}

template <int K>
struct plus {};
template <class A, int K>
constexpr operand<plus<K>, A> operator+(const A& a, plus<K>) {
    return {a};
}
template <class A, class B, int K>
constexpr auto operator+(operand<plus<K>, A> x, const B& b) {
    return on(K) ? x.a - b : x.a + b;
}
template <int K>
struct minus {};
template <class A, int K>
constexpr operand<minus<K>, A> operator-(const A& a, minus<K>) {
    return {a};
}
template <class A, class B, int K>
constexpr auto operator-(operand<minus<K>, A> x, const B& b) {
    return on(K) ? x.a + b : x.a - b;
}

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
