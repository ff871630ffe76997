// Rules and functions in every case of tiny formats, compared with the proofs' table: tie.hpp.
#include <gtest/gtest.h>

#include <errbound/validation/tiny_float.hpp>

#include "tests/errbound/validation/tie_functions.hpp"

namespace {

using errbound::validation::tiny_float;

template <class Tiny>
void expect_the_proofs_results_of_tiny() {
    const errbound::validation::tiny_rounding<Tiny> nearest(MPFR_RNDN);
    tie::expect_the_proofs_results<Tiny>();
}

TEST(Tie, EveryCaseOfSixBits) {
    expect_the_proofs_results_of_tiny<tiny_float<3, 3>>();
}
TEST(Tie, FiveBitsOfPrecision) {
    expect_the_proofs_results_of_tiny<tiny_float<5, 3>>();
}
TEST(Tie, FourBitsOfPrecisionAndFourOfExponent) {
    expect_the_proofs_results_of_tiny<tiny_float<4, 4>>();
}

}  // namespace
