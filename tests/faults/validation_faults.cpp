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

TEST(ValidationFaults, QueriesAndExpressions) {
    const std::vector<ccd::vertex_face<double>> queries{{{{0.25, 0.1, 1}, {0.25, 0.3, -1}},
                                                         {{0, 0, 0.1}, {0, 0, 0}},
                                                         {{1.3, 0, 0}, {1, 0, 0}},
                                                         {{0, 1.7, 0}, {0, 1, 0}}}};
    const std::vector<rule> two(rules().begin(), rules().begin() + 2);
    for (const int threads : {1, 2}) {
        const std::string of = ", threads: " + std::to_string(threads);
        try_every_allocation("validate_queries" + of, [&] {
            return content(validate_queries(two, std::span(queries), threads));
        });
    }
    expression_options options;
    options.expressions = options.operations = 1;
    options.threads = 1;
    try_every_allocation("validate_expressions",
                         [&] { return content(validate_expressions(two, options)); });
}

}  // namespace
