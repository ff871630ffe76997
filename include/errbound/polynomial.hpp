// Real roots and signs of polynomials of any degree, always exact.
//   const errbound::polynomial p{-2.0, 0.0, 1.0};       // x² − 2: coefficients ascend
//   auto roots = errbound::isolate_roots(p, 0, 10);
//   roots.refine(0, 1e-30);                             // roots[0].low < √2 < roots[0].high
//   roots.sign_at(errbound::polynomial{-1.5, 1.0}, 0);  // of x − 1.5 at √2: negative
//
// Preconditions (asserted): coefficients are finite, a <= b in [a, b], and a and b are not the same
// infinity. Calls throw only std::bad_alloc, after which roots found before stay valid. refine also
// throws std::invalid_argument. Members of roots isolated with limits also throw roots::gave_up if
// `.stop` returns true. With GMP's integers, lack of memory ends the program. Cost:
// docs/polynomials.md.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <errbound/bsc.hpp>
#include <errbound/integers/integer.hpp>
#include <errbound/roots/polynomial_stages.hpp>
#include <errbound/roots/real_roots.hpp>
#include <limits>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace errbound {

namespace roots {

/// The exact integer type: Named unless it is void, otherwise C if it is an exact_number (for
/// rationals, the type of numerators), otherwise errbound::integer.
template <class Named, class C>
struct integer_for {
    static_assert(exact_number<Named>,
                  "errbound: the integer type must never overflow: use errbound::integer, or "
                  "Boost.Multiprecision's cpp_int or GMP's, by errbound/multiprecision.hpp");
    using type = Named;
};
template <class C>
struct integer_for<void, C> {
    using type = errbound::integer;
};
template <exact_number C>
struct integer_for<void, C> {
    static auto of(const C& c) {
        if constexpr (std::numeric_limits<C>::is_integer)
            return c;
        else
            return numerator(c);
    }
    using type = std::remove_cvref_t<decltype(of(std::declval<const C&>()))>;
};
template <class Named, class C>
using integer_for_t = typename integer_for<Named, C>::type;

template <class Find>
auto unless_given_up(const Find& find) -> std::optional<decltype(find())> {
    try {
        return find();
    } catch (const gave_up&) {
        return {};
    }
}

}  // namespace roots

/// The distinct roots of p in [a, b], in disjoint intervals, with multiplicities. Coefficients are
/// double, float, built-in integers, unbounded integers or rationals (errbound::integer,
/// Boost.Multiprecision). Exact arithmetic uses the integer type Integer, if the call names one, as
/// in count_roots<mpz_int>(p, a, b); otherwise the coefficients' own type if it is unbounded, or
/// else errbound::integer.
template <class Integer = void, class C>
auto isolate_roots(const polynomial<C>& p, double a, double b) {
    using exact = roots::integer_for_t<Integer, C>;
    return real_roots<exact>(roots::staged<exact>(p), a, b);
}
/// Same as above; empty if the work would exceed the limits or `limits.stop` returns true.
template <class Integer = void, class C>
auto isolate_roots(const polynomial<C>& p, double a, double b, const root_limits& limits) {
    using exact = roots::integer_for_t<Integer, C>;
    return roots::unless_given_up(
        [&] { return real_roots<exact>(roots::staged<exact>(p), a, b, limits); });
}

/// The distinct real roots of p, ascending, each rounded to the nearest double, so two may be
/// equal. Precondition (asserted): p is not identically zero.
template <class Integer = void, class C>
std::vector<double> rounded_roots(const polynomial<C>& p) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    auto roots = isolate_roots<Integer>(p, -infinity, infinity);
    assert(!roots.everywhere());
    std::vector<double> all(roots.size());
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = roots.nearest_double(k);
    return all;
}

