// Compares predicates with oracles, each stage alone and all together.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <errbound/multiprecision.hpp>
#include <errbound/predicate.hpp>
#include <tuple>

#include "tests/errbound/predicates/predicate_list.hpp"
#include "tests/support/scaled.hpp"
#include "tests/support/special_values.hpp"

namespace predicate_check {

using errbound::predicate_stage;
using errbound::sign_type;
using predicate_inputs::surface;

using point2 = std::array<double, 2>;
using point3 = std::array<double, 3>;

/// With fewer inputs, some stages decide none.
inline int inputs_per_family() {
    return std::max(support::scaled(4000), 400);
}

/// Evaluates the same expression over rationals, without filters.
struct rational_options : errbound::predicate_options {
    using exact_type = rational;
};
template <class Shape, class F, class Options>
auto over_rationals(const errbound::predicate_type<Shape, F, Options>&) {
    return [](const auto& points) {
        return std::apply(
            [](const auto&... p) {
                return errbound::predicate_type<Shape, F, rational_options>().by(
                    predicate_stage::long_integers, p...);
            },
            points);
    };
}

template <class T, std::size_t D, std::size_t N, class Predicate, class Exact>
errbound::predicate_report compare(const Predicate& predicate, const Exact& exact, surface s) {
    predicate_inputs::generator random(7);
    errbound::predicate_report report;
    std::uint64_t all = 0;
    for (const auto& family : predicate_inputs::families<T, D, N>)
        for (int i = 0; i < inputs_per_family(); ++i, ++all) {
            const auto p = family.make(random, s);
            const sign_type right = exact(p);
            std::apply(
                [&](const auto&... q) {
                    ASSERT_EQ(predicate(report, q...), right)
                        << family.name << predicate_inputs::text_of(p);
                    for (std::size_t k = 0; k < errbound::predicate_stage_count; ++k) {
                        const sign_type found = predicate.by(static_cast<predicate_stage>(k), q...);
                        ASSERT_TRUE(found == right || found == sign_type::uncertain)
                            << family.name << ", stage " << k << predicate_inputs::text_of(p);
                    }
                },
                p);
            if (testing::Test::HasFatalFailure()) return report;
        }
    std::uint64_t decided = 0;
    for (const std::uint64_t n : report.decided) decided += n;
    EXPECT_EQ(decided, all);
    return report;
}
/// A listed predicate against its oracle.
template <class T, class Entry>
errbound::predicate_report compare_entry(const Entry& entry, surface s) {
    return compare<T, Entry::dimension, Entry::count>(
        entry.predicate, [&](const auto& p) { return predicate_list::right_sign(entry, p); }, s);
}

}  // namespace predicate_check
