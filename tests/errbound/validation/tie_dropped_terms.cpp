// Rules with a term dropped give other results than the proofs' table: tie.hpp.
#include <gtest/gtest.h>

#include <errbound/validation/tiny_float.hpp>
#include <type_traits>
#include <utility>

#include "tests/errbound/validation/tie.hpp"
#include "tests/errbound/validation/tie_mutants.hpp"

namespace {

template <template <int> class Rule, int... Mutants>
void expect_found(std::integer_sequence<int, Mutants...>) {
    using tiny = errbound::validation::tiny_float<4, 4>;
    const errbound::validation::tiny_rounding<tiny> nearest(MPFR_RNDN);
    const tie::table expected = tie::read_table();
    const auto found = [&]<int M>(std::integral_constant<int, M>) {
        return !tie::differences<tiny, Rule<M>>(expected).empty() ||
               !tie::differences<double, Rule<M>>(expected).empty();
    };
    EXPECT_FALSE(found(std::integral_constant<int, 0>())) << Rule<0>::name;
    const auto is_found = [&]<int M>(std::integral_constant<int, M> mutant) {
        EXPECT_TRUE(found(mutant)) << Rule<M>::name << ", mutant " << M;
    };
    (is_found(std::integral_constant<int, Mutants + 1>()), ...);
}

TEST(Tie, RulesWithATermDroppedAreFound) {
    using namespace tie_mutants;
    expect_found<tight>(std::make_integer_sequence<int, tight<0>::mutants>());
    expect_found<sharp>(std::make_integer_sequence<int, sharp<0>::mutants>());
    expect_found<safe>(std::make_integer_sequence<int, safe<0>::mutants>());
    expect_found<interval>(std::make_integer_sequence<int, interval<0>::mutants>());
    expect_found<residual>(std::make_integer_sequence<int, residual<0>::mutants>());
}

}  // namespace