namespace roots {

/// Throws gave_up beyond the limits.
template <class Integer, class C>
std::size_t count_within(const polynomial<C>& p, double a, double b, const root_limits& limits) {
    using exact = roots::integer_for_t<Integer, C>;
    assert(roots::is_interval(a, b));
    if constexpr (std::is_same_v<C, double> || std::is_same_v<C, exact>) {
        // If the filter decides, no intervals are made and no integers copied.
        const auto c = roots::floating_coefficients(p.coefficients());
        const std::size_t zeros = roots::leading_zeros(c);
        const std::span others(c.begin() + static_cast<std::ptrdiff_t>(zeros), c.end());
        if (!others.empty() && a < b) {
            const roots::root_filter<tight> filter(others, a, b);
            if (filter.decides()) return filter.parts().size() + (zeros > 0 && a <= 0 && 0 <= b);
            return real_roots<exact>::count(roots::staged<exact>(p), a, b, filter.parts(), limits);
        }
    }
    const real_roots<exact> roots(roots::staged<exact>(p), a, b, limits);
    return roots.everywhere() ? infinitely_many : roots.size();
}

}  // namespace roots

/// The number of distinct roots of p in [a, b]; `infinitely_many` if p is identically zero.
template <class Integer = void, class C>
std::size_t count_roots(const polynomial<C>& p, double a, double b) {
    return roots::count_within<Integer>(p, a, b, {});
}
/// Same as above; empty if the work would exceed the limits or `limits.stop` returns true.
template <class Integer = void, class C>
std::optional<std::size_t> count_roots(const polynomial<C>& p, double a, double b,
                                       const root_limits& limits) {
    return roots::unless_given_up([&] { return roots::count_within<Integer>(p, a, b, limits); });
}

/// The count if floating point proves it for all polynomials within the coefficients' bounds,
/// otherwise empty. The rule must store only the absolute error, as tight and sharp do.
template <class Rule>
std::optional<std::size_t> count_roots(const polynomial<tracked<double, Rule>>& p, double a,
                                       double b) {
    static_assert(roots::absolute_rule<Rule>,
                  "errbound: count_roots needs a rule that stores only the absolute error, as "
                  "tight and sharp do: convert by within(x.value(), x.error())");
    assert(roots::is_interval(a, b));
    std::span others(p.coefficients());  // the filter takes only roots other than 0
    while (!others.empty() && others[0].value() == 0 && others[0].error() == 0)
        others = others.subspan(1);
    if (others.empty()) return infinitely_many;
    const bool zero = others.size() < p.coefficients().size() && a <= 0 && 0 <= b;
    if (a == b) {
        const sign_type s =
            zero ? sign_type::zero
                 : sign_of(roots::value_at(p.coefficients(), tracked<double, Rule>(a)));
        return certain(s) ? std::optional<std::size_t>(s == sign_type::zero) : std::nullopt;
    }
    const roots::root_filter<Rule> filter(others, a, b);
    if (!filter.decides()) return {};
    return filter.parts().size() + zero;
}

/// The greatest common divisor, with integer coefficients that have no common factor.
template <class Integer = void, class C>
auto common_factor(const polynomial<C>& p, const polynomial<C>& q) {
    using exact = roots::integer_for_t<Integer, C>;
    return polynomial<exact>(
        roots::common_factor(roots::staged<exact>(p).exact(), roots::staged<exact>(q).exact()));
}

/// The common roots of p and q in [a, b], with the lower multiplicity.
template <class Integer = void, class C>
auto common_roots(const polynomial<C>& p, const polynomial<C>& q, double a, double b) {
    return isolate_roots(common_factor<Integer>(p, q), a, b);
}

/// The signs that p takes on [a, b].
template <class Integer = void, class C>
occurring_signs sign_on(const polynomial<C>& p, double a, double b) {
    using exact = roots::integer_for_t<Integer, C>;
    return real_roots<exact>(roots::staged<exact>(p), a, b).signs_on(a, b);
}

