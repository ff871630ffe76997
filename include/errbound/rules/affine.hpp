// Bound rule `affine`: affine arithmetic. The error is a sum of terms, one for each source of
// error: an inexact input, or an operation that rounded. Equal sources cancel: x − x is exactly 0,
// and the error of (x + y) − (x − y) does not depend on that of x. Rounding must be to nearest.
//
// Notation: docs/notation.md. The exact value is v + Σ cᵢεᵢ + ρ, with a noise symbol εᵢ per source,
// |εᵢ| <= 1, and |ρ| <= rest. The rest is 0 except in constant expressions and device code, which
// count no sources. One counter numbers the sources of all threads of a program; enter numbers of
// another process by `within`. sqrt and fma keep sources; results of elementary functions are new
// sources. References: Comba, Stolfi 1993; de Figueiredo, Stolfi 2004 (Numerical Algorithms 37).
// Proof, of whole computations: proofs/rules/IeeeAffineFunctions.v, computed_known, gives_known.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <errbound/detail/sources.hpp>
#include <errbound/error_free.hpp>
#include <errbound/rules/rule.hpp>

namespace errbound {

namespace detail {

inline constexpr std::size_t usual_affine_limit = 16;

template <std::size_t Limit>
inline constexpr std::array<char, 32> affine_name = [] {
    std::array<char, 32> name{'a', 'f', 'f', 'i', 'n', 'e'};
    if (Limit == usual_affine_limit) return name;
    std::size_t length = 7;
    for (std::size_t rest = Limit; rest >= 10; rest /= 10) ++length;
    name[6] = '<';
    name[length + 1] = '>';
    for (std::size_t rest = Limit, at = length; at > 6; --at, rest /= 10)
        name[at] = static_cast<char>('0' + rest % 10);
    return name;
}();

}  // namespace detail

/// Affine arithmetic with at most Limit terms, stored even if unused: 16 bytes each, 32 for long
/// double. Cost: linear in the number of terms, plus Limit writes; quadratic if many terms are
/// merged. An operation combines the operands' terms source by source, to first order. One new term
/// takes the other errors, if any: the rounding error (exact, or at most u|v| + η/2), roundings of
/// coefficients, second-order terms and the operands' rests. Above the limit, the smallest terms
/// join the new one; x − x stays 0. If value or radius is not finite, there are no terms, and
/// radius and rest are infinite or NaN.
template <std::size_t Limit>
struct affine_of {
    static_assert(Limit >= 1, "errbound: affine arithmetic needs at least one term");
    static constexpr const char* name = detail::affine_name<Limit>.data();
    static constexpr bool keeps_first_order = true;

    template <class T>
    struct term {
        std::uint64_t source;
        T coefficient;
    };
    /// Terms by ascending source; `radius` is at least |value − exact value|.
    template <class T>
    struct bound {
        T radius, rest;
        std::size_t count;
        std::array<term<T>, Limit> terms;
    };
    template <class T>
    using operand = rule_operand<T, affine_of>;

    /// Proof: proofs/rules/IeeeAffine.v, affine_exact_known.
    template <class T>
    static constexpr bound<T> exact(const T& value) {
        const T nothing = value - value;  // NaN if the value is not finite
        return {nothing, nothing, 0, {}};
    }
    /// One term, of a new source. Proof: proofs/rules/IeeeAffine.v, affine_within_known.
    template <class T>
    static constexpr bound<T> within(const T& value, const T& error) {
        if (!(error >= 0)) return unknown<T>();
        builder<T> r;
        r.add_left(error);
        return r.finished(value);
    }
    /// Proof: proofs/rules/IeeeAffine.v, affine_error_known.
    template <class T>
    static constexpr T error(const T&, const bound<T>& b) {
        return b.radius;
    }
    /// True if all Limit terms are used. sqrt then returns a number with only one term, so that a
    /// division by it does not displace the dividend's terms.
    template <class T>
    static constexpr bool is_crowded(const bound<T>& b) {
        return b.count == Limit;
    }
    /// Proof: proofs/rules/IeeeAffine.v, affine_negate_known.
    template <class T>
    static constexpr bound<T> negate(const bound<T>& b) {
        bound<T> r = b;
        for (std::size_t i = 0; i < r.count; ++i) r.terms[i].coefficient = -r.terms[i].coefficient;
        return r;
    }

