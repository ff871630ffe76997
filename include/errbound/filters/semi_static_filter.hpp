// The scalar of semi-static filters. It computes an expression's value and the largest coordinate
// or coordinate difference, from which the error bound follows. Static filters instead compute the
// expression with all terms positive (static_filter.hpp): their bound is smaller, but costs more if
// there are many terms. If the bound is finite, no number of the expression has overflowed. A NaN
// coordinate makes the value NaN. Proof: proofs/filters/SemiStatic.v,
// semi_static_overflow_uncertain. Source: Devillers, Pion 2003, Efficient exact geometric
// predicates for Delaunay triangulations.
#pragma once

#include <concepts>
#include <errbound/filters/static_filter.hpp>
#include <errbound/number_traits.hpp>

namespace errbound::filters {

/// An intermediate result. The size S, the number k of roundings, and τ, which covers underflow in
/// one product, are defined in static_filter.hpp. All terms have degree d. M is the largest
/// magnitude of plain coordinates and of computed coordinate differences. Then
/// S <= m·M^d + a·τ·(1 + M^d).
///
/// `mass` m is the size if all coordinates and differences are 1 and τ is 0. `allowances` a bounds
/// how often τ counts: 0 for coordinates, a_x + a_y for x ± y, 2(m_x·a_y + m_y·a_x) + 2 for x·y.
/// Both depend only on the expression, so they are computed at compile time. Proof, without
/// contraction: proofs/filters/SemiStatic.v, mass_covers_size.
template <std::floating_point T, int Roundings, int Degree>
struct semi_static {
    static_assert(Roundings < 1000 && Degree < 1000,
                  "errbound: the bound holds for fewer than 1000 roundings and degrees below "
                  "1000");
    using value_type = T;
    static constexpr int roundings = Roundings, degree = Degree;

    /// Replaces greater masses and allowances, because an overflow in a constant expression does
    /// not compile. It is above 1/u, so that bound() is then infinite.
    static constexpr T most = number_traits<T>::largest() / 16;
    static constexpr T limited(T x) { return x < most ? x : most; }
    /// Precondition: both are at most `most`.
    static constexpr T limited_product(T x, T y) { return y <= 1 || x < most / y ? x * y : most; }

    T value;
    T mass;
    T allowances;

    constexpr semi_static operator-() const { return {-value, mass, allowances}; }

    /// The bound constant(k)·(m·M^d + a·τ); the sign is uncertain if |value| <= bound(M). For signs
    /// constant(k − 1) suffices, which is less by about u. This difference covers a·τ·M^d, and the
    /// roundings of M^d and of the bound, of order u²·S. The + 2 in a product's a stands for
    /// 2τ: τ for underflow of the product, τ/4 for the product of the factors' allowances, and
    /// 3/4·τ for underflow of M^d, since τ >= 2^49·η. Below 2^p = 1/u, m and a are exact; otherwise
    /// the bound is infinite. It is also infinite if a factor is the constant 0. Proof:
    /// proofs/filters/SemiStatic.v, mass_covers_size, semi_static_bound_covers,
    /// semi_static_sign_certain.
    constexpr T bound(T largest) const {
        constexpr T exact = 1 / number_traits<T>::unit_roundoff();
        const bool trusted = mass < exact && allowances < exact;
        if (!trusted) return number_traits<T>::infinity();
        // Doubled: it overflows before a number of the expression does.
        const T size =
            2 * mass * power<Degree>(largest) + 2 * allowances * filtered<T, 0, 0, true>::allowance;
        return filter_constant<T>(Roundings) / 2 * size;
    }

  private:
    template <int Exponent>
    static constexpr T power(T x) {
        if constexpr (Exponent == 1)
            return x;
        else if constexpr (Exponent % 2 == 0)
            return power<Exponent / 2>(x * x);
        else
            return power<Exponent - 1>(x) * x;
    }
};

template <std::floating_point T>
struct semi_static_coordinate {
    using value_type = T;
    T value;
    T* largest;

