// Root counts against FLINT's, whole line and positive half; signs at the roots against Tarski's
// query and FLINT's count of common roots.
#include <flint/fmpz_poly.h>
#include <gtest/gtest.h>

#include <errbound/polynomial.hpp>
#include <limits>

#include "tests/errbound/roots/flint_polynomial.hpp"
#include "tests/errbound/roots/polynomial_families.hpp"
#include "tests/errbound/roots/tarski.hpp"
#include "tests/support/scaled.hpp"

namespace {

using namespace errbound;
using namespace errbound::roots;
using polynomial_families::degree_of_sample;
using polynomial_families::family;
using polynomial_families::generator;
using polynomial_families::sample;

constexpr double infinity = std::numeric_limits<double>::infinity();

class Flint : public testing::TestWithParam<family> {};

/// Decided in the library's own integers.
auto isolated(const sample& s) {
    return s.doubles.empty() ? isolate_roots(polynomial(polynomial_families::in<integer>(s.whole)),
                                             -infinity, infinity)
                             : isolate_roots(polynomial(s.doubles), -infinity, infinity);
}

int polynomials() {
    return support::scaled(300);
}

TEST_P(Flint, CountsAgree) {
    generator make(500 + static_cast<unsigned>(GetParam()));
    int decided = 0;
    for (int k = 0; k < polynomials(); ++k) {
        const auto s = make.make(GetParam(), degree_of_sample(GetParam(), k, 30));
        const flint_polynomial truth(s.whole);
        const auto roots = isolated(s);
        ASSERT_EQ(roots.size(), truth.distinct_real_roots()) << "polynomial " << k;
        const std::size_t positive =
            s.doubles.empty()
                ? count_roots(polynomial(polynomial_families::in<integer>(s.whole)), 0, infinity)
                : count_roots(polynomial(s.doubles), 0, infinity);
        ASSERT_EQ(positive, truth.distinct_nonnegative_roots()) << "polynomial " << k;
        decided += roots.decided_by_filter();
    }
    RecordProperty("decided_by_filter", decided);
}

TEST_P(Flint, SignsAtRootsAgree) {
    generator make(600 + static_cast<unsigned>(GetParam()));
    std::size_t negative = 0, zero = 0, positive = 0;
    for (int k = 0; k < polynomials(); ++k) {
        const auto s = make.make(GetParam(), degree_of_sample(GetParam(), k, 30));
        auto g = make.make(polynomial_families::all[static_cast<std::size_t>(k) % 9], 1 + k % 4);
        // Roots in common now and then, and values near 0 at others.
        if (k % 4 == 0) g.whole = generator::product(g.whole, errbound::roots::derivative(s.whole));
        if (k % 8 == 1) g.whole = generator::product(g.whole, s.whole);
        errbound::roots::trim(g.whole);
        auto roots = isolated(s);
        auto staged_g = staged<integer>(polynomial(polynomial_families::in<integer>(g.whole)));
        int sum = 0;
        std::size_t zeros = 0;
        for (std::size_t i = 0; i < roots.size(); ++i) {
            const sign_type sign = roots.sign_at(staged_g, i);
            ASSERT_TRUE(certain(sign));
            if (sign == sign_type::zero) ++zeros;
            if (sign == sign_type::positive) ++sum, ++positive;
            if (sign == sign_type::negative) --sum, ++negative;
        }
        zero += zeros;
        ASSERT_EQ(sum, tarski(s.whole, g.whole).everywhere()) << "polynomial " << k;
        ASSERT_EQ(zeros, flint_polynomial(s.whole).distinct_roots_in_common(g.whole))
            << "polynomial " << k;
    }
    RecordProperty("negative", static_cast<int>(negative));
    RecordProperty("zero", static_cast<int>(zero));
    RecordProperty("positive", static_cast<int>(positive));
}

INSTANTIATE_TEST_SUITE_P(Roots, Flint, testing::ValuesIn(polynomial_families::all),
                         [](const auto& info) {
                             return polynomial_families::names[static_cast<int>(info.param)];
                         });

}  // namespace
