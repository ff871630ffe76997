// The stages of a predicate after its first filter. They are a class of their own, so that unused
// predicates cost nothing: the expression is analysed only when this class is first used.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <errbound/filters/predicate_report.hpp>
#include <errbound/filters/predicate_scalars.hpp>
#include <errbound/integers/common_exponent.hpp>
#include <errbound/integers/sized_integer.hpp>
#include <errbound/tracked.hpp>
#include <limits>
#include <type_traits>
#include <utility>

namespace errbound::filters {

template <class Shape, class F, class Options>
class predicate_stages {
    static_assert(takes_points<Shape, F>,
                  "errbound: a predicate's expression takes one argument for each point of the "
                  "shape, of any type: [](const auto& a, const auto& b) for points<2, 2>; if it "
                  "does, it uses an operation that points and coordinates lack (see other "
                  "errors): they have a[0], +, -, *, sign_of and the like, but no a.dot(b), no "
                  "std::abs(x)");
    using result = result_over<Shape, F, counted_scalars<Shape>>;
    static_assert(std::is_same_v<result, expression_count> || std::is_same_v<result, sign_type>,
                  "errbound: a predicate's expression returns a number made of coordinates, whose "
                  "sign is the answer, or a sign_type; instead of bool, int or void return "
                  "sign_of(x), which can be uncertain");

  public:
    static constexpr int word_bits = integers::word_coordinates<1>::max_bits;

  private:
    static constexpr int max_runs = Options::homogeneous ? few_counting_runs : most_counting_runs;
    static constexpr expression_findings findings = findings_of<Shape, F>(word_bits, max_runs);
    static_assert(!findings.lacks_coordinates,
                  "errbound: the expression uses a coordinate that the predicate's shape does "
                  "not have: points<2, 2> have a[0] and a[1]");
    static_assert(!findings.number_after_signs,
                  "errbound: an expression that evaluates signs must return one, so that it can "
                  "return `uncertain`: write return sign_of(x)");
    static_assert(findings.counts.degree <= expression_counts::max_degree,
                  "errbound: the expression is of a higher degree than 63");
    static_assert(!has_fault<Shape, F>(expression_fault::acts_on_uncertain),
                  "errbound: the expression acts on a sign that is uncertain as if it were known: "
                  "after const sign_type s = sign_of(x) write if (!certain(s)) return s");
    static_assert(!has_fault<Shape, F>(expression_fault::asks_nothing),
                  "errbound: the expression's answer is the same for all points: it evaluates "
                  "no sign, or all its terms cancel");
    static_assert(!has_fault<Shape, F>(expression_fault::gives_up),
                  "errbound: the expression returns `uncertain` although all signs that it "
                  "evaluated are certain: return a sign there, such as `zero`, even if that "
                  "branch is unreachable");
    static_assert(!findings.has_one_answer || !findings.counts.complete,
                  "errbound: the expression's answer is the same for all signs that it "
                  "evaluates");

  public:
    static constexpr expression_counts counts = findings.counts;
    static constexpr bool has_semi_static_filter =
        !counts.mixed && counts.degree >= 5 && !branches<Shape, F>;
    /// The semi-static filter's value and mass at zeros, which determine its bound.
    template <class T>
    static constexpr auto semi_static_count = [] {
        T largest = 0;
        const auto make = [&](T x) { return semi_static_coordinate<T>{x, &largest}; };
        const std::array<T, Shape::size> zeros{};
        return as_semi_static(evaluate<Shape>(
            F(), listed_scalars<Shape, std::array<T, Shape::size>, decltype(make)>{zeros, make}));
    }();
    /// 0 if results may be missing. Proof: proofs/integers/Widths.v, coordinate_bits_enough.
    static constexpr int coordinate_bits(int bits) {
        if (!counts.complete) return 0;
        int least = word_bits;
        for (int degree = 0; degree <= expression_counts::max_degree; ++degree) {
            const int excess = counts.bits[static_cast<std::size_t>(degree)] - bits;
            if (excess <= 0) continue;
            least = (std::min)(least, degree == 0 ? 0 : word_bits - (excess + degree - 1) / degree);
        }
        return least;
    }

