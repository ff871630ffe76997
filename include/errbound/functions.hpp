// Functions of tracked numbers: sqrt, fma, abs, min, max, midpoint, lerp, hypot, copysign, pow with
// whole exponents, dot and horner.
//   errbound::tracked<double> x = ...;
//   sqrt(x * x + y * y);            // found by its argument: no errbound:: is needed
//
// Unless stated otherwise they use only |value() − x| <= error(), which every rule gives. If an
// argument may lie outside the domain, the result's error is infinite. Derivations hold in any
// rounding direction, with ε = 2u. One rounding reduces a bound by a factor of at least 1 − ε, and
// by less than η if it underflows.
#pragma once

#include <cassert>
#include <concepts>
#include <cstddef>
#include <errbound/error_free.hpp>
#include <errbound/tracked.hpp>
#include <iterator>
#include <type_traits>
#include <utility>

namespace errbound {

namespace detail {

/// MinGW-w64 computes fma in long double and rounds twice.
#if defined(__MINGW32__) && !defined(__FMA__)
inline constexpr bool fma_rounds_once = false;
#else
inline constexpr bool fma_rounds_once = true;
#endif

/// Covers up to six roundings in a bound: (1 + 8ε)(1 − ε)^6 > 1.
template <class T>
constexpr T enlarged(const T& bound) {
    return rounded_product(bound, T(1 + 8 * number_traits<T>::epsilon()));
}

template <class T>
constexpr T rounding_of(const T& v) {
    using traits = number_traits<T>;
    return rounded_product(traits::abs(v), T(traits::epsilon() * (1 + traits::epsilon()))) +
           traits::underflow_unit();
}

/// True if the rule bounds quotients. (`divide` may exist only to stop compilation with a reason.)
template <class Rule, class T>
inline constexpr bool rule_divides = [] {
    if constexpr (requires { Rule::has_division; })
        return Rule::has_division;
    else
        return rule_has_divide<Rule, T>;
}();

template <class T, class Rule>
constexpr T larger_error(const tracked<T, Rule>& a, const tracked<T, Rule>& b) {
    const T x = a.error(), y = b.error();
    return x <= y ? y : y <= x ? x : number_traits<T>::infinity();
}

/// a if it is certainly at most b; otherwise a's value with the larger error.
template <class T, class Rule>
constexpr tracked<T, Rule> lesser_or_either(const tracked<T, Rule>& a, const tracked<T, Rule>& b) {
    const sign_type order = compare(a, b);
    if (order == sign_type::negative || order == sign_type::zero) return a;
    return tracked<T, Rule>::within(a.value(), larger_error(a, b));
}

}  // namespace detail

namespace detail {

/// √x by e = x.error(), x̂ = x.value(): |√x − √x̂| = |x − x̂|/(√x + √x̂) <= e/(√x̂ + √(x̂ − e)),
/// and v = fl(√x̂) adds a rounding. Up to five roundings. Proof: proofs/rules/IeeeFunctions.v,
/// sqrt_known; in any direction, proofs/rules/Functions.v, sqrt_sound.
template <class T, class Rule>
constexpr tracked<T, Rule> root_by_error(const tracked<T, Rule>& x) {
    using traits = number_traits<T>;
    using number = tracked<T, Rule>;
    const T v = traits::sqrt(x.value()), e = x.error();
    // x̂ < e: a nonzero difference does not round to 0.
    if (!(x.value() >= e)) return number::within(v, traits::infinity());
    if (e == 0) {
        const with_error<T> square = two_product(v, v);
        if (product_error_is_exact(v, v, square) && square.error == 0 && square.value == x.value())
            return v;
        return number::within(v, enlarged<T>(rounding_of(v)));
    }
    const T divisor = v + traits::sqrt(T(x.value() - e));
    return number::within(v,
                          enlarged<T>(e / divisor + T(rounding_of(v) + traits::underflow_unit())));
}

/// `by_slope` if it has the value of `by_error` and an error at most an eighth larger; otherwise
/// `by_error`.
template <class T, class Rule>
constexpr tracked<T, Rule> closer(const tracked<T, Rule>& by_error,
                                  const tracked<T, Rule>& by_slope) {
    const T most = by_error.error();
    if (by_slope.value() == by_error.value() && by_slope.error() <= T(most + most / T(8)))
        return by_slope;
    return by_error;
}

/// √x = v + (x − v²)/(√x + v) by the rule's operations, with `root` for √x and its value for v. x −
/// v² is the remainder x̂ − v², a T, plus x − x̂. Returns `root` if the remainder is unknown.
/// Proof: proofs/rules/IeeeSlopes.v, sqrt_by_slope_known; of `affine`, affine_slope_sqrt_gives.
template <class T, class Rule>
constexpr tracked<T, Rule> root_by_slope(const tracked<T, Rule>& x, const tracked<T, Rule>& root) {
    using number = tracked<T, Rule>;
    const division_remainder<T> remainder = remainder_of_root(x.value(), root.value());
    if (!remainder.exact || root.value() == 0 || !number_traits<T>::is_finite(root.error()))
        return root;
    const number at(x.value()), v(root.value());
    const number inherited = x - at;
    const number change = inherited + number(remainder.value);
    const number divisor = root + v;
    const number quotient = change / divisor;
    return v + quotient;
}

}  // namespace detail

/// √x. Infinite error if x may be negative. Exact if x is exact and its root is a T. Uses the
/// rule's own square_root (`interval`), or the slope 1/(2v) if the rule keeps errors to first order
/// (`residual`, `affine`), otherwise x.error(). Proof: proofs/rules/IeeeSlopes.v, slope_sqrt_known,
/// interval_sqrt_known; proofs/rules/IeeeFunctions.v, sqrt_known.
template <class T, class Rule>
constexpr tracked<T, Rule> sqrt(const tracked<T, Rule>& x) {
    static_assert(has_subnormals<T>, "errbound: sqrt needs a number type with subnormal numbers");
    if constexpr (detail::rule_has_square_root<Rule, T>) {
        const T v = number_traits<T>::sqrt(x.value());
        return tracked<T, Rule>::from_bound(
            v, Rule::template square_root<T>(v, {x.value(), x.bound()}));
    } else if constexpr (detail::keeps_first_order<Rule>) {
        using number = tracked<T, Rule>;
        const number root = detail::root_by_error(x);
        const number best = detail::closer(root, detail::root_by_slope(x, root));
        if constexpr (requires { Rule::is_crowded(best.bound()); })
            if (Rule::is_crowded(best.bound())) return number::within(best.value(), best.error());
        return best;
    } else {
        return detail::root_by_error(x);
    }
}

/// |x| by the value's sign, as ||x| − |x̂|| <= |x − x̂|. Proof: proofs/rules/IeeeFunctions.v,
/// abs_known.
template <class T, class Rule>
constexpr tracked<T, Rule> abs(const tracked<T, Rule>& x) {
    const bool below = x.value() < 0;
    if (const sign_type sign = sign_of(x);
        sign == (below ? sign_type::negative : sign_type::positive) || sign == sign_type::zero)
        return below ? -x : x;
    return tracked<T, Rule>::within(number_traits<T>::abs(x.value()), x.error());
}

/// abs by C's name. Proof: proofs/rules/IeeeFunctions.v, abs_known.
template <class T, class Rule>
constexpr tracked<T, Rule> fabs(const tracked<T, Rule>& x) {
    return abs(x);
}

/// True if value and error are finite.
template <class T, class Rule>
constexpr bool isfinite(const tracked<T, Rule>& x) {
    return number_traits<T>::is_finite(x.value()) && number_traits<T>::is_finite(x.error());
}
template <class T, class Rule>
constexpr bool isnan(const tracked<T, Rule>& x) {
    return x.value() != x.value();
}

/// The operand with the lesser value. If the order is uncertain, the result has the larger error,
/// as |min(a, b) − min(c, d)| <= max(|a − c|, |b − d|). Proof: proofs/rules/IeeeFunctions.v,
/// min_known.
template <class T, class Rule>
constexpr tracked<T, Rule>(min)(const tracked<T, Rule>& a, const tracked<T, Rule>& b) {
    return b.value() < a.value() ? detail::lesser_or_either(b, a) : detail::lesser_or_either(a, b);
}
/// Like min, for the greater value. Proof: proofs/rules/IeeeFunctions.v, max_known.
template <class T, class Rule>
constexpr tracked<T, Rule>(max)(const tracked<T, Rule>& a, const tracked<T, Rule>& b) {
    return a.value() < b.value() ? -detail::lesser_or_either(-b, -a)
                                 : -detail::lesser_or_either(-a, -b);
}

namespace detail {

/// ab + c from the operands' errors σ; v is its rounded value: |v − (ab + c)| <= |v|ε/(1 − ε) + η +
/// |â|σb + σa(|b̂| + σb) + σc. Each product may lose η by underflow. The third η covers rounding
/// |b̂| + σb if σa(|b̂| + σb) is so small that the factor 1 + 8ε is lost. The longest path has six
/// roundings. Proof: proofs/rules/IeeeFunctions.v, fma_known; in any direction,
/// proofs/rules/Functions.v, fma_sound.
template <class T, class Rule>
constexpr tracked<T, Rule> fused_by_error(const T& v, const tracked<T, Rule>& a,
                                          const tracked<T, Rule>& b, const tracked<T, Rule>& c) {
    using traits = number_traits<T>;
    const T of_a = a.error(), of_b = b.error(), of_c = c.error();
    const T products = rounded_product(traits::abs(a.value()), of_b) +
                       rounded_product(of_a, T(traits::abs(b.value()) + of_b));
    return tracked<T, Rule>::within(
        v, enlarged<T>(rounding_of(v) + (products + T(of_c + 3 * traits::underflow_unit()))));
}

/// ab + c = v + (âb̂ + ĉ − v) + (a(b − b̂) + (a − â)b̂) + (c − ĉ) by the rule's operations; v is
/// the value of `sum`, an enclosure of ab + c. With âb̂ = p + e and p + ĉ = s + f exactly, v's
/// error is (s − v) + f + e. Returns `sum` if e or f is unknown. Proof: proofs/rules/IeeeSlopes.v,
/// fma_by_slope_known; of `affine`, affine_slope_fma_gives.
template <class T, class Rule>
constexpr tracked<T, Rule> fused_by_slope(const tracked<T, Rule>& a, const tracked<T, Rule>& b,
                                          const tracked<T, Rule>& c, const tracked<T, Rule>& sum) {
    using number = tracked<T, Rule>;
    const number at_a(a.value()), at_b(b.value()), at_c(c.value()), v(sum.value());
    const with_error<T> product = two_product(a.value(), b.value());
    const with_error<T> total = two_sum(product.value, c.value());
    if (!product_error_is_exact(a.value(), b.value(), product) ||
        !number_traits<T>::is_finite(total.error))
        return sum;
    // One statement per operation: rules count sources in order.
    const number difference = number(total.value) - v;
    const number partial = difference + number(total.error);
    const number rounding = partial + number(product.error);
    const number change_of_b = b - at_b;
    const number of_b = a * change_of_b;
    const number change_of_a = a - at_a;
    const number of_a = change_of_a * at_b;
    const number change_of_c = c - at_c;
    const number products = of_a + of_b;
    const number inherited = products + change_of_c;
    const number change = inherited + rounding;
    return v + change;
}

}  // namespace detail

/// ab + c, rounded once by number_traits<T>::fma; does not compile if that rounds twice. Uses the
/// rule's own `fused` (`interval`), or derivatives if the rule keeps errors to first order
/// (`residual`, `affine`), otherwise the errors of a, b and c. Proof: proofs/rules/IeeeSlopes.v,
/// slope_fma_known, interval_fma_known; proofs/rules/IeeeFunctions.v, fma_known.
template <class T, class Rule>
constexpr tracked<T, Rule> fma(const tracked<T, Rule>& a, const tracked<T, Rule>& b,
                               const tracked<T, Rule>& c) {
    static_assert(has_subnormals<T>, "errbound: fma needs a number type with subnormal numbers");
    static_assert(!std::is_floating_point_v<T> || detail::fma_rounds_once,
                  "errbound: this C library's fma rounds twice; compile with -mfma");
    using number = tracked<T, Rule>;
    const T v = number_traits<T>::fma(a.value(), b.value(), c.value());
    const auto is_zero = [](const number& x) { return x.value() == 0 && x.error() == 0; };
    // c's value is v here.
    if ((is_zero(a) || is_zero(b)) && number_traits<T>::is_finite(v)) return c;
    if constexpr (detail::rule_has_fused<Rule, T>) {
        return number::from_bound(
            v, Rule::template fused<T>(v, {a.value(), a.bound()}, {b.value(), b.bound()},
                                       {c.value(), c.bound()}));
    } else if constexpr (detail::keeps_first_order<Rule>) {
        const number sum = detail::fused_by_error(v, a, b, c);
        return detail::closer(sum, detail::fused_by_slope(a, b, c, sum));
    } else {
        return detail::fused_by_error(v, a, b, c);
    }
}

/// (a + b)/2, or a/2 + b/2 if a + b overflows. Proof: proofs/rules/IeeeCompound.v, midpoint_known.
template <class T, class Rule>
constexpr tracked<T, Rule> midpoint(const tracked<T, Rule>& a, const tracked<T, Rule>& b) {
    const tracked<T, Rule> sum = a + b;
    if (number_traits<T>::is_finite(sum.value()) && number_traits<T>::is_finite(sum.error()))
        return scale(sum, -1);
    const tracked<T, Rule> half = scale(a, -1);  // one statement each: rules count sources
    return half + scale(b, -1);
}

/// a + t(b − a); a if t is exactly 0, b if it is exactly 1. Infinite error if b − a overflows. With
/// v = fl(t̂·fl(b̂ − â) + â) and errors σ: (1 − t)a + tb − (1 − t̂)â − t̂b̂ = (1 − t)(a − â) +
/// t(b − b̂) + (t − t̂)(b̂ − â), so σa counts |1 − t| times, not 1 + |t|. Two partial sums have up
/// to six roundings each; seven products may lose η each. Proof: proofs/rules/IeeeCompound.v,
/// lerp_known; in any direction, proofs/rules/Functions.v, lerp_sound.
template <class T, class Rule>
constexpr tracked<T, Rule> lerp(const tracked<T, Rule>& a, const tracked<T, Rule>& b,
                                const tracked<T, Rule>& t) {
    static_assert(has_subnormals<T>, "errbound: lerp needs a number type with subnormal numbers");
    static_assert(!std::is_floating_point_v<T> || detail::fma_rounds_once,
                  "errbound: this C library's fma rounds twice; compile with -mfma");
    using traits = number_traits<T>;
    const T of_a = a.error(), of_b = b.error(), of_t = t.error();
    if (of_t == 0 && t.value() == 0) return a;
    if (of_t == 0 && t.value() == 1) return b;
    const T d = b.value() - a.value(), v = traits::fma(t.value(), d, a.value());
    const T of_d = detail::rounding_of(d), size = traits::abs(t.value());
    const T from_ends =
        detail::enlarged<T>(detail::rounded_product(T(traits::abs(T(1 - t.value())) + of_t), of_a) +
                            detail::rounded_product(T(size + of_t), of_b));
    const T from_t = detail::enlarged<T>(detail::rounded_product(T(traits::abs(d) + of_d), of_t) +
                                         detail::rounded_product(size, of_d));
    return tracked<T, Rule>::within(
        v, detail::enlarged<T>(detail::rounding_of(v) +
                               (from_ends + T(from_t + 8 * traits::underflow_unit()))));
}

/// √(x² + y²), without intermediate overflow or underflow. It changes by at most the sum of its
/// arguments' changes. The larger argument is scaled to at least 1/2. Four roundings, and less than
/// 3η of underflow in the sum, then cause a relative error of 2ε + ε² + 7η. This is less than 3ε +
/// 8η of the result (ε <= 2^-7). Proof, to nearest: proofs/rules/IeeeCompound.v, hypot_known.
template <class T, class Rule>
constexpr tracked<T, Rule> hypot(const tracked<T, Rule>& x, const tracked<T, Rule>& y) {
    using traits = number_traits<T>;
    using number = tracked<T, Rule>;
    static_assert(has_subnormals<T> && traits::digits >= 8,
                  "errbound: hypot needs a number type of at least 8 bits of precision, with "
                  "subnormal numbers");
    const T larger = (traits::max)(traits::abs(x.value()), traits::abs(y.value()));
    const T inherited = x.error() + y.error();
    if (!traits::is_finite(inherited)) return number::within(larger, traits::infinity());
    if (larger == 0) return number::within(T(0), detail::enlarged<T>(inherited));
    const int e = traits::exponent(larger);
    const T a = traits::scale(x.value(), -e), b = traits::scale(y.value(), -e);
    const T root = traits::sqrt(T(detail::rounded_product(a, a) + detail::rounded_product(b, b)));
    const T v = traits::scale(root, e);
    const T relative = 3 * traits::epsilon() + 8 * traits::underflow_unit();
    return number::within(v, detail::enlarged<T>(detail::rounded_product(v, relative) +
                                                 T(inherited + 2 * traits::underflow_unit())));
}

/// |x| with the sign of the exact y; zero counts as positive. If y's sign is uncertain, so is the
/// result's; if y has no finite bound, the error is infinite. Proof: proofs/rules/IeeeCompound.v,
/// copysign_known; in any direction, proofs/rules/Functions.v, copysign_sound.
template <class T, class Rule>
constexpr tracked<T, Rule> copysign(const tracked<T, Rule>& x, const tracked<T, Rule>& y) {
    const tracked<T, Rule> size = abs(x);
    const sign_type sign = sign_of(y);
    if (certain(sign)) return sign == sign_type::negative ? -size : size;
    using traits = number_traits<T>;
    const T v = y.value() < 0 ? T(-size.value()) : size.value();
    if (!traits::is_finite(y.value()) || !traits::is_finite(y.error()))
        return tracked<T, Rule>::within(v, traits::infinity());
    return tracked<T, Rule>::within(v, detail::enlarged<T>(2 * size.value() + size.error()));
}

/// x^n by repeated squaring; x^0 is 1. The error of 1/x^|n| is infinite if the rule has no
/// division. Other exponents: errbound/elementary.hpp. Proof: proofs/rules/IeeeCompound.v,
/// pow_known.
template <class T, class Rule, std::same_as<int> Int>
constexpr tracked<T, Rule> pow(const tracked<T, Rule>& x, Int n) {
    using number = tracked<T, Rule>;
    number result(1), power = x;
    bool first = true;
    for (unsigned left = n < 0 ? 0U - static_cast<unsigned>(n) : static_cast<unsigned>(n);
         left != 0; left /= 2) {
        if (left % 2 == 1) result = first ? power : result * power;
        if (left % 2 == 1) first = false;
        if (left > 1) power *= power;
    }
    if (n >= 0) return result;
    if constexpr (detail::rule_divides<Rule, T>)
        return number(1) / result;
    else
        return number::within(result.value(), number_traits<T>::infinity());
}

namespace detail {

template <class Range>
using number_of = std::remove_cvref_t<decltype(std::begin(std::declval<const Range&>())[0])>;

template <class Number>
concept plain_tracked = requires {
    typename Number::value_type;
    typename Number::rule_type;
}
&&std::same_as<Number, tracked<typename Number::value_type, typename Number::rule_type>>;

}  // namespace detail

/// A range of tracked numbers with index and size: an array, std::vector, std::span, Eigen vector.
template <class Range>
concept tracked_numbers = requires(const Range& range) {
    std::begin(range)[0];
    std::size(range);
}
&&detail::plain_tracked<detail::number_of<Range>>;

namespace detail {

template <class Range>
constexpr decltype(auto) number_at(const Range& range, std::size_t i) {
    using difference = typename std::iterator_traits<
        std::remove_cvref_t<decltype(std::begin(range))>>::difference_type;
    return std::begin(range)[static_cast<difference>(i)];
}

template <class T, class Rule, class A, class B>
constexpr tracked<T, Rule> dot_of(std::size_t count, const A& a, const B& b) {
    using number = tracked<T, Rule>;
    if constexpr (rule_has_dot<Rule, T> && !bounds_are_wider<T, Rule>) {
        typename Rule::template dot_bound<T> bound;
        T sum(0);
        for (std::size_t i = 0; i < count; ++i) {
            const number &x = a(i), &y = b(i);
            const T product = rounded_product(x.value(), y.value()), before = sum;
            sum = before + product;
            bound.add_product(product, before, sum, {x.value(), x.bound()}, {y.value(), y.bound()});
        }
        return number::from_bound(sum, bound.finished(sum));
    } else {
        number sum(0);
        for (std::size_t i = 0; i < count; ++i) {
            const number product = a(i) * b(i);
            // Adding to 0 is exact: the bound stays, and −0 becomes 0.
            sum = i == 0 ? number::from_bound(T(0) + product.value(), product.bound())
                         : sum + product;
        }
        return sum;
    }
}

template <class T, class Rule, class C>
constexpr tracked<T, Rule> horner_of(std::size_t count, const C& c, const tracked<T, Rule>& x) {
    using number = tracked<T, Rule>;
    if (count == 0) return number(0);
    number result = c(count - 1);
    for (std::size_t i = count - 1; i-- > 0;) result = result * x + c(i);
    if constexpr (promises_bound<Rule>) {
        if (count < 3 || x.error() == 0) return result;
        const number at(x.value());
        number there = c(count - 1), slope = there;
        for (std::size_t i = count - 1; i-- > 1;) {
            there = there * at + c(i);
            slope = slope * x + there;
        }
        // `change` has the value 0, so by_slope has result's value, except for the sign of a zero.
        const number change = slope * (x - at);
        const number by_slope = (there * at + c(0)) + change;
        const bool loses_sign = certain(sign_of(result)) && !certain(sign_of(by_slope));
        if (by_slope.error() < result.error() && !loses_sign)
            return number::from_bound(result.value(), by_slope.bound());
    }
    return result;
}

}  // namespace detail

/// a₀b₀ + a₁b₁ + ...; 0 if empty. The value is that of s = 0, s = s + aᵢbᵢ in order, each operation
/// rounded. Precondition (asserted): a and b have equal size.
///
/// The bound is the rule's dot_bound (`relative`; `tight` and `sharp` from 8 and 5 bits of
/// precision on: the running error bound). It costs less than the bounds of single operations and
/// exceeds them by at most a last place or two. Other rules use single operations, which for
/// `residual` are the compensated dot product (Ogita, Rump, Oishi 2005). The worst case for exact
/// arguments is about nuΣ|aᵢbᵢ|. Proof: proofs/rules/IeeeDotProduct.v, tight_dot_known,
/// sharp_dot_known; proofs/rules/IeeeRelative.v, relative_dot_known; of operations one by one,
/// proofs/rules/IeeeCompound.v, dot_known.
template <tracked_numbers A, tracked_numbers B>
requires std::same_as<detail::number_of<A>, detail::number_of<B>>
constexpr detail::number_of<A> dot(const A& a, const B& b) {
    using number = detail::number_of<A>;
    const auto count = static_cast<std::size_t>(std::size(a));
    assert(count == static_cast<std::size_t>(std::size(b)));
    return detail::dot_of<typename number::value_type, typename number::rule_type>(
        count, [&](std::size_t i) -> decltype(auto) { return detail::number_at(a, i); },
        [&](std::size_t i) -> decltype(auto) { return detail::number_at(b, i); });
}

/// p(x) = c₀ + c₁x + c₂x² + ...; 0 if empty. The value is that of Horner's rule, each operation
/// rounded.
///
/// The bound is that of these operations, or that of p(x̂) + q(x)(x − x̂) if it is less; x̂ =
/// x.value(), and q's coefficients are the partial results at x̂ (synthetic division). So the error
/// of x counts |p'(x̂)| times, plus a term of order |x − x̂|², instead of once per occurrence.
/// Cost: three times that of the operations if x is not exact. Proof: proofs/rules/IeeeCompound.v,
/// horner_known; of `tight` in any direction, proofs/rules/Compound.v, tight_horner_sound.
template <tracked_numbers C>
constexpr detail::number_of<C> horner(const C& c,
                                      const std::type_identity_t<detail::number_of<C>>& x) {
    using number = detail::number_of<C>;
    return detail::horner_of<typename number::value_type, typename number::rule_type>(
        static_cast<std::size_t>(std::size(c)),
        [&](std::size_t i) -> decltype(auto) { return detail::number_at(c, i); }, x);
}

}  // namespace errbound
