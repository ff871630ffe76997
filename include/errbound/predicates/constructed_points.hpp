// Points given by other points, their parents, in the place of explicit points.
//   const auto i = errbound::line_line_point(a, b, c, d);  // where the lines ab and cd cross
//   errbound::sign_type s = errbound::incircle(i, p, q, r);
//
// Nothing is rounded: coordinates are anchor + x/w, for an explicit anchor and expressions x and w
// of the parents. The predicate's expression is evaluated over fractions with such denominators.
// This is a predicate of the parents of constructed points, and of the explicit points, with its
// own filter. A sign is zero if a point does not exist (w = 0). Parents may be constructed, too.
// Constructed points copy their parents. The coordinates of pointers and of types that only refer
// to them must outlive them. No rounding, no allocation. Cost where the filter decides: 2 to 10
// times that of explicit points.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <errbound/predicates.hpp>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>

namespace errbound {

/// Constructions: the parents' shape, the dimension, and a formula that returns an implicit point.
/// Write custom ones in this form.
struct line_line {
    using parents = points<2, 2, 2, 2>;
    static constexpr int dimension = 2;
    static constexpr auto formula(const auto&... p) { return forms::line_line(p...); }
};
struct line_plane {
    using parents = points<3, 3, 3, 3, 3>;
    static constexpr int dimension = 3;
    static constexpr auto formula(const auto&... p) { return forms::line_plane(p...); }
};
struct three_planes {
    using parents = points<3, 3, 3, 3, 3, 3, 3, 3, 3>;
    static constexpr int dimension = 3;
    static constexpr auto formula(const auto&... p) { return forms::three_planes(p...); }
};
template <int Dimension>
struct weighted_midpoint {
    using parents = points<Dimension, Dimension, 0, 0>;
    static constexpr int dimension = Dimension;
    static constexpr auto formula(const auto&... p) {
        return forms::weighted_midpoint<Dimension>(p...);
    }
};
/// Marks an explicit point in with_constructed.
struct given {};

template <class Construction, class... Parents>
struct constructed_point {
    std::tuple<Parents...> parents;
};
namespace filters {

/// An array, which decays to a pointer, becomes a std::array.
template <class Parent>
constexpr auto copy_of(const Parent& p) {
    if constexpr (std::is_bounded_array_v<Parent>)
        return std::to_array(p);
    else
        return p;
}

}  // namespace filters

template <class Construction, class... Parents>
constexpr auto construct(const Parents&... p) {
    static_assert(sizeof...(Parents) == Construction::parents::count,
                  "errbound: a construction takes one argument for each of its parents");
    return constructed_point<Construction, decltype(filters::copy_of(p))...>{
        {filters::copy_of(p)...}};
}
/// The intersection of the lines ab and cd in the plane.
constexpr auto line_line_point(const auto& a, const auto& b, const auto& c, const auto& d) {
    return construct<line_line>(a, b, c, d);
}
/// The intersection of the line ab and the plane pqr.
constexpr auto line_plane_point(const auto& a, const auto& b, const auto& p, const auto& q,
                                const auto& r) {
    return construct<line_plane>(a, b, p, q, r);
}
/// The intersection of three planes, each given by three points.
constexpr auto three_planes_point(const auto& a, const auto& b, const auto& c, const auto& d,
                                  const auto& e, const auto& f, const auto& g, const auto& h,
                                  const auto& i) {
    return construct<three_planes>(a, b, c, d, e, f, g, h, i);
}
/// The point (m·a + n·b)/(m + n), for numbers m and n.
template <int Dimension>
constexpr auto weighted_midpoint_of(const auto& a, const auto& b, const auto& m, const auto& n) {
    return construct<weighted_midpoint<Dimension>>(a, b, m, n);
}

namespace filters {

template <class Construction, class... Parents>
inline constexpr bool is_constructed<constructed_point<Construction, Parents...>> = true;

/// The denominators of all constructed points of a call, and their signs, none of them zero. If
/// parents are constructed, too, their fractions have a higher level.
template <int Level, class... W>
struct denominators {
    static constexpr int level = Level;
    std::tuple<W...> w;
    std::array<sign_type, sizeof...(W)> signs;
    using unit = std::integer_sequence<int, (static_cast<void>(sizeof(W)), 0)...>;
};

template <int... P, int... Q>
constexpr auto larger_powers(std::integer_sequence<int, P...>, std::integer_sequence<int, Q...>) {
    return std::integer_sequence<int, (P < Q ? Q : P)...>();
}
template <int... P, int... Q>
constexpr auto sum_of_powers(std::integer_sequence<int, P...>, std::integer_sequence<int, Q...>) {
    return std::integer_sequence<int, (P + Q)...>();
}
/// 1 for one denominator, 0 for the others.
template <std::size_t I, int... P>
constexpr auto single_power(std::integer_sequence<int, P...>) {
    return []<std::size_t... K>(std::index_sequence<K...>) {
        return std::integer_sequence<int, (K == I)...>();
    }
    (std::make_index_sequence<sizeof...(P)>());
}
template <int... P>
constexpr std::array<int, sizeof...(P)> as_array(std::integer_sequence<int, P...>) {
    return {P...};
}

/// number/(w_0^p_0·w_1^p_1·...)
template <class Number, class Denominators, class Powers>
struct fraction {
    using powers = Powers;
    Number number;
    const Denominators& over;

