// A custom bound rule for rounding to nearest: Wilkinson's running error analysis (Higham, Accuracy
// and Stability of Numerical Algorithms, 2nd ed. 2002, Section 3.3), next to other rules.
#include <cstdio>
#include <errbound/tracked.hpp>

// errbound/rules/rule.hpp lists the members of a rule. This rule keeps its bound in units of the
// unit roundoff u: |value − exact value| <= u·units. A sum or product rounded to v adds |v| units
// to those inherited. Proof sketch of the rest: every count of units is multiplied by 1 + 8ε, which
// covers its at most seven roundings; products add 4η/u for underflow.
struct running {
    static constexpr const char* name = "running";

    template <class T>
    struct bound {
        T units;
    };
    template <class T>
    static constexpr bound<T> exact(const T& value) {
        return {value - value};  // 0, or NaN if the value is not finite
    }
    template <class T>
    static constexpr bound<T> within(const T& value, const T& error) {
        using traits = errbound::number_traits<T>;
        if (!(error >= 0)) return {traits::infinity()};
        return {inflated(error / traits::unit_roundoff()) + (value - value)};
    }
    template <class T>
    static constexpr T error(const T&, const bound<T>& b) {
        using traits = errbound::number_traits<T>;
        if (b.units == 0) return b.units;
        return b.units * traits::unit_roundoff() + traits::underflow_unit();
    }
    template <class T>
    using operand = errbound::rule_operand<T, running>;

    template <class T>
    static constexpr bound<T> add(const T& v, operand<T> a, operand<T> b) {
        return {inflated(errbound::number_traits<T>::abs(v) + (a.bound.units + b.bound.units))};
    }
    template <class T>
    static constexpr bound<T> subtract(const T& v, operand<T> a, operand<T> b) {
        return add(v, a, b);
    }
    template <class T>
    static constexpr bound<T> multiply(const T& v, operand<T> a, operand<T> b) {
        using traits = errbound::number_traits<T>;
        const T inherited = traits::abs(a.value) * b.bound.units +
                            a.bound.units * (traits::abs(b.value) + error(b.value, b.bound));
        return {inflated(traits::abs(v) + inherited +
                         4 * (traits::underflow_unit() / traits::unit_roundoff()))};
    }
    template <class T>
    static bound<T> scale(const T& v, operand<T> a, int e) {
        // Exact except for underflow, as for `tight`.
        const errbound::tight::bound<T> same{error(a.value, a.bound)};
        return within(v, errbound::tight::scale<T>(v, {a.value, same}, e).error);
    }

  private:
    template <class T>
    static constexpr T inflated(const T& b) {
        return b * (1 + 8 * errbound::number_traits<T>::epsilon());
    }
};

template <class Rule>
void show() {
    using number = errbound::tracked<double, Rule>;
    const number a = 0.1, b = 0.3, c = 0.7;
    const number x = a * a - b * c + a * b * c;
    std::printf("%-8s value %.17g, bound %.3g\n", Rule::name, x.value(), x.error());
}

int main() {
    show<running>();
    show<errbound::residual>();
    show<errbound::interval>();
    show<errbound::sharp>();
    show<errbound::tight>();
    show<errbound::safe>();
    show<errbound::none>();
}
