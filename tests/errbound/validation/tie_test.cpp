// Rules and functions in float and double, and integers of words, compared with the proofs' table:
// tie.hpp.
#include <gtest/gtest.h>

#include "tests/errbound/validation/tie_functions.hpp"
#include "tests/errbound/validation/tie_words.hpp"

namespace {

TEST(Tie, Float) {
    tie::expect_the_proofs_results<float>();
}
TEST(Tie, Double) {
    tie::expect_the_proofs_results<double>();
}

TEST(Tie, IntegersOfWords) {
    EXPECT_EQ(tie::count_differences(tie::lines_of_words(), false), 0);
}

}  // namespace