    static constexpr bool has_degrees = !Options::degrees.empty();
    static_assert(
        !has_degrees || Options::degrees.size() == Shape::size,
        "errbound: a predicate's options must have one degree for each coordinate of its shape");
    static constexpr bool is_of_one_degree = [] {
        if (!has_degrees || Options::degrees.size() != Shape::size) return true;
        for (const int degree : Options::degrees)
            if (degree < 1) return false;
        const expression_counts by_degrees =
            findings_of<Shape, F>(word_bits, max_runs, Options::degrees.data()).counts;
        return by_degrees.complete && !by_degrees.mixed;
    }();
    static_assert(is_of_one_degree,
                  "errbound: with the degrees of the predicate's options, each at least 1, "
                  "terms of different degree are added, or there are too many branches to "
                  "analyse");

    static constexpr bool mixed = !Options::homogeneous && (counts.mixed || !counts.complete);
    static constexpr std::size_t listed_size = Shape::size + mixed;  ///< mixed: the last is 1
    using coordinate_list = std::array<double, listed_size>;

    template <class... Points>
    static constexpr coordinate_list listed(const Points&... p) {
        coordinate_list list{};
        // A copy: device code cannot access static members.
        constexpr auto dimensions = Shape::dimensions;
        std::size_t i = 0, argument = 0;
        const auto add = [&](const auto& given) {
            const int dimension = dimensions[argument++];
            for (int k = 0; k < (dimension == 0 ? 1 : dimension); ++k)
                list[i++] = coordinate_of(given, k);
        };
        (add(p), ...);
        if (mixed) list[i] = 1;
        return list;
    }

    /// The sign by the first certain stage; counts it in the report, if any.
    template <class T>
    [[gnu::noinline]] static constexpr sign_type decide(const coordinate_list& list,
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
            // Products of smaller coordinates are all subnormal: slow, and never certain.
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
        if constexpr (has_degrees && mixed) {
            const coordinate_list scaled = near_one(list);
            if (scaled != list) {
                const sign_type s = by_filter<double>(scaled);
                if (certain(s)) return counted(s, static_filter);
                return decide_with_integers(scaled, integers::largest_size(scaled), counted);
            }
        }
        return decide_with_integers(list, largest, counted);
    }

