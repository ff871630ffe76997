// Validation when memory runs out. (MPFR allocates by malloc, which does not fail here.)
#include <errbound/validation/validation.hpp>
#include <tuple>
#include <vector>

#include "tests/faults/failing_heap.hpp"

namespace {

using namespace errbound::validation;
using faults::try_every_allocation;

auto content(const report& found) {
    std::vector<std::tuple<std::string, std::uint64_t, std::uint64_t>> counts;
    for (const rule_counts& c : found.counts) counts.emplace_back(c.rule, c.values, c.violations);
    return counts;
}

TEST(ValidationFaults, Expressions) {
    const std::vector<rule> two(rules().begin(), rules().begin() + 2);
    expression_options options;
    options.expressions = options.operations = 1;
    options.threads = 1;
    try_every_allocation("validate_expressions",
                         [&] { return content(validate_expressions(two, options)); });
}

}  // namespace