    /// a + b = v + δ + Σ (aᵢ + bᵢ)εᵢ ± rests, with coefficients aᵢ, bᵢ and the rounding error δ.
    /// Proof: proofs/rules/IeeeAffine.v, affine_add_known.
    template <class T>
    static constexpr bound<T> add(const T& v, operand<T> a, operand<T> b) {
        return sum<false, T>(v, a, b);
    }
    /// Proof: proofs/rules/IeeeAffine.v, affine_subtract_known.
    template <class T>
    static constexpr bound<T> subtract(const T& v, operand<T> a, operand<T> b) {
        return sum<true, T>(v, a, b);
    }
    /// ab = v + δ + Σ (â·bᵢ + aᵢ·b̂)εᵢ, within |â|·rest_b + rest_a·|b̂| + radius_a·radius_b. Proof:
    /// proofs/rules/IeeeAffine.v, affine_multiply_known.
    template <class T>
    static constexpr bound<T> multiply(const T& v, operand<T> a, operand<T> b) {
        using traits = number_traits<T>;
        if (is_zero(a) || is_zero(b)) return exact<T>(v);
        const with_error<T> product = two_product<T>(a.value, b.value);
        builder<T> r;
        r.add_left(product_error_is_exact<T>(a.value, b.value, product) ? traits::abs(product.error)
                                                                        : detail::half_ulp<T>(v));
        for_each_source(a.bound, b.bound, [&](std::uint64_t source, const T& of_a, const T& of_b) {
            const T x = detail::rounded_product(a.value, of_b);
            const T y = detail::rounded_product(of_a, b.value);
            const with_error<T> c = two_sum<T>(x, y);
            r.add(source, c.value);
            if (of_b != 0 && a.value != 0) r.add_left(detail::half_ulp<T>(x));
            if (of_a != 0 && b.value != 0) r.add_left(detail::half_ulp<T>(y));
            r.add_left(traits::abs(c.error));
        });
        r.add_left(upper_product<T>(traits::abs(a.value), b.bound.rest));
        r.add_left(upper_product<T>(a.bound.rest, traits::abs(b.value)));
        r.add_left(upper_product<T>(a.bound.radius, b.bound.radius));
        return r.finished(v);
    }
    /// Let q = v, r = â − q·b̂ and N = r + Σ (aᵢ − q·bᵢ)εᵢ ± (rest_a + |q|·rest_b). Then a/b − q =
    /// N/b, and N/b − N/b̂ = N/b̂·(b̂ − b)/b is at most |N/b̂|·radius_b/(|b̂| − radius_b). If r is
    /// not known exactly, r/b̂, the rounding error of q, is at most u|v| + η/2. Infinite if b may
    /// be zero. Proof: proofs/rules/IeeeAffine.v, affine_divide_known.
    template <class T>
    static constexpr bound<T> divide(const T& v, operand<T> a, operand<T> b) {
        using traits = number_traits<T>;
        const T size = traits::abs(b.value);
        const T distance =
            detail::rounded_product(T(size - b.bound.radius), T(1 - traits::epsilon()));
        if (!(distance > 0)) return unknown<T>();
        if (is_zero(a)) return exact<T>(v);
        const division_remainder<T> division = remainder_of_division<T>(a.value, b.value, v);
        builder<T> r;
        if (!division.exact) r.add_left(detail::half_ulp<T>(v));
        // The part of N outside its terms.
        T left = upper_sum<T>(upper_product<T>(traits::abs(v), b.bound.rest), a.bound.rest);
        if (division.exact) left = upper_sum<T>(left, traits::abs(division.value));
        for_each_source(a.bound, b.bound, [&](std::uint64_t source, const T& of_a, const T& of_b) {
            const T x = detail::rounded_product(v, of_b);
            const with_error<T> n = two_sum<T>(of_a, T(-x));
            left = upper_sum<T>(left, traits::abs(n.error));
            if (of_b != 0) left = upper_sum<T>(left, detail::half_ulp<T>(x));
            const T c = n.value / b.value;
            r.add(source, c);
            if (n.value != 0) r.add_left(detail::half_ulp<T>(c));
        });
        r.add_left(upper_quotient<T>(left, size));
        const T quotient = upper_sum<T>(r.radius(), r.left());  // at least |N/b̂|
        if (b.bound.radius > 0)
            r.add_left(upper_quotient<T>(upper_product<T>(quotient, b.bound.radius), distance));
        return r.finished(v);
    }
    /// If it underflows, value, coefficients and rest are each off by at most η/2. Proof:
    /// proofs/rules/IeeeAffine.v, affine_scale_known.
    template <class T>
    static constexpr bound<T> scale(const T& v, operand<T> a, int e) {
        using traits = number_traits<T>;
        builder<T> r;
        const auto lost = [e](const T& scaled, const T& x) {
            return e >= 0 || traits::scale(scaled, -e) == x ? T(0) : traits::underflow_unit();
        };
        r.add_left(lost(v, a.value));
        for (std::size_t i = 0; i < a.bound.count; ++i) {
            const T& of_a = a.bound.terms[i].coefficient;
            const T c = traits::scale(of_a, e);
            r.add(a.bound.terms[i].source, c);
            r.add_left(lost(c, of_a));
        }
        const T rest = traits::scale(a.bound.rest, e);
        r.add_left(rest);
        r.add_left(lost(rest, a.bound.rest));
        return r.finished(v);
    }

  private:
    template <class T>
    static constexpr bound<T> unknown() {
        return {number_traits<T>::infinity(), number_traits<T>::infinity(), 0, {}};
    }
    template <class T>
    static constexpr bool is_zero(operand<T> a) {
        return a.value == 0 && a.bound.radius == 0;
    }

