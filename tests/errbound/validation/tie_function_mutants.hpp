// Functions of tracked numbers as the library has them but for one term that is left out, for
// tie_dropped_terms.cpp: the comparison must find each. Number 0 leaves out nothing.
#pragma once

#include <errbound/functions.hpp>

#include "tests/errbound/validation/tie_functions.hpp"

namespace tie_mutants {

using errbound::number_traits;
using errbound::tracked;

template <int Without>
struct functions : tie::library_functions {
    static constexpr int mutants = 17;

    template <class T, class Rule>
    static tracked<T, Rule> root(const tracked<T, Rule>& x) {
        if constexpr (errbound::detail::rule_has_square_root<Rule, T>) return sqrt(x);
        using traits = number_traits<T>;
        using number = tracked<T, Rule>;
        const T v = traits::sqrt(x.value()), e = x.error();
        if (!(x.value() >= e)) return number::within(v, traits::infinity());
        if (e == 0) {
            const auto square = errbound::two_product(v, v);
            if (product_error_is_exact(v, v, square) && (Without == 2 || square.error == 0) &&
                (Without == 1 || square.value == x.value()))
                return v;
            return number::within(v, enlarged<3>(rounding<4>(v)));
        }
        const T divisor = v + (Without == 5 ? v : traits::sqrt(T(x.value() - e)));
        const T lost = Without == 6 ? T(0) : traits::underflow_unit();
        return number::within(v, enlarged<7>(T(e / divisor + (rounding<8>(v) + lost))));
    }

    template <class T, class Rule>
    static tracked<T, Rule> size(const tracked<T, Rule>& x) {
        if (Without == 9) return x.value() < 0 ? -x : x;
        return abs(x);
    }

    template <class T, class Rule>
    static tracked<T, Rule> lesser(const tracked<T, Rule>& a, const tracked<T, Rule>& b) {
        const tracked<T, Rule> least = min(a, b);
        if (Without == 10 && least.value() == a.value()) return a;
        return least;
    }
    template <class T, class Rule>
    static tracked<T, Rule> greater(const tracked<T, Rule>& a, const tracked<T, Rule>& b) {
        const tracked<T, Rule> most = max(a, b);
        if (Without == 11 && most.value() == a.value()) return a;
        return most;
    }

    template <class T, class Rule>
    static tracked<T, Rule> fused(const tracked<T, Rule>& a, const tracked<T, Rule>& b,
                                  const tracked<T, Rule>& c) {
        if constexpr (errbound::detail::rule_has_fused<Rule, T>) return fma(a, b, c);
        using traits = number_traits<T>;
        const T v = traits::fma(a.value(), b.value(), c.value());
        const T of_a = a.error(), of_b = b.error(), of_c = Without == 12 ? T(0) : c.error();
        const bool zero = (a.value() == 0 && of_a == 0) || (b.value() == 0 && of_b == 0);
        if (Without != 13 && zero && traits::is_finite(v)) return c;
        const T b_size = Without == 14 ? traits::abs(b.value()) : traits::abs(b.value()) + of_b;
        const T products = (Without == 15 ? T(0) : traits::abs(a.value()) * of_b) + of_a * b_size;
        const T lost = (Without == 16 ? 2 : 3) * traits::underflow_unit();
        return tracked<T, Rule>::within(
            v, enlarged<0>(T(rounding<17>(v) + (products + (of_c + lost)))));
    }

  private:
    template <int Mutant, class T>
    static T rounding(const T& v) {
        using traits = number_traits<T>;
        if (Mutant == Without) return traits::underflow_unit();
        return traits::abs(v) * (traits::epsilon() * (1 + traits::epsilon())) +
               traits::underflow_unit();
    }
    template <int Mutant, class T>
    static T enlarged(const T& bound) {
        if (Mutant != 0 && Mutant == Without) return bound;
        return bound * (1 + 8 * number_traits<T>::epsilon());
    }
};

}  // namespace tie_mutants
