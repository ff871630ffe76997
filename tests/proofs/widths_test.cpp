// Runs decisions in integers of fixed width over integers that count bits (tests/proofs/counted).
// At the largest extents of a width, no number may exceed its words, by the bounds of its
// computation. FixedWidths.v of the proofs proves this for expressions read off the code. This test
// runs the code on the queries and forms of the ties, which reach all its branches.
#include <gtest/gtest.h>

#include <algorithm>
#include <ccd/methods/forms.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/query.hpp>
#include <cstddef>
#include <cstdint>
#include <errbound/integers/fixed_integer.hpp>
#include <iostream>
#include <optional>
#include <type_traits>
#include <utility>

#include "ccd/exact/axis_units.hpp"
#include "ccd/exact/integer_decision.hpp"
#include "ccd/exact/interior_contact.hpp"
#include "tests/proofs/table.hpp"
#include "tests/proofs/whole_forms.hpp"
#include "tests/proofs/whole_query.hpp"
#include "tests/support/scaled.hpp"

namespace {

using ccd::detail::extent_limit;
using ccd::detail::integer_units;
using errbound::integers::counted;
using errbound::integers::fixed_integer;

/// Counts during its lifetime.
struct counting {
    counting() { counted.on = true; }
    ~counting() { counted.on = false; }
    counting(const counting&) = delete;
    counting& operator=(const counting&) = delete;
};

/// If the query fits: its differences are assumed to reach 2^bits along every axis.
template <int Words, class Query>
void decide(const Query& query, int bits) {
    integer_units units(query);
    if (!units.finite() || units.bits() > bits) return;
    units.x.bits = units.y.bits = units.z.bits = bits;
    const auto coordinate = [bits](const auto& x, int axis_and_end) {
        return fixed_integer<Words>::coordinate(x.plain(), axis_and_end, bits);
    };
    const auto in_words =
        ccd::transformed_motions(units.converted<Words>(query), [&](const auto& p) {
            using point = ccd::point<fixed_integer<Words>>;
            return ccd::moving_point<fixed_integer<Words>>{
                point{coordinate(p.t0.x, 0), coordinate(p.t0.y, 1), coordinate(p.t0.z, 2)},
                point{coordinate(p.t1.x, 3), coordinate(p.t1.y, 4), coordinate(p.t1.z, 5)}};
        });
    const counting now;
    (void)ccd::detail::decide_converted<Words>(in_words, query, units);
}
template <int Words>
void decide(const tie::drawn_query& q, int bits) {
    const auto decide_one = [bits](const auto& query) { decide<Words>(query, bits); };
    tie::with_query(q, decide_one);
    tie::with_smaller_queries(q, decide_one);
}

template <int Words, template <class, int> class Forms>
struct opened_contact : ccd::detail::interior_contact<Words, Forms> {
    using base = ccd::detail::interior_contact<Words, Forms>;
    using base::base, base::throughout, base::without_halving, base::three_real_roots_;
    using typename base::part;
};

/// Around the root of all forms, in T words and with brackets of any width.
template <int T, class Contact>
void run_throughout(const Contact& contact, const tie::drawn_forms& f) {
    const int bits = std::clamp(64 * T - 4 - f.bits(0) + f.cut, 1, 64 * T - 2);
    const auto place = f.place(bits).from_bit<T>(0).plain();
    const counting now;
    const auto low = fixed_integer<T>::given(place, bits);
    for (const int width_bits : {0, 5, 15, 27})
        (void)contact.template throughout<T>(low, bits, width_bits);
}

/// Forms with contact or almost, whose decision reaches later brackets and halves.
template <int Words, template <class, int> class Forms>
void decide_forms(const tie::drawn_forms& f, int bits) {
    if (f.bits() > bits) return;
    integer_units units(ccd::vertex_vertex<double>{});
    units.x.bits = units.y.bits = units.z.bits = bits;
    const auto given = [bits](const auto& x) {
        return fixed_integer<Words>::given(x.plain().template from_bit<Words>(0), bits);
    };
    std::optional<counting> now(std::in_place);
    const auto forms = f.as<Forms>(given);
    const auto y = forms.y();
    opened_contact<Words, Forms> contact(forms, y, units);
    (void)contact.decide();
    // A subinterval after the most halvings: its bounds hold for any other.
    typename opened_contact<Words, Forms>::part some{{}, ccd::detail::inner_sign_changes(y), 0, 0};
    for (int i = 0; i <= 3; ++i) some.y[i] = y[i];
    for (; some.level < some.max_halvings; ++some.level) {
        const bool right = some.level % 2 != 0;
        some.y = right ? reversed(left_half(reversed(some.y))) : left_half(some.y);
        some.index = 2 * some.index + right;
    }
    contact.three_real_roots_ = true;
    (void)contact.without_halving(some);
    now.reset();
    run_throughout<1>(contact, f);
    run_throughout<2>(contact, f);
    run_throughout<3>(contact, f);
    run_throughout<4>(contact, f);
}

template <int Words>
void decide_all(int bits) {
    tie::sequence numbers;
    counted = {};
    for (int k = 0; k < support::scaled(4000); ++k)
        decide<Words>(tie::whole_query_maker(numbers).wide_query(), bits);
    for (int k = 0; k < support::scaled(12000); ++k)
        decide<Words>(tie::whole_query_maker(numbers).query(), bits);
    for (int k = 0; k < support::scaled(1000); ++k) {
        const auto f = tie::whole_forms_maker(numbers).forms();
        f.with_kind(
            [&]<template <class, int> class Forms>() { decide_forms<Words, Forms>(f, bits); });
    }
}

template <class Words>
class Widths : public testing::Test {};
using all_words = testing::Types<std::integral_constant<int, 1>, std::integral_constant<int, 2>,
                                 std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(Widths, all_words);

TYPED_TEST(Widths, HoldAllNumbersAtTheLargestExtents) {
    constexpr int words = TypeParam::value;
    decide_all<words>(extent_limit(words));
    EXPECT_EQ(counted.beyond, 0U) << counted.first;
    // The longest numbers were reached, with forms at roots of Y whose positions have `place`
    // words, and at multiple roots.
    for (int place = 1; place <= (words == 1 ? 3 : 4); ++place)
        EXPECT_TRUE(counted.fullest.contains(4 * (words + place))) << place;
    EXPECT_TRUE(counted.fullest.contains(28 * words));
    std::cout << counted.numbers << " numbers; the most bits by words:";
    for (const auto& [of, bits] : counted.fullest)
        std::cout << ' ' << of << ": " << bits << '/' << 64 * of - 1;
    std::cout << '\n';
}
TYPED_TEST(Widths, AreTooFewBeyond) {
    constexpr int words = TypeParam::value;
    decide_all<words>(extent_limit(words) + 1);
    EXPECT_GT(counted.beyond, 0U);
}

}  // namespace
