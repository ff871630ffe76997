// Ratios of bounds to true errors, by MPFR (errbound/validation/validation.hpp).
#include <errbound/validation/validation.hpp>
#include <string>
#include <utility>

#include "ccd/lab/sections.hpp"
#include "ccd/lab/validation/query_validation.hpp"

namespace ccd::lab {
namespace {

namespace validation = errbound::validation;

rows rows_of(const validation::report& found) {
    rows result;
    for (const validation::tightness& t : found.distributions) {
        row r = {{"rule", t.rule},
                 {"number", t.number},
                 {"quantity", t.quantity},
                 {"measure", t.measure},
                 {"count", t.log10.ratios()},
                 {"exact", t.log10.exact()},
                 {"unknown", t.log10.unknown()}};
        if (t.claimed > 0 && t.log10.ratios() + t.log10.exact() > 0) {
            r["claimed"] = t.claimed;
            r["observed"] = t.observed();
        }
        std::string clamped;
        for (const int percent : {0, 1, 25, 50, 75, 99, 100}) {
            if (t.log10.ratios() == 0) continue;
            const std::string name = "q" + std::to_string(percent);
            r[name] = t.log10.quantile(percent / 100.0);
            if (t.log10.is_clamped(percent / 100.0)) clamped += (clamped.empty() ? "" : " ") + name;
        }
        if (!clamped.empty()) r["clamped"] = clamped;
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