namespace roots {

/// f as a form in (s, t) of degree N on [a, b]: x = (a·s + b·t)/(s + t).
template <int N, class S>
bernstein<S, N> form_on(const std::vector<S>& f, const S& a, const S& b, std::size_t first = 0) {
    const S c = first < f.size() ? f[first] : S(0);
    if constexpr (N == 0) {
        return {{c}};
    } else {
        auto p = bernstein<S, 1>{{a, b}} * form_on<N - 1>(f, a, b, first + 1);
        for (int i = 0; i <= N; ++i) p[i] = p[i] + c * S(binomial(N, i));
        return p;
    }
}

template <std::size_t M, class Integer>
existence by_bsc(const staged_polynomial<Integer>& f,
                 const std::vector<staged_polynomial<Integer>>& g, double a, double b) {
    using number = typename staged_polynomial<Integer>::number;
    return root_with_nonnegative(form_on<3, number>(f.floating(), a, b), [&] {
        std::array<bernstein<number, 4>, M> forms;
        for (std::size_t i = 0; i < M; ++i) forms[i] = form_on<4, number>(g[i].floating(), a, b);
        return forms;
    });
}

/// Bernstein sign classification (BSC), for one to four g if the degrees allow.
template <class Integer>
existence by_bsc(const staged_polynomial<Integer>& f,
                 const std::vector<staged_polynomial<Integer>>& g, double a, double b) {
    if (f.size() > 4 || !std::isfinite(a) || !std::isfinite(b)) return existence::maybe_root;
    for (const auto& p : g)
        if (p.size() > 5) return existence::maybe_root;
    switch (g.size()) {
        case 1:
            return by_bsc<1>(f, g, a, b);
        case 2:
            return by_bsc<2>(f, g, a, b);
        case 3:
            return by_bsc<3>(f, g, a, b);
        case 4:
            return by_bsc<4>(f, g, a, b);
        default:
            return existence::maybe_root;
    }
}

}  // namespace roots

/// True if some t in [a, b] has f(t) = 0 and every g_i(t) >= 0. BSC (errbound/bsc.hpp) runs first
/// if f has degree at most 3, there are one to four g_i of degree at most 4, and the interval is
/// finite.
template <class Integer = void, class C>
bool root_where_nonnegative(const polynomial<C>& f, const std::vector<polynomial<C>>& g, double a,
                            double b) {
    using exact = roots::integer_for_t<Integer, C>;
    assert(roots::is_interval(a, b));
    auto root_of = roots::staged<exact>(f);
    std::vector<roots::staged_polynomial<exact>> constraints;
    for (const polynomial<C>& p : g) constraints.push_back(roots::staged<exact>(p));
    const auto holds_at_any = [&](real_roots<exact> roots) {
        for (std::size_t k = 0; k < roots.size(); ++k) {
            const auto holds = [&](auto& p) { return roots.sign_at(p, k) != sign_type::negative; };
            if (std::all_of(constraints.begin(), constraints.end(), holds)) return true;
        }
        return false;
    };
    if (!root_of.is_zero()) {
        const existence quick = roots::by_bsc(root_of, constraints, a, b);
        if (quick == existence::yes || quick == existence::no) return quick == existence::yes;
        return holds_at_any(real_roots<exact>(std::move(root_of), a, b));
    }
    // f ≡ 0. The set with all g_i >= 0 is closed. If it is not empty and lacks the point of [a, b]
    // nearest to 0, its end towards that point is a root of some g_i.
    const double next_to_zero = (std::min)((std::max)(0.0, a), b);
    const roots::staged_polynomial<exact> shifted(std::vector<double>{-next_to_zero, 1.0});
    if (holds_at_any(real_roots<exact>(shifted, next_to_zero, next_to_zero))) return true;
    for (const auto& p : constraints)
        if (holds_at_any(real_roots<exact>(p, a, b))) return true;
    return false;
}

}  // namespace errbound
