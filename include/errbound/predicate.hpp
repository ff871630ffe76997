// Predicates: an expression, written once, whose sign is right on every finite input.
//   inline constexpr auto orient2d = errbound::predicate<errbound::points<2, 2, 2>>(
//       [](const auto& a, const auto& b, const auto& c) {
//           return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
//       });
//   errbound::sign_type s = orient2d(p, q, r);  // arrays, spans, Eigen vectors, structs of x, y, z
//
// The sign is never wrong, overflow and underflow included, and `uncertain` only if a coordinate is
// not finite. Needs rounding to nearest and gradual underflow (errbound/environment.hpp). No
// exceptions, no global state, no allocation. See predicate() for rules, stages and cost.
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
#include <tuple>
#include <type_traits>
#include <utility>

namespace errbound {

/// A predicate's arguments: points of these dimensions. Dimension 0 is a plain number.
template <int... Dimensions>
struct points {
    static_assert(sizeof...(Dimensions) > 0 && ((Dimensions >= 0) && ...),
                  "errbound: points<2, 2, 0> are two points of two coordinates and a plain number: "
                  "at least one, and none negative");
    static constexpr std::size_t count = sizeof...(Dimensions);
    static constexpr std::array<int, count> dimensions{Dimensions...};
    static constexpr std::size_t size = (std::size_t{Dimensions == 0 ? 1 : Dimensions} + ... + 0);
    static constexpr std::size_t offset(std::size_t argument) {
        std::size_t o = 0;
        for (std::size_t i = 0; i < argument; ++i)
            o += dimensions[i] == 0 ? 1 : static_cast<std::size_t>(dimensions[i]);
        return o;
    }
};

/// The defaults. Derive from them to change some.
struct predicate_options {
    using tracked_rule = void;  ///< bound rule of the tracked stage; void: no such stage
    /// Exact number type of the last stage, constructible from double; void: long_integer. For
    /// Boost.Multiprecision's types see predicate_type::value.
    using exact_type = void;
    /// Set true only if terms of different degree are never added (scaling by powers of two then
    /// keeps signs); a predicate that does add them does not compile with it. Needed only if the
    /// expression has too many branches for the compiler to detect this.
    static constexpr bool homogeneous = false;
    /// One degree >= 1 per coordinate in the shape's order, if not all are 1. Example: points<3, 3>
    /// of x, y and a squared radius have {1, 1, 2, 1, 1, 2}. Coordinates far from 1 are then scaled
    /// by powers of two. If terms of different total degree are added, or if there are too many
    /// branches to detect this, the predicate does not compile.
    static constexpr std::array<int, 0> degrees{};
};

namespace filters {

template <class>
inline constexpr bool is_shape = false;
template <int... Dimensions>
inline constexpr bool is_shape<points<Dimensions...>> = true;
/// True for constructed points (errbound/predicates/constructed_points.hpp).
template <class Point>
inline constexpr bool is_constructed = false;
/// True for expressions that return the sign of a fraction of polynomials, or zero if its
/// denominator is zero.
template <class F>
inline constexpr bool is_sign_of_fraction = false;
template <class Number>
concept exact_stage_number = requires(const Number& x) {
    Number(0.5);
    { sign_of(x) } -> std::same_as<sign_type>;
};

}  // namespace filters

template <class Shape, class F, class Options>
class predicate_type {
    static_assert(filters::is_shape<Shape>,
                  "errbound: predicate's first argument must be a shape: points<2, 2, 2>");
    static_assert(std::is_empty_v<F> && std::is_default_constructible_v<F>,
                  "errbound: a predicate's expression must not have captures or members: pass "
                  "varying values as arguments (0 in the shape is a plain number)");
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

    /// Counts of the expression. `bits` assumes coordinates of 61 bits, the most for word_integers.
    static constexpr filters::expression_counts counts = stages::counts;
    /// The static filter's constant, if counts.complete. A sign is certain if |value| exceeds the
    /// constant times the size, which is the value with every term positive
    /// (filters/static_filter.hpp). If the expression evaluates several signs, this is the largest
    /// of their constants.
    template <class T>
    static constexpr T static_constant = filters::filter_constant<T>(counts.roundings);
    /// True from degree 5 on, unless the expression branches or adds terms of different degree.
    /// A semi-static filter's bound needs no size, only the largest coordinate or difference.
    static constexpr bool has_semi_static_filter = stages::has_semi_static_filter;
    /// Largest coordinate width, at most 61, for which every result fits in `bits` bits; below 1 if
    /// there is none or counts.complete is false.
    static constexpr int coordinate_bits(int bits) { return stages::coordinate_bits(bits); }