    template <class T>
    static constexpr sign_type by(predicate_stage stage, const coordinate_list& list) {
        using enum predicate_stage;
        const std::uint64_t largest = integers::largest_size(list);
        if (!integers::is_finite_size(largest)) return sign_type::uncertain;
        if (stage == tracked) return by_tracked<T>(list);
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
    template <class Counted>
    static constexpr sign_type decide_with_integers(const coordinate_list& list,
                                                    std::uint64_t largest, const Counted& counted) {
        using enum predicate_stage;
        // If two words hold all results of one-word coordinates, doubles gain nothing.
        if constexpr (short_bits < word_bits && coordinate_bits(53) >= least_double_bits) {
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
        // From degree 7 on, this stage would take most of the time to compile.
        if constexpr (!branches<Shape, F> && counts.degree < 7) {
            const sign_type s = by_two_words(list);
            if (certain(s)) return counted(s, two_word_integers);
        }
        return counted(by_any(list), long_integers);
    }
    /// The coordinates times 2^(−s·degree), the largest near 1. A number of degree d scales by
    /// 2^(−s·d), so signs stay. Unchanged if near 1 already, or if scaling is inexact.
    static constexpr coordinate_list near_one(const coordinate_list& list) {
        using traits = number_traits<double>;
        constexpr int moderate = 16;
        if (std::is_constant_evaluated()) return list;
        constexpr auto degrees = Options::degrees;
        int s = (std::numeric_limits<int>::min)();
        for (std::size_t i = 0; i < Shape::size; ++i)
            if (list[i] != 0) s = (std::max)(s, traits::exponent(list[i]) / degrees[i]);
        if (s > -moderate && s < moderate) return list;
        if (s == (std::numeric_limits<int>::min)()) return list;  // all are 0
        coordinate_list scaled = list;
        for (std::size_t i = 0; i < Shape::size; ++i) {
            scaled[i] = traits::scale(list[i], -s * degrees[i]);
            if (traits::scale(scaled[i], s * degrees[i]) != list[i]) return list;
        }
        return scaled;
    }

    template <class T>
    [[gnu::noinline, gnu::flatten]] static constexpr sign_type by_filter(
        const coordinate_list& list) {
        return sign_over<Shape>(F(), list,
                                [](double x) { return filtered_coordinate<T>{static_cast<T>(x)}; });
    }
    template <class T>
    [[gnu::noinline]] static constexpr sign_type by_tracked(const coordinate_list& list) {
        using rule = std::conditional_t<std::is_void_v<typename Options::tracked_rule>, tight,
                                        typename Options::tracked_rule>;
        return sign_over<Shape>(
            F(), list, [](double x) { return errbound::tracked<T, rule>(static_cast<T>(x)); });
    }

    /// With fewer bits than this, doubles hold hardly any inputs: short integers are fast enough.
    static constexpr int least_double_bits = 8;
    static constexpr sign_type by_doubles(const coordinate_list& list, std::uint64_t largest) {
        constexpr int bits = coordinate_bits(53);
        if constexpr (bits < least_double_bits) {
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
        return sign_over<Shape>(F(), c.value, [&](double v) { return scalar{v, c.unit}; });
    }

    static constexpr sign_type by_short(const integers::word_coordinates<listed_size>& words) {
        if (words.least_bits() > short_bits) return sign_type::uncertain;
        if constexpr (short_bits == word_bits) return by_words(words);
        return by_values<short_bits>(words, word_bits - words.least_bits());
    }
    static constexpr sign_type by_words(const integers::word_coordinates<listed_size>& words) {
        return by_values<word_bits>(words, 0);
    }
    /// Inlined: passing the values would cost as much as a small expression.
    template <int Bits>
    [[gnu::always_inline]] static constexpr sign_type by_values(
        const integers::word_coordinates<listed_size>& words, int shift) {
        using scalar =
            integers::sized_integer<integers::integer_level<integers::integer_kind::words, Bits,
                                                            mixed, (counts.degree > 4)>,
                                    Bits, 1>;
        return sign_over<Shape>(F(), words.value, [&](std::int64_t v) {
            return scalar{v >> shift, words.unit + shift};
        });
    }

    static constexpr int short_bits = coordinate_bits(127);
    /// Differences of such coordinates have 125 bits. A product of n of them fits in 2n words of 64
    /// bits, with 3n bits left for the sign and for sums.
    static constexpr int two_word_bits = 124;
    /// Above degree 3 (with one-word coordinates, 4), operations on two or more words are calls:
    /// inlined they take longer to compile and to run. Expressions that branch skip this stage.
    using two_word_level = integers::integer_level<integers::integer_kind::words, two_word_bits,
                                                   mixed, (counts.degree > 3)>;
    [[gnu::noinline]] static constexpr sign_type by_two_words(const coordinate_list& list) {
        const integers::common_unit unit(list);
        if (unit.bits > two_word_bits) return sign_type::uncertain;
        return sign_over<Shape>(
            F(), list, [&](double x) { return unit.template converted<two_word_level>(x); });
    }

    [[gnu::noinline]] static constexpr sign_type by_any(const coordinate_list& list) {
        if constexpr (std::is_void_v<typename Options::exact_type>) {
            using level = integers::integer_level<integers::integer_kind::any_length,
                                                  integers::full_range_bits, mixed>;
            using scalar = integers::sized_integer<level, integers::full_range_bits, 1>;
            const integers::common_unit unit(list);
            const auto longs = [&]<std::size_t... I>(std::index_sequence<I...>) {
                return std::array{unit.template converted<level>(list[I])...};
            }
            (std::make_index_sequence<listed_size>());
            return sign_over<Shape>(F(), longs, [](const scalar& x) -> const scalar& { return x; });
        } else {
            return sign_over<Shape>(F(), list,
                                    [](double x) { return typename Options::exact_type(x); });
        }
    }
};

}  // namespace errbound::filters
