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
//    largest coordinate difference (errbound/filters/semi_static_filter.hpp);
//  * static_filter: in floating point, with a bound whose constant the types count while the
//    expression is compiled (errbound/filters/static_filter.hpp); no branch but the last;
//  * tracked: errbound::tracked, under the bound rule of the options, if they name one;
//  * integers: exact, coordinates on a common exponent. As they need it: of so few bits that
//    doubles hold all results, or words of 128 bits do; coordinates of one word, of two, or of up
//    to the full range of exponents. Without allocation; or the options' own exact type takes the
//    place of the last.
//
// Promised, for finite coordinates, under rounding to nearest and gradual underflow
// (errbound/environment.hpp), contraction allowed: never uncertain, never wrong; underflow and
// overflow included. `uncertain` where a coordinate that counts is not finite. No exceptions, no
// global state. Usable in constant expressions; in device code (compiled, not yet run). Cost:
// the filters 1 to 2 times the expression in floating point, the integers some ten times that, and
// in the full range up to 30 µs and some 100 KiB of stack for a degree of 5.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <errbound/filters/expression_count.hpp>
#include <errbound/filters/semi_static_filter.hpp>
#include <errbound/filters/static_filter.hpp>
#include <errbound/integers/common_exponent.hpp>
#include <errbound/integers/sized_integer.hpp>
#include <errbound/sign.hpp>
#include <errbound/tracked.hpp>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>

namespace errbound {

/// What a predicate takes: points of these dimensions. 0 is a plain number.
template <int... Dimensions>
struct points {
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

/// In the order in which an input passes them; it leaves at the first that is certain.
enum class predicate_stage : std::uint8_t {
    semi_static_filter,
    static_filter,
    tracked,
    exact_doubles,   ///< coordinates so short that no result takes more than 53 bits
    short_integers,  ///< so short that none takes more than 128
    word_integers,
    two_word_integers,
    long_integers,  ///< any finite coordinates; or the options' exact type
};
inline constexpr std::size_t predicate_stage_count = 8;

/// How many inputs each stage decided; `undecided` had coordinates that were not finite.
struct predicate_report {
    std::array<std::uint64_t, predicate_stage_count> decided{};
    std::uint64_t undecided = 0;

