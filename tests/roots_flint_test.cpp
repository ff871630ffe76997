// Root counts against FLINT's, whole line and positive half.
//
// ERRBOUND_ROOTS_POLYNOMIALS: how many polynomials per family.
#include <flint/fmpz_poly.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <errbound/polynomial.hpp>
#include <limits>

#include "tests/flint_polynomial.hpp"
#include "tests/polynomial_families.hpp"

namespace {

using namespace errbound;
using polynomial_families::degree_of_sample;
using polynomial_families::family;
using polynomial_families::generator;
using polynomial_families::integer;

constexpr double infinity = std::numeric_limits<double>::infinity();

class Flint : public testing::TestWithParam<family> {};

TEST_P(Flint, CountsAgree) {
    const char* const asked = std::getenv("ERRBOUND_ROOTS_POLYNOMIALS");
    const int polynomials = asked != nullptr ? std::atoi(asked) : 600;
    generator make(500 + static_cast<unsigned>(GetParam()));
    int decided = 0;
    for (int k = 0; k < polynomials; ++k) {
        const auto s = make.make(GetParam(), degree_of_sample(GetParam(), k, 30));
        const flint_polynomial truth(s.whole);
        const auto roots =
            s.doubles.empty()
                ? isolate_roots(polynomial<integer>(s.whole), -infinity, infinity)
                : isolate_roots<integer>(polynomial<double>(s.doubles), -infinity, infinity);
        ASSERT_EQ(roots.size(), truth.distinct_real_roots()) << "polynomial " << k;
        const std::size_t positive =
            s.doubles.empty() ? count_roots(polynomial<integer>(s.whole), 0, infinity)
                              : count_roots<integer>(polynomial<double>(s.doubles), 0, infinity);
        ASSERT_EQ(positive, truth.distinct_nonnegative_roots()) << "polynomial " << k;
        decided += roots.decided_by_filter();
    }
    RecordProperty("decided_by_filter", decided);
}

INSTANTIATE_TEST_SUITE_P(Roots, Flint, testing::ValuesIn(polynomial_families::all),
                         [](const auto& info) {
                             return polynomial_families::names[static_cast<int>(info.param)];
                         });

}  // namespace
