// Predicates: an expression, written once, whose sign is right on every finite input.
//
//   inline constexpr auto orient2d = errbound::predicate<errbound::points<2, 2, 2>>(
//       [](const auto& a, const auto& b, const auto& c) {
//           return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
//       });
//   errbound::sign_type s = orient2d(p, q, r);  // arrays, spans, Eigen vectors, structs of x, y, z
//
// The expression is a program of +, − and × on coordinates and whole constants. Every result has a
// type of its own, so its variables are `auto` and are not assigned to. It may branch on signs:
// then it asks sign_of(x), passes on `uncertain` (returns it at once), and returns a sign_type.
//
// It is run on one scalar after the other, until one is certain (`predicate_stage`):
//  * semi_static_filter, of expressions of many terms: in floating point, with a bound from the
//    largest coordinate difference;
//  * static_filter: in floating point, with a bound whose constant the types count while the
//    expression is compiled; no branch but the last;
//  * tracked: errbound::tracked, under the bound rule of the options, if they name one;
//  * integers: exact, coordinates on a common exponent. As they need it: of so few bits that
//    doubles hold all results, or words of 128 bits do; coordinates of one word, of two, or of up
//    to the full range of exponents (an expression that branches has no stage of two words).
//    Without allocation; or the options' own exact type takes the place of the last.
//
// Promised, for finite coordinates, under rounding to nearest and gradual underflow
// (errbound/environment.hpp), contraction allowed: never uncertain, never wrong; underflow and
// overflow included. `uncertain` where a coordinate that counts is not finite. No exceptions, no
// global state. Usable in constant expressions; in device code (compiled, not yet run). Cost:
// the filters 1 to 2 times the expression in floating point, the integers some ten times that, and
// in the full range up to 30 µs for a degree of 5 and, optimised, 64 KiB of stack for one of 32.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <errbound/filters/coordinates.hpp>
#include <errbound/filters/expression_count.hpp>
#include <errbound/filters/predicate_report.hpp>
#include <errbound/filters/predicate_scalars.hpp>
#include <errbound/filters/predicate_stages.hpp>
#include <errbound/filters/static_filter.hpp>
#include <errbound/sign.hpp>
#include <type_traits>
#include <utility>

namespace errbound {

/// What a predicate takes: points of these dimensions. 0 is a plain number.
template <int... Dimensions>
struct points {
    static_assert(sizeof...(Dimensions) > 0 && ((Dimensions >= 0) && ...),
                  "errbound: points<2, 2, 0> are two points of two coordinates and a plain number: "
                  "at least one, and none negative");
    static constexpr std::size_t count = sizeof...(Dimensions);
    static constexpr std::array<int, count> dimensions{Dimensions...};
    /// How many numbers these are.
    static constexpr std::size_t size = (std::size_t{Dimensions == 0 ? 1 : Dimensions} + ... + 0);
    static constexpr std::size_t offset(std::size_t argument) {
        std::size_t o = 0;
        for (std::size_t i = 0; i < argument; ++i)
            o += dimensions[i] == 0 ? 1 : static_cast<std::size_t>(dimensions[i]);
        return o;
    }
};

/// The defaults; derive from it to change some.
struct predicate_options {
    /// Bound rule of the tracked stage; void: no such stage.
    using tracked_rule = void;
    /// Exact number type of the last stage, constructible from double; void: long_integer. For
    /// Boost.Multiprecision's see predicate_type::value.
    using exact_type = void;
    /// Whether terms of different degree are never added, so that powers of two scale coordinates
    /// without changing a sign. It is found out for all expressions but those with too many
    /// branches; a false claim does not compile.
    static constexpr bool homogeneous = false;
    /// The degree of every coordinate, as the shape lists them, where some are not of degree 1:
    /// {1, 1, 2, 1, 1, 2} of points<3, 3>, each x, y and a squared radius. By these degrees terms
    /// of different degree are never added; a false claim does not compile. Coordinates far from 1
    /// are then brought near it by powers of two, which changes no sign.
    static constexpr std::array<int, 0> degrees{};
};

namespace filters {

template <class>
inline constexpr bool is_shape = false;
template <int... Dimensions>
inline constexpr bool is_shape<points<Dimensions...>> = true;
template <class Number>
concept exact_stage_number = requires(const Number& x) {
    Number(0.5);
    { sign_of(x) } -> std::same_as<sign_type>;
};

}  // namespace filters

template <class Shape, class F, class Options>
class predicate_type {
    static_assert(filters::is_shape<Shape>,
                  "errbound: predicate's first argument says what it takes: points<2, 2, 2>");
    static_assert(std::is_empty_v<F> && std::is_default_constructible_v<F>,
                  "errbound: a predicate's expression must not have captures or members: what "
                  "varies is an argument, a plain number 0 in the shape");
    static_assert(std::derived_from<Options, predicate_options>,
                  "errbound: a predicate's options derive from errbound::predicate_options");
    static_assert(std::is_void_v<typename Options::tracked_rule> ||
                      promises_bound<typename Options::tracked_rule>,
                  "errbound: a predicate's tracked_rule promises bounds, which `none` and "
                  "`stochastic` do not: its signs would be guesses");
    static_assert(std::is_void_v<typename Options::exact_type> ||
                      filters::exact_stage_number<typename Options::exact_type>,
                  "errbound: exact_type is constructible from double and has a sign_of; for "
                  "Boost.Multiprecision's include errbound/multiprecision.hpp");