    std::uint64_t operator[](predicate_stage s) const {
        return decided[static_cast<std::size_t>(s)];
    }
    void count(predicate_stage s) { ++decided[static_cast<std::size_t>(s)]; }
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
    /// branches (errbound/filters/expression_count.hpp); a false claim does not compile.
    static constexpr bool homogeneous = false;
};

/// Coordinate i of a point, or the number itself, of what users have as points.
template <class Point>
constexpr auto coordinate_of(const Point& p, int i) {
    if constexpr (std::is_arithmetic_v<Point>) {
        return p;
    } else if constexpr (requires { p[i]; }) {
        return p[static_cast<std::size_t>(i)];
    } else if constexpr (requires { p.x() + p.y(); }) {
        if constexpr (requires { p.z(); })
            return i == 0 ? p.x() : i == 1 ? p.y() : p.z();
        else
            return i == 0 ? p.x() : p.y();
    } else {
        static_assert(
            requires { p.x + p.y; },
            "errbound: a point needs p[i], or x, y (and z) as members or member functions");
        if constexpr (requires { p.z; })
            return i == 0 ? p.x : i == 1 ? p.y : p.z;
        else
            return i == 0 ? p.x : p.y;
    }
}

/// How many coordinates a point is known to have; 0 if its type does not tell. x and y without z,
/// as members or functions, are two: of a point with a third under another name it takes p[i].
template <class Point>
constexpr std::size_t known_dimension() {
    constexpr auto has = [](auto test) {
        return std::is_invocable_v<decltype(test), const Point&>;
    };
    if constexpr (std::is_arithmetic_v<Point>) {
        return 1;
    } else if constexpr (requires { Point::SizeAtCompileTime; }) {
        return Point::SizeAtCompileTime > 0 ? std::size_t{Point::SizeAtCompileTime} : 0;
    } else if constexpr (std::is_array_v<Point>) {
        return std::extent_v<Point>;
    } else if constexpr (requires { std::tuple_size<Point>::value; }) {
        return std::tuple_size_v<Point>;
    } else if constexpr (has([](const auto& p) -> decltype(p[0]) { return p[0]; })) {
        return 0;
    } else if constexpr (has([](const auto& p) -> decltype(p.z()) { return p.z(); }) ||
                         has([](const auto& p) -> decltype(p.z) { return p.z; })) {
        return 3;
    } else if constexpr (has([](const auto& p) -> decltype(p.y()) { return p.y(); }) ||
                         has([](const auto& p) -> decltype(p.y) { return p.y; })) {
        return 2;
    } else {
        return 0;
    }
}

namespace detail {

/// The argument of a predicate that an expression sees: coordinates become scalars when asked for.
template <class Scalars, std::size_t Argument>
struct point_view {
    const Scalars& scalars;
    constexpr decltype(auto) operator[](int i) const { return scalars.template at<Argument>(i); }
};
template <class Shape, std::size_t Argument, class Scalars>
constexpr auto view(const Scalars& scalars) {
    if constexpr (Shape::dimensions[Argument] == 0)
        return scalars.template at<Argument>(0);
    else
        return point_view<Scalars, Argument>{scalars};
}

/// Coordinate i of a point, as a filter may use it: where it is not stored but computed, a product
/// in it must not be fused with the difference that uses it, since all stages must see one number.
template <class T, bool Stored, class Point>
constexpr T settled_coordinate(const Point& p, int i) {
    const T x = coordinate_of(p, i);
    if constexpr (Stored)
        return x;
    else
        return rounded(x);
}
/// Coordinates, where they are, for the static filter.
template <class T, bool Stored, class... Points>
struct filtered_scalars {
    std::tuple<const Points&...> points;
    template <std::size_t Argument>
    constexpr filters::filtered_coordinate<T> at(int i) const {
        return {settled_coordinate<T, Stored>(std::get<Argument>(points), i)};
    }
};
/// The same for the semi-static one.
template <class T, bool Stored, class... Points>
struct semi_static_scalars {
    std::tuple<const Points&...> points;
    T* largest;
    template <std::size_t Argument>
    constexpr filters::semi_static_coordinate<T> at(int i) const {
        return {settled_coordinate<T, Stored>(std::get<Argument>(points), i), largest};
    }
};
/// Coordinates one after the other, made into scalars by a function, which may refer to them.
template <class Shape, class List, class Make>
struct listed_scalars {
    const List& list;
    Make make;
    template <std::size_t Argument>
    constexpr decltype(auto) at(int i) const {
        constexpr std::size_t first = Shape::offset(Argument);
        return make(list[first + static_cast<std::size_t>(i)]);
    }
};
/// Not for constant expressions: an expression that gets here does not compile.
inline void coordinate_that_the_point_lacks() {}
/// Coordinates that only count.
template <class Shape>
struct counted_scalars {
    filters::counting_run& run;
    template <std::size_t Argument>
    constexpr filters::expression_count at(int i) const {
        if (i < 0 || (i > 0 && i >= Shape::dimensions[Argument])) coordinate_that_the_point_lacks();
        return filters::expression_count(run);
    }
};

/// A value whose sign is certain where its size exceeds the bound.
template <class T>
struct sign_estimate {
    T value, bound;

    friend constexpr sign_type sign_of(const sign_estimate& x) {
        bool decided = number_traits<T>::abs(x.value) > x.bound;
        if constexpr (may_contract)  // see errbound/filters/static_filter.hpp
            decided = decided && number_traits<T>::is_finite(x.value);
        if (decided) [[likely]]
            return x.value > 0 ? sign_type::positive : sign_type::negative;
        return sign_type::uncertain;
    }
};
/// A result's sign, if it is not one.
template <class X>
constexpr sign_type conclude(const X& x) {
    if constexpr (std::is_same_v<X, sign_type>)
        return x;
    else
        return sign_of(x);
}

template <class Shape, class F, class Scalars>
constexpr auto evaluate(const F& f, const Scalars& scalars) {
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
        return f(view<Shape, I>(scalars)...);
    }
    (std::make_index_sequence<Shape::count>());
}
template <class Shape, class F, class List, class Make>
constexpr sign_type sign_over(const F& f, const List& list, const Make& make) {
    return conclude(evaluate<Shape>(f, listed_scalars<Shape, List, Make>{list, make}));
}

/// Not for constant expressions either: such an expression could not pass on `uncertain`.
inline void expression_that_asks_for_signs_must_return_one() {}
/// What the expression asks for coordinates of this many bits.
template <class Shape, class F>
constexpr filters::expression_counts counts_of(int coordinate_bits) {
    return filters::count_expression(coordinate_bits, [](filters::counting_run& run) {
        const auto x = evaluate<Shape>(F(), counted_scalars<Shape>{run});
        if (!std::is_same_v<decltype(x), const sign_type> && run.asked > 0)
            expression_that_asks_for_signs_must_return_one();
        (void)conclude(x);
    });
}

}  // namespace detail

template <class Shape, class F, class Options>
class predicate_type {
    static_assert(std::is_empty_v<F> && std::is_default_constructible_v<F>,
                  "errbound: a predicate's expression must not have captures or members");

