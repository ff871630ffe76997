// Compares the rules, their functions and integers of words with the proofs' definitions
// (proofs/tie/tie.ml): in every case of tiny formats, in float and in double. With fused
// multiply-add, it skips the tiny formats.
//
//   tie_test               prints all groups of operations that differ
//   tie_test first HEADER  for mutants.py: only the first, of the rule whose header has that name,
//   or
//                          of all rules for other headers; without the slowest format
#include <algorithm>
#include <array>
#include <errbound/error_free.hpp>
#include <errbound/validation/tiny_float.hpp>
#include <string>
#include <type_traits>
#include <vector>

#include "tests/errbound/validation/tie_functions.hpp"
#include "tests/errbound/validation/tie_words.hpp"
#include "tests/proofs/table.hpp"

namespace {

using errbound::validation::tiny_float;

bool first_alone = false;
std::string changed_header;
int found = 0;

bool is_done() {
    return first_alone && found > 0;
}
/// True if a header of this name can affect the results: the rule's header, or one of no rule.
bool is_due(const std::string& name) {
    const std::array<std::string, 8> others{"tight",    "sharp",    "safe",   "interval",
                                            "residual", "relative", "affine", "fixed_integer"};
    return changed_header == name ||
           std::find(others.begin(), others.end(), changed_header) == others.end();
}
template <class T>
void compare_operations() {
    const tie::format<T> f;
    std::vector<tie::line> lines;
    tie::add_lines<T>(lines, tie::other_operations<T>(f), tie::format<T>::of_rules);
    found += tie::count_differences(lines, first_alone);
}
template <class T>
void compare() {
    if (!is_done()) compare_operations<T>();
    errbound::for_each_rule(tie::tied_rules(), [&]<class Rule>() {
        if (!is_done() && is_due(tie::table_name<Rule>()))
            found += tie::count_differences_of<T, Rule>(first_alone);
    });
}
template <class Tiny>
void compare_tiny() {
    const errbound::validation::tiny_rounding<Tiny> nearest(MPFR_RNDN);
    if (first_alone && std::is_same_v<Tiny, tiny_float<3, 3>>)
        compare_operations<Tiny>();
    else
        compare<Tiny>();
}

}  // namespace

int main(int argc, char** argv) {
    first_alone = argc > 1;
    if (argc > 2) changed_header = argv[2];
    if (is_due("fixed_integer"))
        found += tie::count_differences(tie::lines_of_words(), first_alone);
    if (is_done() || changed_header == "fixed_integer") return found > 0;
    compare<double>();
    compare<float>();
    if constexpr (!errbound::has_fast_fma<double>) {
        if (!is_done()) compare_tiny<tiny_float<3, 3>>();
        if (!is_done()) compare_tiny<tiny_float<4, 4>>();
        if (!is_done()) compare_tiny<tiny_float<5, 3>>();
    }
    return found > 0;
}
