// Rules and functions with a term dropped give other results than the proofs' table: tie.hpp.
#include <gtest/gtest.h>

#include <errbound/validation/tiny_float.hpp>
#include <string>
#include <type_traits>
#include <utility>

#include "tests/errbound/validation/tie.hpp"
#include "tests/errbound/validation/tie_function_mutants.hpp"
#include "tests/errbound/validation/tie_mutants.hpp"

namespace {

using tiny = errbound::validation::tiny_float<4, 4>;

/// found(number) says whether the mutant differs; mutant 0 must not.
template <class Found, int... Mutants>
void expect_found(const std::string& what, Found found, std::integer_sequence<int, Mutants...>) {
    const errbound::validation::tiny_rounding<tiny> nearest(MPFR_RNDN);
    EXPECT_FALSE(found(std::integral_constant<int, 0>())) << what;
    const auto is_found = [&]<int M>(std::integral_constant<int, M> mutant) {
        EXPECT_TRUE(found(mutant)) << what << ", mutant " << M;
    };
    (is_found(std::integral_constant<int, Mutants + 1>()), ...);
}

template <template <int> class Rule>
void expect_rules_found() {
    const tie::table expected = tie::read_table();
    const auto found = [&]<int M>(std::integral_constant<int, M>) {
        return !tie::differences<tiny, Rule<M>>(expected).empty() ||
               !tie::differences<double, Rule<M>>(expected).empty();
    };
    expect_found(Rule<0>::name, found, std::make_integer_sequence<int, Rule<0>::mutants>());
}

TEST(Tie, RulesWithATermDroppedAreFound) {
    using namespace tie_mutants;
    expect_rules_found<tight>();
    expect_rules_found<sharp>();
    expect_rules_found<safe>();
    expect_rules_found<interval>();
    expect_rules_found<residual>();
}

TEST(Tie, FunctionsWithATermDroppedAreFound) {
    using tie_mutants::functions;
    const tie::table expected = tie::read_table();
    const auto found = [&]<int M>(std::integral_constant<int, M>) {
        using tie::differences_of_functions;
        using errbound::interval;
        using errbound::tight;  // its sqrt and fma are of no rule
        return !differences_of_functions<double, interval, functions<M>>(expected).empty() ||
               !differences_of_functions<tiny, interval, functions<M>>(expected).empty() ||
               !differences_of_functions<double, tight, functions<M>>(expected).empty() ||
               !differences_of_functions<tiny, tight, functions<M>>(expected).empty();
    };
    expect_found("function", found, std::make_integer_sequence<int, functions<0>::mutants>());
}

}  // namespace