    constexpr auto operator-() const { return -as_semi_static(*this); }
    friend constexpr semi_static<T, 0, 1> as_semi_static(const semi_static_coordinate& x) {
        enlarge(*x.largest, x.value);
        return {x.value, 1, 0};
    }
    friend constexpr semi_static<T, 1, 1> operator-(const semi_static_coordinate& x,
                                                    const semi_static_coordinate& y) {
        const T d = x.value - y.value;
        enlarge(*x.largest, d);
        return {d, 1, 0};
    }

  private:
    static constexpr void enlarge(T& largest, T x) {
        const T size = number_traits<T>::abs(x);
        largest = largest < size ? size : largest;
    }
};
template <std::floating_point T, int R, int D>
constexpr const semi_static<T, R, D>& as_semi_static(const semi_static<T, R, D>& x) {
    return x;
}

template <class>
inline constexpr bool is_semi_static = false;
template <class T, int R, int D>
inline constexpr bool is_semi_static<semi_static<T, R, D>> = true;
template <class T>
inline constexpr bool is_semi_static<semi_static_coordinate<T>> = true;
template <class X>
concept semi_static_operand = is_semi_static<X>;

template <class X, class Y>
constexpr auto semi_static_sum(typename X::value_type value, const X& x, const Y& y) {
    static_assert(X::degree == Y::degree,
                  "errbound: the expression is not homogeneous as declared");
    constexpr int roundings = (X::roundings > Y::roundings ? X::roundings : Y::roundings) + 1;
    using result = semi_static<typename X::value_type, roundings, X::degree>;
    return result{value, result::limited(x.mass + y.mass),
                  result::limited(x.allowances + y.allowances)};
}
template <class X, class Y>
constexpr auto semi_static_product(const X& x, const Y& y) {
    using T = typename X::value_type;
    using result =
        semi_static<typename X::value_type, X::roundings + Y::roundings + 1, X::degree + Y::degree>;
    const auto product = [](T a, T b) { return result::limited_product(a, b); };
    const T allowances = product(x.mass, y.allowances) + product(y.mass, x.allowances);
    return result{x.value * y.value, product(x.mass, y.mass), result::limited(2 * allowances + 2)};
}

template <semi_static_operand X, semi_static_operand Y>
constexpr auto operator+(const X& x, const Y& y) {
    return semi_static_sum(x.value + y.value, as_semi_static(x), as_semi_static(y));
}
template <semi_static_operand X, semi_static_operand Y>
constexpr auto operator-(const X& x, const Y& y) {
    return semi_static_sum(x.value - y.value, as_semi_static(x), as_semi_static(y));
}
template <semi_static_operand X, semi_static_operand Y>
constexpr auto operator*(const X& x, const Y& y) {
    return semi_static_product(as_semi_static(x), as_semi_static(y));
}
/// The product with a whole number. (Sums with one are of mixed degree, not for this filter.)
template <semi_static_operand X>
constexpr auto operator*(const X& x, std::same_as<int> auto c) {
    using T = typename X::value_type;
    const auto factor = filtered_constant<T>(c);
    // A factor 0 would erase the mass of x.
    using number = semi_static<T, decltype(factor)::roundings, 0>;
    return as_semi_static(x) * number{factor.value, c == 0 ? number::most : factor.size, 0};
}
template <semi_static_operand X>
constexpr auto operator*(std::same_as<int> auto c, const X& x) {
    return x * c;
}

/// A coordinate for the evaluation of the expression in T. A difference, or the conversion to T in
/// any other operation, updates *largest and returns a T.
template <std::floating_point T>
struct measured_coordinate {
    T value;
    T* largest;

    constexpr operator T() const { return as_semi_static(as_coordinate(*this)).value; }
    friend constexpr T operator-(const measured_coordinate& x, const measured_coordinate& y) {
        return (as_coordinate(x) - as_coordinate(y)).value;
    }

  private:
    friend constexpr semi_static_coordinate<T> as_coordinate(const measured_coordinate& x) {
        return {x.value, x.largest};
    }
};

}  // namespace errbound::filters