    /// At least x + y, for x, y >= 0. Let s = fl(x + y). If s is normal, fl(s(1 + ε)) is at least
    /// the number after s. If s is subnormal, it is exact. upper_product and upper_quotient add η
    /// for underflow.
    template <class T>
    static constexpr T upper_sum(const T& x, const T& y) {
        if (x == 0) return y;
        if (y == 0) return x;
        return detail::rounded_product(T(x + y), T(1 + number_traits<T>::epsilon()));
    }
    template <class T>
    static constexpr T upper_product(const T& x, const T& y) {
        using traits = number_traits<T>;
        if (x == 0 || y == 0) return T(0);
        return detail::rounded_product(detail::rounded_product(x, y), T(1 + traits::epsilon())) +
               traits::underflow_unit();
    }
    template <class T>
    static constexpr T upper_quotient(const T& x, const T& y) {
        using traits = number_traits<T>;
        if (x == 0) return T(0);
        return detail::rounded_product(T(x / y), T(1 + traits::epsilon())) +
               traits::underflow_unit();
    }
    /// Builds a bound from its terms, by ascending source, and the amount left over.
    template <class T>
    class builder {
      public:
        constexpr void add(std::uint64_t source, const T& coefficient) {
            if (coefficient != 0) terms_[count_++] = {source, coefficient};
        }
        constexpr void add_left(const T& amount) { left_ = upper_sum<T>(left_, amount); }
        constexpr const T& left() const { return left_; }
        constexpr T radius() const {
            T sum(0);
            for (std::size_t i = 0; i < count_; ++i)
                sum = upper_sum<T>(sum, number_traits<T>::abs(terms_[i].coefficient));
            return sum;
        }
        constexpr bound<T> finished(const T& value) {
            using traits = number_traits<T>;
            const T radius_of_all = upper_sum<T>(radius(), left_);
            if (!traits::is_finite(value) || !traits::is_finite(radius_of_all)) return unknown<T>();
            const std::size_t room = left_ == 0 ? Limit : Limit - 1;
            if (count_ > room) shorten();
            bound<T> b{radius_of_all, T(0), 0, {}};
            if (left_ != 0) b.rest = as_term_of(detail::fresh_source());
            for (; b.count < count_; ++b.count) b.terms[b.count] = terms_[b.count];
            return b;
        }

      private:
        /// Moves the smallest terms into the amount left over, to make room for its term.
        constexpr void shorten() {
            using traits = number_traits<T>;
            while (count_ >= Limit) {
                std::size_t least = 0;
                for (std::size_t i = 1; i < count_; ++i)
                    if (traits::abs(terms_[i].coefficient) < traits::abs(terms_[least].coefficient))
                        least = i;
                add_left(traits::abs(terms_[least].coefficient));
                for (--count_; least < count_; ++least) terms_[least] = terms_[least + 1];
            }
        }
        /// Inserts a term of `source`, usually the last one, for the amount left over, and returns
        /// 0. If there is no source, returns the amount, which becomes the rest.
        constexpr T as_term_of(std::uint64_t source) {
            if (source == detail::no_source) return left_;
            std::size_t i = count_++;
            for (; i > 0 && terms_[i - 1].source > source; --i) terms_[i] = terms_[i - 1];
            terms_[i] = {source, left_};
            return T(0);
        }

        T left_ = T(0);
        std::size_t count_ = 0;
        std::array<term<T>, 2 * Limit + 1> terms_{};
    };

    /// Calls f(source, a's coefficient, b's coefficient) for each source of a or b, ascending.
    template <class T, class F>
    static constexpr void for_each_source(const bound<T>& a, const bound<T>& b, const F& f) {
        std::size_t i = 0, j = 0;
        while (i < a.count || j < b.count) {
            const bool of_a =
                j == b.count || (i < a.count && a.terms[i].source <= b.terms[j].source);
            const bool of_b =
                i == a.count || (j < b.count && b.terms[j].source <= a.terms[i].source);
            f(of_a ? a.terms[i].source : b.terms[j].source, of_a ? a.terms[i].coefficient : T(0),
              of_b ? b.terms[j].coefficient : T(0));
            i += of_a;
            j += of_b;
        }
    }

    template <bool Minus, class T>
    static constexpr bound<T> sum(const T& v, operand<T> a, operand<T> b) {
        using traits = number_traits<T>;
        builder<T> r;
        r.add_left(traits::abs(two_sum<T>(a.value, Minus ? T(-b.value) : b.value).error));
        for_each_source(a.bound, b.bound, [&](std::uint64_t source, const T& of_a, const T& of_b) {
            const with_error<T> c = two_sum<T>(of_a, Minus ? T(-of_b) : of_b);
            r.add(source, c.value);
            r.add_left(traits::abs(c.error));
        });
        r.add_left(a.bound.rest);
        r.add_left(b.bound.rest);
        return r.finished(v);
    }
};

using affine = affine_of<detail::usual_affine_limit>;  ///< at most 16 terms

}  // namespace errbound