  public:
    using shape = Shape;
    using options = Options;

    /// Of coordinates that fit a word.
    static constexpr int word_bits = integers::word_coordinates<1>::max_bits;
    /// Counts for coordinates of one word.
    static constexpr filters::expression_counts counts = detail::counts_of<Shape, F>(word_bits);
    /// The static filter's: certain where |value| exceeds it times the sum of the terms' sizes. Of
    /// an expression that branches, the largest of all.
    template <class T>
    static constexpr T static_constant = filters::filter_constant<T>(counts.roundings);
    /// Whether there is a semi-static filter: what it saves grows with the degree.
    static constexpr bool has_semi_static_filter =
        !counts.mixed && counts.degree >= 5 &&
        !std::is_same_v<sign_type,
                        decltype(detail::evaluate<Shape>(
                            F(), std::declval<const detail::counted_scalars<Shape>&>()))>;
    /// So many bits may coordinates have for no result to take more than `bits`.
    /// Proof: proofs/Widths.v, coordinate_bits_enough.
    static constexpr int coordinate_bits(int bits) {
        int least = word_bits;
        for (int degree = 0; degree <= filters::expression_counts::max_degree; ++degree) {
            const int excess = counts.bits[static_cast<std::size_t>(degree)] - bits;
            if (excess <= 0) continue;
            least = std::min(least, degree == 0 ? 0 : word_bits - (excess + degree - 1) / degree);
        }
        return least;
    }

    /// The sign. Points: anything that coordinate_of takes, of float or double.
    template <class... Points>
    [[gnu::flatten]] constexpr sign_type operator()(const Points&... p) const {
        // Overflow is no constant expression.
        if (!std::is_constant_evaluated()) {
            const sign_type s = first_sign(p...);
            if (certain(s)) [[likely]]
                return s;
        }
        return later_stages<number_of<Points...>>(listed(p...), nullptr);
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
        return later_stages<number_of<Points...>>(listed(p...), &report);
    }
    /// What the first filter finds out, or the sign_type of an expression that branches. Stored:
    /// coordinates are read from memory, so that nothing can be fused with their differences.
    template <bool Stored = false, class... Points>
    static constexpr auto estimate(const Points&... p) {
        using T = number_of<Points...>;
        if constexpr (has_semi_static_filter) {
            T largest = 0;
            const auto x = detail::evaluate<Shape>(
                F(), detail::semi_static_scalars<T, Stored, Points...>{{p...}, &largest});
            return detail::sign_estimate<T>{x.value, x.bound(largest)};
        } else {
            const auto x = filtered<Stored>(p...);
            if constexpr (std::is_same_v<decltype(x), const sign_type>)
                return x;
            else
                return detail::sign_estimate<T>{x.value, x.bound()};
        }
    }
    /// What the static filter computes: a value, with its bound
    /// (errbound/filters/static_filter.hpp), or the sign_type of an expression that branches.
    template <bool Stored = false, class... Points>
    static constexpr auto filtered(const Points&... p) {
        using scalars = detail::filtered_scalars<number_of<Points...>, Stored, Points...>;
        return detail::evaluate<Shape>(F(), scalars{{p...}});
    }
    /// The expression's value over a number type of one's own, constructible from a coordinate.
    /// Boost.Multiprecision's types: without expression templates (et_off), which do not outlive
    /// the statements of an expression.
    template <class Number, class... Points>
    static constexpr auto value(const Points&... p) {
        const auto make = [](const auto& x) { return Number(x); };
        const auto list = listed(p...);
        return detail::evaluate<Shape>(
            F(), detail::listed_scalars<Shape, coordinate_list, decltype(make)>{list, make});
    }
    /// The sign that one stage alone finds.
    template <class... Points>
    constexpr sign_type by(predicate_stage stage, const Points&... p) const {
        using enum predicate_stage;
        if (stage == static_filter) return detail::conclude(filtered(p...));
        if (stage == semi_static_filter)
            return has_semi_static_filter ? first_sign(p...) : sign_type::uncertain;
        const coordinate_list list = listed(p...);
        const std::uint64_t largest = integers::largest_size(list);
        if (!integers::is_finite_size(largest)) return sign_type::uncertain;
        if (stage == tracked) return by_tracked<number_of<Points...>>(list);
        if (stage == exact_doubles) return by_doubles(list, largest);
        if (stage == two_word_integers) return by_two_words(list);
        if (stage == long_integers) return by_any(list);
        integers::word_coordinates<listed_size> words(list, largest);
        if (!words.fit) return sign_type::uncertain;
        if (stage == word_integers) return by_words(words);
        if constexpr (short_bits >= 1) return by_short(words);
        return sign_type::uncertain;
    }

