// A bound rule whose add returns a number instead of a bound: the message must say so.
#include <errbound/tracked.hpp>

struct bare {
    static constexpr const char* name = "bare";
    template <class T>
    using bound = errbound::tight::bound<T>;
    template <class T>
    using operand = errbound::rule_operand<T, bare>;
    template <class T>
    static constexpr bound<T> exact(const T&) {
        return {};
    }
    template <class T>
    static constexpr bound<T> within(const T&, const T& error) {
        return {error};
    }
    template <class T>
    static constexpr T error(const T&, const bound<T>& b) {
        return b.error;
    }
    template <class T>
    static constexpr T add(const T&, operand<T> a, operand<T>) {
        return a.bound.error;
    }
    template <class T>
    static constexpr bound<T> subtract(const T&, operand<T> a, operand<T>) {
        return a.bound;
    }
    template <class T>
    static constexpr bound<T> multiply(const T&, operand<T> a, operand<T>) {
        return a.bound;
    }
    template <class T>
    static constexpr bound<T> scale(const T&, operand<T> a, int) {
        return a.bound;
    }
};

int main() {
    const errbound::tracked<double, bare> x = 1.0;
    return x.value() > 0;
}