    constexpr auto operator-() const {
        return fraction<decltype(-number), Denominators, Powers>{-number, over};
    }
    friend constexpr sign_type sign_of(const fraction& x) {
        sign_type s = sign_of(x.number);
        constexpr auto p = as_array(Powers());
        for (std::size_t i = 0; i < p.size(); ++i)
            if (p[i] % 2 != 0) s = s * x.over.signs[i];
        return s;
    }
};
template <class Powers, class Denominators, class Number>
constexpr auto make_fraction(const Number& x, const Denominators& over) {
    return fraction<Number, Denominators, Powers>{x, over};
}

/// Coordinate anchor + x/w_I of a constructed point.
template <std::size_t I, class Anchor, class X, class Denominators>
struct constructed_coordinate {
    Anchor anchor;
    const X& x;
    const Denominators& over;

    constexpr const auto& w() const { return std::get<I>(over.w); }
    constexpr auto operator-() const { return -as_fraction(*this); }
    friend constexpr auto as_fraction(const constructed_coordinate& c) {
        return make_fraction<decltype(single_power<I>(typename Denominators::unit()))>(
            c.anchor * c.w() + c.x, c.over);
    }
    friend constexpr sign_type sign_of(const constructed_coordinate& c) {
        return sign_of(as_fraction(c));
    }
};
template <class N, class D, class P>
constexpr const fraction<N, D, P>& as_fraction(const fraction<N, D, P>& x) {
    return x;
}

template <class>
inline constexpr bool is_constructed_coordinate = false;
template <std::size_t I, class A, class X, class D>
inline constexpr bool is_constructed_coordinate<constructed_coordinate<I, A, X, D>> = true;
template <class X>
inline constexpr int fraction_level = (std::numeric_limits<int>::max)();
template <class N, class D, class P>
inline constexpr int fraction_level<fraction<N, D, P>> = D::level;
template <std::size_t I, class A, class X, class D>
inline constexpr int fraction_level<constructed_coordinate<I, A, X, D>> = D::level;
template <class X>
concept fraction_operand = fraction_level<X> < (std::numeric_limits<int>::max)();
template <class X, class Y>
concept of_equal_level = (fraction_level<X> == fraction_level<Y>);
/// A number without denominators of X's level: an int, a number, or a fraction of a higher level.
template <class Y, class X>
concept whole_operand = (fraction_level<Y> > fraction_level<X>);

/// x times the powers of the denominators by which `To` exceeds `From`.
template <class To, class From, std::size_t I = 0, class X, class Denominators>
constexpr auto raised_to(const X& x, const Denominators& over) {
    if constexpr (I == as_array(To()).size()) {
        return x;
    } else if constexpr (as_array(From())[I] < as_array(To())[I]) {
        using next = decltype(sum_of_powers(From(), single_power<I>(From())));
        return raised_to<To, next, I>(x * std::get<I>(over.w), over);
    } else {
        return raised_to<To, From, I + 1>(x, over);
    }
}
template <bool Subtract, class X, class Y>
constexpr auto sum_or_difference(const X& x, const Y& y) {
    if constexpr (Subtract)
        return x - y;
    else
        return x + y;
}
template <bool Subtract, class N, class D, class P, class M, class Q>
constexpr auto fraction_sum(const fraction<N, D, P>& x, const fraction<M, D, Q>& y) {
    using powers = decltype(larger_powers(P(), Q()));
    return make_fraction<powers>(
        sum_or_difference<Subtract>(raised_to<powers, P>(x.number, x.over),
                                    raised_to<powers, Q>(y.number, x.over)),
        x.over);
}
template <class D, class Y>
constexpr auto whole_fraction(const Y& y, const D& over) {
    return make_fraction<typename D::unit>(y, over);
}

template <fraction_operand X, of_equal_level<X> Y>
constexpr auto operator+(const X& x, const Y& y) {
    return fraction_sum<false>(as_fraction(x), as_fraction(y));
}
template <fraction_operand X, whole_operand<X> Y>
constexpr auto operator+(const X& x, const Y& y) {
    return fraction_sum<false>(as_fraction(x), whole_fraction(y, x.over));
}
template <fraction_operand Y, whole_operand<Y> X>
constexpr auto operator+(const X& x, const Y& y) {
    return y + x;
}
template <fraction_operand X, of_equal_level<X> Y>
constexpr auto operator-(const X& x, const Y& y) {
    return fraction_sum<true>(as_fraction(x), as_fraction(y));
}
/// The anchors are subtracted first, so that the filter's size depends on differences only.
template <std::size_t I, std::size_t J, class A, class B, class X, class Y, class D>
constexpr auto operator-(const constructed_coordinate<I, A, X, D>& x,
                         const constructed_coordinate<J, B, Y, D>& y) {
    const auto anchors = x.anchor - y.anchor;
    if constexpr (I == J) {
        return make_fraction<decltype(single_power<I>(typename D::unit()))>(
            anchors * x.w() + (x.x - y.x), x.over);
    } else {
        using powers = decltype(sum_of_powers(single_power<I>(typename D::unit()),
                                              single_power<J>(typename D::unit())));
        return make_fraction<powers>(anchors * (x.w() * y.w()) + (x.x * y.w() - y.x * x.w()),
                                     x.over);
    }
}
template <fraction_operand X, whole_operand<X> Y>
constexpr auto operator-(const X& x, const Y& y) {
    if constexpr (is_constructed_coordinate<X> && !std::same_as<Y, int>) {
        using powers = typename decltype(as_fraction(x))::powers;
        return make_fraction<powers>((x.anchor - y) * x.w() + x.x, x.over);
    } else {
        return fraction_sum<true>(as_fraction(x), whole_fraction(y, x.over));
    }
}
template <fraction_operand Y, whole_operand<Y> X>
constexpr auto operator-(const X& x, const Y& y) {
    if constexpr (is_constructed_coordinate<Y> && !std::same_as<X, int>) {
        using powers = typename decltype(as_fraction(y))::powers;
        return make_fraction<powers>((x - y.anchor) * y.w() - y.x, y.over);
    } else {
        return fraction_sum<true>(whole_fraction(x, y.over), as_fraction(y));
    }
}
template <fraction_operand X, of_equal_level<X> Y>
constexpr auto operator*(const X& x, const Y& y) {
    const auto& a = as_fraction(x);
    const auto& b = as_fraction(y);
    using powers = decltype(sum_of_powers(typename std::remove_cvref_t<decltype(a)>::powers(),
                                          typename std::remove_cvref_t<decltype(b)>::powers()));
    return make_fraction<powers>(a.number * b.number, x.over);
}
template <fraction_operand X, whole_operand<X> Y>
constexpr auto operator*(const X& x, const Y& y) {
    return as_fraction(x) * whole_fraction(y, x.over);
}
template <fraction_operand Y, whole_operand<Y> X>
constexpr auto operator*(const X& x, const Y& y) {
    return whole_fraction(x, y.over) * as_fraction(y);
}

/// A constructed point as an argument of an expression.
template <std::size_t I, class Implicit, class Denominators>
struct constructed_view {
    const Implicit& point;
    const Denominators& over;
    constexpr auto operator[](int i) const {
        using anchor = decltype(point.anchor[i]);
        const auto& x = [&]() -> const auto& {
            if constexpr (requires { point.z; })
                return i == 0 ? point.x : i == 1 ? point.y : point.z;
            else
                return i == 0 ? point.x : point.y;
        }
        ();
        return constructed_coordinate<I, anchor, std::remove_cvref_t<decltype(x)>, Denominators>{
            point.anchor[i], x, over};
    }
};

template <class...>
struct joined;
template <int... D>
struct joined<points<D...>> {
    using type = points<D...>;
};
template <int... D, int... E, class... Rest>
struct joined<points<D...>, points<E...>, Rest...> : joined<points<D..., E...>, Rest...> {};

/// The shape of an argument's parents: those of its construction, or an explicit point itself.
template <class Argument, int Dimension>
struct argument_traits {
    static_assert(Argument::dimension == Dimension,
                  "errbound: a constructed point's dimension differs from the predicate's shape");
    using parents = typename Argument::parents;
    static constexpr bool constructed = true;
};
template <int Dimension>
struct argument_traits<given, Dimension> {
    using parents = points<Dimension>;
    static constexpr bool constructed = false;
};

/// 0, or one more than that of the expression whose arguments are constructed, too.
template <class F>
inline constexpr int constructed_level = 0;
template <class Shape, class F, class... Arguments>
struct constructed_expression;
template <class Shape, class F, class... Arguments>
inline constexpr int constructed_level<constructed_expression<Shape, F, Arguments...>> =
    constructed_level<F> + 1;

/// An expression of all parents: F at the constructed points and the explicit points.
template <class Shape, class F, class... Arguments>
struct constructed_expression {
    static constexpr std::size_t count = sizeof...(Arguments);
    static_assert(count == Shape::count,
                  "errbound: a call takes one argument for each point of the predicate's shape");
    template <std::size_t I>
    using argument = std::tuple_element_t<I, std::tuple<Arguments...>>;
    template <std::size_t I>
    using traits = argument_traits<argument<I>, Shape::dimensions[I]>;