  private:
    static constexpr bool mixed = !Options::homogeneous && (counts.mixed || !counts.complete);
    /// Where terms of different degree are added, 1 is one more coordinate.
    static constexpr std::size_t listed_size = Shape::size + mixed;
    using coordinate_list = std::array<double, listed_size>;

    template <class... Points, std::size_t... I>
    static constexpr bool has_dimensions(std::index_sequence<I...>) {
        return sizeof...(Points) != Shape::count ||
               ((known_dimension<Points>() == 0 ||
                 static_cast<int>(known_dimension<Points>()) >= Shape::dimensions[I]) &&
                ...);
    }
    template <class... Points>
    struct number {
        static_assert(sizeof...(Points) == Shape::count,
                      "errbound: as many points as the predicate's shape says");
        using type = std::common_type_t<decltype(coordinate_of(std::declval<Points>(), 0))...>;
        static_assert(has_dimensions<Points...>(std::index_sequence_for<Points...>()),
                      "errbound: a point has fewer coordinates than the predicate's shape says");
        static_assert((std::floating_point<decltype(coordinate_of(std::declval<Points>(), 0))> &&
                       ...) &&
                          sizeof(type) <= sizeof(double),
                      "errbound: coordinates must be float or double");
    };
    template <class... Points>
    using number_of = typename number<Points...>::type;

    template <class... Points>
    static constexpr sign_type first_sign(const Points&... p) {
        if constexpr (has_semi_static_filter)
            return detail::conclude(estimate(p...));
        else
            return detail::conclude(filtered(p...));
    }

    template <class... Points>
    static constexpr coordinate_list listed(const Points&... p) {
        coordinate_list list{};
        // A copy: device code does not see static members.
        constexpr auto dimensions = Shape::dimensions;
        std::size_t i = 0, argument = 0;
        const auto add = [&](const auto& point) {
            const int dimension = dimensions[argument++];
            for (int k = 0; k < (dimension == 0 ? 1 : dimension); ++k)
                list[i++] = coordinate_of(point, k);
        };
        (add(p), ...);
        if (mixed) list[i] = 1;
        return list;
    }

    template <class T>
    [[gnu::noinline]] static constexpr sign_type later_stages(const coordinate_list& list,
                                                              predicate_report* report) {
        using enum predicate_stage;
        const auto counted = [&](sign_type s, predicate_stage stage) {
            if (report != nullptr) report->count(stage);
            return s;
        };
        const std::uint64_t largest = integers::largest_size(list);
        if (!integers::is_finite_size(largest)) {
            if (report != nullptr) ++report->undecided;
            return sign_type::uncertain;
        }
        if constexpr (has_semi_static_filter) {
            // Products of smaller coordinates are all subnormal: slow, and nothing is decided.
            const int exponent = static_cast<int>(largest >> 52) - 1021;
            const bool in_range = exponent * counts.degree > std::numeric_limits<T>::min_exponent;
            if (!std::is_constant_evaluated() && in_range) {
                const sign_type s = by_filter<T>(list);
                if (certain(s)) return counted(s, static_filter);
            }
        }
        if constexpr (!std::is_void_v<typename Options::tracked_rule>) {
            if (!std::is_constant_evaluated()) {
                const sign_type s = by_tracked<T>(list);
                if (certain(s)) return counted(s, tracked);
            }
        }
        // Where two words hold all results of one-word coordinates, doubles would gain nothing.
        if constexpr (short_bits < word_bits) {
            const sign_type s = by_doubles(list, largest);
            if (certain(s)) return counted(s, exact_doubles);
        }
        integers::word_coordinates<listed_size> words(list, largest);
        if (words.fit) {
            if constexpr (short_bits >= 1) {
                if (words.least_bits() <= short_bits)
                    return counted(by_short(words), short_integers);
            }
            return counted(by_words(words), word_integers);
        }
        const sign_type s = by_two_words(list);
        if (certain(s)) return counted(s, two_word_integers);
        return counted(by_any(list), long_integers);
    }

