// A bound rule of one's own in a page of code: `sharp`, TightBound with u = 2^-53 in place of
// ε = 2u, valid under rounding to nearest only. Prints its bound beside those of the other rules.
#include <cstdio>
#include <errbound/tracked.hpp>

// What a rule must provide is listed in errbound/rules/operand.hpp. Proof sketch: rounding to
// nearest is off by at most u|v|, or by η/2 where it underflows; every bound is multiplied by
// 1 + 8ε, which exceeds its own at most six roundings; products add 4η for their underflow.
struct sharp {
    static constexpr const char* name = "sharp";

    template <class T>
    struct bound {
        T error;
    };
    template <class T>
    static constexpr bound<T> exact(const T&) {
        return {T(0)};
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
    using operand = errbound::operand<T, sharp>;

    template <class T>
    static constexpr bound<T> add(const T& v, operand<T> a, operand<T> b) {
        return {inflated(rounding(v) + (a.bound.error + b.bound.error))};
    }
    template <class T>
    static constexpr bound<T> subtract(const T& v, operand<T> a, operand<T> b) {
        return add(v, a, b);
    }
    template <class T>
    static constexpr bound<T> multiply(const T& v, operand<T> a, operand<T> b) {
        using traits = errbound::number_traits<T>;
        const T inherited = traits::abs(a.value) * b.bound.error +
                            a.bound.error * (traits::abs(b.value) + b.bound.error);
        return {inflated(rounding(v) + inherited + 4 * traits::underflow_unit())};
    }
    template <class T>
    static bound<T> scale(const T& v, operand<T> a, int e) {
        // Exact but for underflow, as for `tight`.
        const errbound::tight::bound<T> same{a.bound.error};
        return {errbound::tight::scale<T>(v, {a.value, same}, e).error};
    }

  private:
    // Below 2^p·η sums are exact and products pay with 4η, so underflow of u|v| does no harm.
    template <class T>
    static constexpr T rounding(const T& v) {
        using traits = errbound::number_traits<T>;
        return traits::abs(v) * traits::unit_roundoff();
    }
    template <class T>
    static constexpr T inflated(const T& b) {
        return b * (1 + 8 * errbound::number_traits<T>::epsilon());
    }
};

// Any generic code takes the new rule at once.
template <class Rule>
void show() {
    using number = errbound::tracked<double, Rule>;
    const number a = 0.1, b = 0.3, c = 0.7;
    const number x = a * a - b * c + a * b * c;
    std::printf("%-6s value %.17g, bound %.3g\n", Rule::name, x.value(), x.error());
}

int main() {
    show<sharp>();
    show<errbound::tight>();
    show<errbound::safe>();
    show<errbound::none>();
}