    /// Returns the sign. Points: any type that coordinate_of accepts, with float or double numbers,
    /// or constructed points (errbound/predicates/constructed_points.hpp).
    template <class... Points>
    [[gnu::flatten]] constexpr sign_type operator()(const Points&... p) const {
        if constexpr ((filters::is_constructed<Points> || ...)) {
            return call_constructed(*this, std::tuple(), p...);
        } else {
            // Overflow is not allowed in constant expressions.
            if (!std::is_constant_evaluated()) {
                const sign_type s = first_sign(p...);
                if (certain(s)) [[likely]]
                    return s;
            }
            return stages::template decide<number_of<Points...>>(stages::listed(p...), nullptr);
        }
    }
    /// Same as above, and counts the deciding stage in the report, or `undecided` if a coordinate
    /// is not finite.
    template <class... Points>
    constexpr sign_type operator()(predicate_report& report, const Points&... p) const {
        if constexpr ((filters::is_constructed<Points> || ...)) {
            return call_constructed(*this, std::tie(report), p...);
        } else {
            using enum predicate_stage;
            const sign_type s = first_sign(p...);
            if (certain(s)) {
                report.count(has_semi_static_filter ? semi_static_filter : static_filter);
                return s;
            }
            return stages::template decide<number_of<Points...>>(stages::listed(p...), &report);
        }
    }
    /// The first filter's value and bound, or the sign_type of an expression that branches. With
    /// Stored = false, coordinates may be computed on access, as 2 * p: each is rounded before the
    /// expression uses it, and never fused (FMA) into a difference, so all stages use the same
    /// coordinate. Pass true only if all coordinates are values in memory.
    template <bool Stored = false, class... Points>
    static constexpr auto estimate(const Points&... p) {
        using T = number_of<Points...>;
        if constexpr (has_semi_static_filter) {
            T largest = 0;
            const T value = filters::evaluate<Shape>(
                F(), filters::measured_scalars<T, Stored, Points...>{{p...}, &largest});
            constexpr auto count = stages::template semi_static_count<T>;
            return filters::sign_estimate<T>{value, count.bound(largest)};
        } else {
            const auto x = filtered<Stored>(p...);
            if constexpr (std::is_same_v<decltype(x), const sign_type>)
                return x;
            else
                return filters::sign_estimate<T>{x.value, x.bound()};
        }
    }
    /// The static filter's value and bound(), or the sign_type of an expression that branches.
    template <bool Stored = false, class... Points>
    static constexpr auto filtered(const Points&... p) {
        using scalars = filters::filtered_scalars<number_of<Points...>, Stored, Points...>;
        return filters::evaluate<Shape>(F(), scalars{{p...}});
    }
    /// The expression's value in a custom number type, constructible from a coordinate. Types of
    /// Boost.Multiprecision need et_off: expression templates would refer to destroyed temporaries.
    template <class Number, class... Points>
    static constexpr auto value(const Points&... p) {
        const auto make = [](const auto& x) { return Number(x); };
        const auto list = stages::listed(p...);
        return filters::evaluate<Shape>(
            F(), filters::listed_scalars<Shape, typename stages::coordinate_list, decltype(make)>{
                     list, make});
    }
    /// The sign by this stage only; `uncertain` if the stage does not decide. Without a
    /// tracked_rule, `tracked` uses `tight`. Here two_word_integers also decides expressions that
    /// branch, for which calls skip this stage.
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
                      "errbound: a call takes one argument for each point of the predicate's "
                      "shape");
        using type = std::common_type_t<decltype(coordinate_of(std::declval<Points>(), 0))...>;
        static_assert(has_dimensions<Points...>(std::index_sequence_for<Points...>()),
                      "errbound: a point has fewer coordinates than the predicate's shape");
        static_assert(
            (std::floating_point<decltype(coordinate_of(std::declval<Points>(), 0))> && ...) &&
                sizeof(type) <= sizeof(double),
            "errbound: coordinates must be float or double: convert integers of at most 53 "
            "bits, by static_cast<double>(n) or p.cast<double>()");
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

/// The predicate of an expression: a function of +, − and × on coordinates and int constants. Every
/// result has its own type, so variables are `auto` and never reassigned. An expression that
/// branches on sign_of(x) returns a sign_type, and `uncertain` rather than branch on an uncertain
/// sign. Every expression that returns a sign_type counts as one that branches.
///
/// The stages (`predicate_stage`) run in this order until one is certain:
/// - semi_static_filter, from degree 5 on (see has_semi_static_filter);
/// - static_filter: floating point, with a bound whose constant is counted at compile time;
/// - tracked: errbound::tracked under the options' rule, if any;
/// - exact stages, on coordinates as integers times one power of two. exact_doubles and
///   short_integers hold results of 53 and 127 bits; word_integers and two_word_integers hold
///   coordinates of 61 and 124 bits; long_integers (or the options' exact type) hold any.
///   two_word_integers are skipped if the expression branches or its degree exceeds 6,
///   exact_doubles if they hold only coordinates of less than 8 bits.
///
/// Contraction to FMA is allowed. Predicates work in constant expressions and in device code
/// (compiled, not yet run). Filters cost 1 to 3 times the plain expression, integers 10 to
/// 100 times; long_integers take up to 30 µs at degree 5. Optimised code needs at most 64 KiB of
/// stack up to degree 32.
template <class Shape, class Options = predicate_options, class F>
constexpr predicate_type<Shape, F, Options> predicate(F) {
    return {};
}

}  // namespace errbound