    template <class T>
    [[gnu::noinline, gnu::flatten]] static constexpr sign_type by_filter(
        const coordinate_list& list) {
        return detail::sign_over<Shape>(
            F(), list, [](double x) { return filters::filtered_coordinate<T>{static_cast<T>(x)}; });
    }
    template <class T>
    [[gnu::noinline]] static constexpr sign_type by_tracked(const coordinate_list& list) {
        using rule = std::conditional_t<std::is_void_v<typename Options::tracked_rule>, tight,
                                        typename Options::tracked_rule>;
        return detail::sign_over<Shape>(
            F(), list, [](double x) { return errbound::tracked<T, rule>(static_cast<T>(x)); });
    }

    static constexpr sign_type by_doubles(const coordinate_list& list, std::uint64_t largest) {
        constexpr int bits = coordinate_bits(53);
        if constexpr (bits < 1) {
            return sign_type::uncertain;
        } else {
            const integers::short_coordinates<listed_size, bits> c(list, largest);
            return c.fit ? by_short_doubles<bits>(c) : sign_type::uncertain;
        }
    }
    template <int Bits>
    [[gnu::noinline]] static constexpr sign_type by_short_doubles(
        const integers::short_coordinates<listed_size, Bits>& c) {
        using scalar = integers::sized_integer<
            integers::integer_level<integers::integer_kind::floating, Bits, mixed>, Bits, 1>;
        return detail::sign_over<Shape>(F(), c.value, [&](double v) { return scalar{v, c.unit}; });
    }

    /// Words that are short when brought to the largest common unit.
    static constexpr sign_type by_short(const integers::word_coordinates<listed_size>& words) {
        if (words.least_bits() > short_bits) return sign_type::uncertain;
        if constexpr (short_bits == word_bits) return by_words(words);
        return by_values<short_bits>(words, word_bits - words.least_bits());
    }
    static constexpr sign_type by_words(const integers::word_coordinates<listed_size>& words) {
        return by_values<word_bits>(words, 0);
    }
    /// Inlined: passing the values on would cost as much as a small expression.
    template <int Bits>
    [[gnu::always_inline]] static constexpr sign_type by_values(
        const integers::word_coordinates<listed_size>& words, int shift) {
        using scalar = integers::sized_integer<
            integers::integer_level<integers::integer_kind::words, Bits, mixed>, Bits, 1>;
        return detail::sign_over<Shape>(F(), words.value, [&](std::int64_t v) {
            return scalar{v >> shift, words.unit + shift};
        });
    }

    static constexpr int short_bits = coordinate_bits(127);
    /// Coordinates of two words: their differences' products end before a word's end.
    static constexpr int two_word_bits = 124;
    [[gnu::noinline]] static constexpr sign_type by_two_words(const coordinate_list& list) {
        const integers::common_unit unit(list);
        if (unit.bits > two_word_bits) return sign_type::uncertain;
        return detail::sign_over<Shape>(F(), list, [&](double x) {
            return unit.template converted<
                integers::integer_level<integers::integer_kind::words, two_word_bits, mixed>>(x);
        });
    }

    [[gnu::noinline]] static constexpr sign_type by_any(const coordinate_list& list) {
        if constexpr (std::is_void_v<typename Options::exact_type>) {
            // Long ones are made once.
            using level = integers::integer_level<integers::integer_kind::any_length,
                                                  integers::full_range_bits, mixed>;
            using scalar = integers::sized_integer<level, integers::full_range_bits, 1>;
            const integers::common_unit unit(list);
            const auto longs = [&]<std::size_t... I>(std::index_sequence<I...>) {
                return std::array{unit.template converted<level>(list[I])...};
            }
            (std::make_index_sequence<listed_size>());
            return detail::sign_over<Shape>(F(), longs,
                                            [](const scalar& x) -> const scalar& { return x; });
        } else {
            return detail::sign_over<Shape>(
                F(), list, [](double x) { return typename Options::exact_type(x); });
        }
    }
};

/// The predicate of an expression: see the head of this file.
template <class Shape, class Options = predicate_options, class F>
constexpr predicate_type<Shape, F, Options> predicate(F) {
    return {};
}

}  // namespace errbound