    using stages = filters::predicate_stages<Shape, F, Options>;

  public:
    using shape = Shape;
    using options = Options;

    /// What the expression asks, for coordinates of one word.
    static constexpr filters::expression_counts counts = stages::counts;
    /// The static filter's: certain where |value| exceeds it times the sum of the terms' sizes. Of
    /// an expression that branches, the largest of all.
    template <class T>
    static constexpr T static_constant = filters::filter_constant<T>(counts.roundings);
    /// Whether there is a semi-static filter: what it saves grows with the degree.
    static constexpr bool has_semi_static_filter = stages::has_semi_static_filter;
    /// So many bits may coordinates have for no result to take more than `bits`.
    static constexpr int coordinate_bits(int bits) { return stages::coordinate_bits(bits); }

    /// The sign. Points: anything that coordinate_of takes, of float or double.
    template <class... Points>
    [[gnu::flatten]] constexpr sign_type operator()(const Points&... p) const {
        // Overflow is no constant expression.
        if (!std::is_constant_evaluated()) {
            const sign_type s = first_sign(p...);
            if (certain(s)) [[likely]]
                return s;
        }
        return stages::template decide<number_of<Points...>>(stages::listed(p...), nullptr);
    }
    /// The same, and the stage that decided is counted.
    template <class... Points>
    constexpr sign_type operator()(predicate_report& report, const Points&... p) const {
        using enum predicate_stage;
        const sign_type s = first_sign(p...);
        if (certain(s)) {
            report.count(has_semi_static_filter ? semi_static_filter : static_filter);
            return s;
        }
        return stages::template decide<number_of<Points...>>(stages::listed(p...), &report);
    }
    /// What the first filter finds out, or the sign_type of an expression that branches. Stored:
    /// coordinates are read from memory, so that nothing can be fused with their differences.
    template <bool Stored = false, class... Points>
    static constexpr auto estimate(const Points&... p) {
        using T = number_of<Points...>;
        if constexpr (has_semi_static_filter) {
            T largest = 0;
            const auto x = filters::evaluate<Shape>(
                F(), filters::semi_static_scalars<T, Stored, Points...>{{p...}, &largest});
            return filters::sign_estimate<T>{x.value, x.bound(largest)};
        } else {
            const auto x = filtered<Stored>(p...);
            if constexpr (std::is_same_v<decltype(x), const sign_type>)
                return x;
            else
                return filters::sign_estimate<T>{x.value, x.bound()};
        }
    }
    /// What the static filter computes: a value, with its bound, or the sign_type of an expression
    /// that branches.
    template <bool Stored = false, class... Points>
    static constexpr auto filtered(const Points&... p) {
        using scalars = filters::filtered_scalars<number_of<Points...>, Stored, Points...>;
        return filters::evaluate<Shape>(F(), scalars{{p...}});
    }
    /// The expression's value over a number type of one's own, constructible from a coordinate.
    /// Boost.Multiprecision's types: without expression templates (et_off), which do not outlive
    /// the statements of an expression.
    template <class Number, class... Points>
    static constexpr auto value(const Points&... p) {
        const auto make = [](const auto& x) { return Number(x); };
        const auto list = stages::listed(p...);
        return filters::evaluate<Shape>(
            F(), filters::listed_scalars<Shape, typename stages::coordinate_list, decltype(make)>{
                     list, make});
    }
    /// The sign that one stage alone finds.
    template <class... Points>
    constexpr sign_type by(predicate_stage stage, const Points&... p) const {
        using enum predicate_stage;
        if (stage == static_filter) return filters::conclude(filtered(p...));
        if (stage == semi_static_filter)
            return has_semi_static_filter ? first_sign(p...) : sign_type::uncertain;
        return stages::template by<number_of<Points...>>(stage, stages::listed(p...));
    }

  private:
    template <class... Points, std::size_t... I>
    static constexpr bool has_dimensions(std::index_sequence<I...>) {
        return sizeof...(Points) != Shape::count ||
               ((filters::max_dimension<Points>() == 0 ||
                 static_cast<int>(filters::max_dimension<Points>()) >= Shape::dimensions[I]) &&
                ...);
    }
    template <class... Points>
    struct number {
        static_assert(sizeof...(Points) == Shape::count,
                      "errbound: a call takes as many arguments as the predicate's shape says");
        using type = std::common_type_t<decltype(coordinate_of(std::declval<Points>(), 0))...>;
        static_assert(has_dimensions<Points...>(std::index_sequence_for<Points...>()),
                      "errbound: a point has fewer coordinates than the predicate's shape says");
        static_assert(
            (std::floating_point<decltype(coordinate_of(std::declval<Points>(), 0))> && ...) &&
                sizeof(type) <= sizeof(double),
            "errbound: coordinates must be float or double: convert whole ones of at most "
            "53 bits, as by static_cast<double>(n) or p.cast<double>()");
    };
    template <class... Points>
    using number_of = typename number<Points...>::type;

    template <class... Points>
    static constexpr sign_type first_sign(const Points&... p) {
        if constexpr (has_semi_static_filter)
            return filters::conclude(estimate(p...));
        else
            return filters::conclude(filtered(p...));
    }
};

/// The predicate of an expression: see the head of this file.
template <class Shape, class Options = predicate_options, class F>
constexpr predicate_type<Shape, F, Options> predicate(F) {
    return {};
}

}  // namespace errbound
