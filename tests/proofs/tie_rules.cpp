// Compares the rules, their functions and integers of words with the proofs' definitions
// (proofs/tie/tie.ml), up to the first difference. mutants.py runs it, and with fused multiply-add
// every build does. It skips the slowest tiny format, which tie_test has.
#include <algorithm>
#include <array>
#include <cstdio>
#include <errbound/error_free.hpp>
#include <errbound/validation/tiny_float.hpp>
#include <string>
#include <vector>

#include "tests/errbound/validation/tie_functions.hpp"
#include "tests/errbound/validation/tie_words.hpp"
#include "tests/proofs/table.hpp"

namespace {

using errbound::validation::tiny_float;
using errbound::validation::tiny_rounding;

std::string changed_header;

/// True if a header of this name can affect the results: the rule's header, or one of no rule.
bool is_due(const std::string& name) {
    const std::array<std::string, 8> others{"tight",    "sharp",    "safe",   "interval",
                                            "residual", "relative", "affine", "fixed_integer"};
    return changed_header == name ||
           std::find(others.begin(), others.end(), changed_header) == others.end();
}
bool is_told(const std::string& format, const std::vector<std::string>& differences) {
    for (const std::string& operation : differences)
        std::printf("%s %s: not as proofs/tie.txt has it\n", format.c_str(), operation.c_str());
    return !differences.empty();
}
/// Stops at the first rule that differs.
template <class T>
bool differs() {
    const tie::table expected = tie::read_table();
    const tie::format<T> f;
    bool found = is_told(f.name, tie::differences<T>(expected, tie::other_operations<T>(f),
                                                     tie::format<T>::of_rules));
    errbound::for_each_rule(tie::tied_rules(), [&]<class Rule>() {
        if (!is_due(tie::table_name<Rule>())) return;
        found = found || is_told(f.name, tie::differences<T, Rule>(expected)) ||
                is_told(f.name, tie::differences_of_functions<T, Rule>(expected));
    });
    return found;
}
template <class Tiny>
bool tiny_differs() {
    const tiny_rounding<Tiny> nearest(MPFR_RNDN);
    return differs<Tiny>();
}
/// Operations that are not of a rule.
template <class Tiny>
bool tiny_operations_differ() {
    const tiny_rounding<Tiny> nearest(MPFR_RNDN);
    const tie::format<Tiny> f;
    return is_told(f.name, tie::differences<Tiny>(tie::read_table(), tie::other_operations<Tiny>(f),
                                                  tie::format<Tiny>::of_rules));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc > 2) changed_header = argv[2];
    if (is_due("fixed_integer") && tie::count_differences(tie::lines_of_words(), true) != 0)
        return 1;
    if (changed_header == "fixed_integer") return 0;
    if (differs<double>() || differs<float>()) return 1;
    if constexpr (!errbound::has_fast_fma<double>) {
        if (tiny_operations_differ<tiny_float<3, 3>>() || tiny_differs<tiny_float<4, 4>>() ||
            tiny_differs<tiny_float<5, 3>>())
            return 1;
    }
    return 0;
}
