// How much larger bounds are than the true errors, by MPFR (errbound/validation/validation.hpp).
#include <algorithm>
#include <errbound/validation/validation.hpp>
#include <utility>

#include "ccd/report/sections.hpp"

namespace ccd::report {
namespace {

namespace validation = errbound::validation;

/// Distributions of one quantity, of both kinds of query and all data sets, as one.
void merge(std::vector<validation::tightness>& all, const validation::tightness& one) {
    const auto same = [&one](const validation::tightness& other) {
        return std::tie(other.rule, other.number, other.quantity) ==
               std::tie(one.rule, one.number, one.quantity);
    };
    const auto known = std::ranges::find_if(all, same);
    if (known == all.end()) {
        all.push_back(one);
    } else {
        known->log10.merge(one.log10);
    }
}

/// A row for each distribution; broken promises are in the column `broken`.
rows rows_of(const validation::report& found) {
    std::vector<validation::tightness> all;
    for (const validation::tightness& one : found.distributions) merge(all, one);
    rows result;
    for (const validation::tightness& t : all) {
        row r = {{"rule", t.rule},
                 {"number", t.number},
                 {"quantity", t.quantity},
                 {"measure", t.measure},
                 {"count", t.log10.ratios()},
                 {"exact", t.log10.exact()},
                 {"unknown", t.log10.unknown()}};
        for (const int percent : {0, 1, 25, 50, 75, 99, 100}) {
            if (t.log10.ratios() > 0)
                r["q" + std::to_string(percent)] = t.log10.quantile(percent / 100.0);
        }
        for (const validation::violation& v : found.violations) {
            if (v.rule == t.rule && v.number == t.number && !r.contains("broken"))
                r["broken"] = v.what;
        }
        result.push_back(std::move(r));
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
    validation::report found;
    for (std::size_t i = 0; i < data.size(); ++i) {
        show(static_cast<double>(i) / static_cast<double>(data.size()));
        data[i]->queries.for_each([&](const auto& known) {
            const auto queries = known.queries.at_most(size.tightness).all_stored();
            found.add(
                validation::validate_queries(validation::rules(), std::span(queries), threads));
        });
    }
    return rows_of(found);
}

}  // namespace ccd::report