    template <class Sequence>
    struct parents_of;
    template <std::size_t... I>
    struct parents_of<std::index_sequence<I...>> {
        using type = typename joined<typename traits<I>::parents...>::type;
        static constexpr std::array<std::size_t, count> sizes{traits<I>::parents::count...};
        static constexpr std::array<bool, count> constructed{traits<I>::constructed...};
    };
    using all = parents_of<std::make_index_sequence<count>>;
    using shape = typename all::type;
    static constexpr std::size_t first(std::size_t argument) {
        std::size_t sum = 0;
        for (std::size_t i = 0; i < argument; ++i) sum += all::sizes[i];
        return sum;
    }
    /// The number of constructed points before an argument.
    static constexpr std::size_t rank(std::size_t argument) {
        std::size_t sum = 0;
        for (std::size_t i = 0; i < argument; ++i) sum += all::constructed[i];
        return sum;
    }

    constexpr auto operator()(const auto&... parents) const
        requires(sizeof...(parents) == shape::count) {
        return at(std::tie(parents...), std::make_index_sequence<count>());
    }

  private:
    template <std::size_t I, class Parents>
    static constexpr auto implicit(const Parents& parents) {
        if constexpr (all::constructed[I]) return [&]<std::size_t... K>(std::index_sequence<K...>) {
                return std::tuple{argument<I>::formula(std::get<first(I) + K>(parents)...)};
            }
        (std::make_index_sequence<all::sizes[I]>());
        else return std::tuple<>();
    }
    template <class Parents, std::size_t... I>
    static constexpr sign_type at(const Parents& parents, std::index_sequence<I...>) {
        const auto implicits = std::tuple_cat(implicit<I>(parents)...);
        return std::apply(
            [&](const auto&... q) {
                const denominators<constructed_level<F>, std::remove_cvref_t<decltype(q.w)>...>
                    over{{q.w...}, {sign_of(q.w)...}};
                for (const sign_type s : over.signs)
                    if (s == sign_type::zero) return s;
                for (const sign_type s : over.signs)
                    if (!certain(s)) return s;
                return conclude(F()(view<I>(parents, implicits, over)...));
            },
            implicits);
    }
    template <std::size_t I>
    static constexpr decltype(auto) view(const auto& parents, const auto& implicits,
                                         const auto& over) {
        if constexpr (all::constructed[I]) {
            const auto& q = std::get<rank(I)>(implicits);
            return constructed_view<rank(I), std::remove_cvref_t<decltype(q)>,
                                    std::remove_cvref_t<decltype(over)>>{q, over};
        } else {
            return std::get<first(I)>(parents);
        }
    }
};
template <class Shape, class F, class... Arguments>
inline constexpr bool is_sign_of_fraction<constructed_expression<Shape, F, Arguments...>> =
    !branches<Shape, F> || is_sign_of_fraction<F>;
/// The degrees of the options are those of the predicate's own coordinates.
template <class Options>
struct constructed_options : Options {
    static constexpr std::array<int, 0> degrees{};
};

template <class Point>
struct argument_of {
    using type = given;
};
template <class Construction, class... Parents>
struct argument_of<constructed_point<Construction, Parents...>> {
    using type = Construction;
};
template <class Point>
constexpr auto parents_of(const Point& p) {
    if constexpr (is_constructed<Point>)
        return std::apply([](const auto&... q) { return std::tie(q...); }, p.parents);
    else
        return std::tie(p);
}

}  // namespace filters

/// The predicate of all parents of the arguments, which are constructions or `given`. For batches,
/// stages and counts; a call with constructed points uses it.
///   constexpr auto f = errbound::with_constructed<line_line, given, given>(errbound::orient2d);
///   f(a, b, c, d, q, r);  // orient2d(line_line_point(a, b, c, d), q, r)
template <class... Arguments, class Shape, class F, class Options>
constexpr auto with_constructed(const predicate_type<Shape, F, Options>&) {
    using expression = filters::constructed_expression<Shape, F, Arguments...>;
    return predicate_type<typename expression::shape, expression,
                          filters::constructed_options<Options>>();
}

/// Calls the predicate at these points, some of which are constructed.
template <class Predicate, class... Leading, class... Points>
[[gnu::always_inline]] constexpr sign_type call_constructed(const Predicate& predicate,
                                                            const std::tuple<Leading...>& leading,
                                                            const Points&... p) {
    return std::apply(with_constructed<typename filters::argument_of<Points>::type...>(predicate),
                      std::tuple_cat(leading, filters::parents_of(p)...));
}

}  // namespace errbound
