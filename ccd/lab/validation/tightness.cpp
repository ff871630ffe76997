// Ratios of bounds to true errors, by MPFR (errbound/validation/validation.hpp).
#include <errbound/validation/validation.hpp>

#include "ccd/lab/sections.hpp"
#include "ccd/lab/validation/query_validation.hpp"
#include "errbound/program/examined_parts.hpp"

namespace ccd::lab {
namespace {

namespace validation = errbound::validation;

rows rows_of(const validation::report& found) {
    rows result;
    for (const validation::tightness& t : found.distributions) {
        row& r = result.emplace_back(validation::row_of(t));
        for (const validation::violation& v : found.violations)
            if (v.rule == t.rule && v.number == t.number && !r.contains("broken"))
                r["broken"] = v.what;
    }
    return result;
}

}  // namespace

rows measure_expressions(const sample_sizes& size, int threads, const progress& show) {
    return rows_of(validation::validate_expressions(
        validation::rules(), {.expressions = size.expressions, .threads = threads},
        [&show](std::uint64_t done, std::uint64_t all) {
            show(static_cast<double>(done) / static_cast<double>(all));
        }));
}

rows measure_tightness(const std::vector<const data_set*>& data, const sample_sizes& size,
                       int threads, const progress& show) {
    const std::vector<query_rule> rules = query_rules();
    validation::report found;  // of both kinds of query and all data sets
    for (std::size_t i = 0; i < data.size(); ++i) {
        show(static_cast<double>(i) / static_cast<double>(data.size()));
        data[i]->queries.for_each([&](const auto& known) {
            const auto queries = known.queries.at_most(size.tightness).all_stored();
            found.merge(
                validation::examine(evidence_of_queries(rules, std::span(queries)), threads));
        });
    }
    return rows_of(found);
}

}  // namespace ccd::lab
