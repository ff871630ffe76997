// Errors and run time on stiff and extreme queries (ccd/stress/).
#include "ccd/stress/stress.hpp"

#include <cmath>

#include "ccd/report/report.hpp"
#include "ccd/report/sections.hpp"

namespace ccd::report {
namespace {

/// `exact` in batches, which promises what `exact` does.
stress::subject batch_subject() {
    stress::subject batch = stress::subject_of(info(method::exact));
    batch.name = batch_name;
    const auto in_batches = [answers = std::vector<outcome>()](auto queries,
                                                               std::span<verdict> said) mutable {
        answers.resize(queries.size());
        decide_batch(queries, answers, {.threads = 1});
        // Batches are uncertain only of coordinates that are not finite.
        std::ranges::transform(answers, said.begin(), [](outcome answer) {
            return verdict{answer, answer == outcome::uncertain ? cause::range : cause::none};
        });
    };
    batch.decide = {in_batches, in_batches};
    return batch;
}

/// A number that JSON can hold: it has no infinity.
row number_or_text(double x) {
    return std::isfinite(x) ? row(x) : row(x < 0 ? "-inf" : "inf");
}

}  // namespace

rows stress_methods(const stress::family& family, const std::vector<std::string>& methods,
                    const sample_sizes& size, int threads, const progress& show) {
    stress::plan plan{.families = {&family},
                      .subjects = {},
                      .queries = size.stress_queries,
                      .threads = threads,
                      .seconds = size.stress_seconds};
    for (const std::string& name : methods) {
        plan.subjects.push_back(name == batch_name ? batch_subject()
                                                   : stress::subject_of(info(*find_method(name))));
    }
    rows result;
    const auto show_cells = [&show](std::size_t done, std::size_t all, const stress::family&) {
        show(static_cast<double>(done) / static_cast<double>(all));
    };
    for (const stress::cell& c : stress::run(plan, show_cells)) {
        result.push_back({{"knob", number_or_text(c.knob)},
                          {"kind", short_name(c.kind)},
                          {"method", plan.subjects[c.subject].name},
                          {"queries", c.queries},
                          {"collisions", c.collisions},
                          {"false_positives", c.false_positives},
                          {"false_negatives", c.false_negatives},
                          {"uncertain", c.uncertain},
                          {"ns_per_query", c.ns_per_query}});
        if (c.broken) {
            result.back()["broken"] = c.broken->what;
            result.back()["query"] = c.broken->index;
        }
    }
    return result;
}

}  // namespace ccd::report
