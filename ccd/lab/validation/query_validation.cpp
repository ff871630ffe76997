#include "ccd/lab/validation/query_validation.hpp"

#include <algorithm>
#include <array>
#include <ccd/methods/transform.hpp>
#include <iterator>
#include <map>
#include <utility>

#include "errbound/validation/chunks.hpp"

namespace ccd::lab {

namespace {

using namespace errbound::validation;

/// Products of degree 72 in 53-bit coordinates need about 4000 bits to be exact; few queries do.
constexpr std::array<mpfr_prec_t, 4> precisions{384, 1536, 6144, 24576};
constexpr std::uint64_t least_chunk = 16;

struct tally {
    rule_counts counts;
    std::map<std::string, distribution, std::less<>> quantities;
    std::vector<violation> violations;  ///< the first ones
};

template <class Query>
std::string text_of(const Query& query) {
    std::string text;
    for (const int end : {0, 1})
        for (const auto& p : points_of(query)) {
            const auto& x = end == 0 ? p.t0 : p.t1;
            text += hexadecimal(x.x) + "," + hexadecimal(x.y) + "," + hexadecimal(x.z) + "\n";
        }
    return text;
}

template <class Query>
void check(const query_rule& r, const Query& query, std::uint64_t index, tally& to) {
    for (const mpfr_prec_t precision : precisions) {
        shadow_session session(precision);
        r.check.of<kind_of<Query>>()(query, session);
        if (session.undetermined() > 0 && precision != precisions.back()) continue;
        ++to.counts.cases;
        to.counts.values += session.values();
        to.counts.violations += session.violations();
        to.counts.undetermined += session.undetermined();
        for (const auto& [name, log10] : session.quantities()) to.quantities[name].merge(log10);
        if (session.violations() > 0 && to.violations.size() < report::kept_violations) {
            const auto& first = session.first_violation();
            to.violations.push_back({.rule = std::string(r.name),
                                     .number = "double",
                                     .index = index,
                                     .what = "query " + std::to_string(index) + ", " +
                                             first.operation + ": " + first.what,
                                     .code = text_of(query)});
        }
        return;
    }
}

template <class Query>
report report_of(std::span<const query_rule> rules, std::span<const Query> queries,
                 const chunks& of_queries, std::uint64_t chunk) {
    report result;
    for (const query_rule& r : rules) {
        tally found;
        found.counts.rule = r.name;
        found.counts.number = "double";
        for (auto [i, end] = of_queries.of(chunk); i < end; ++i) check(r, queries[i], i, found);
        result.counts.push_back(found.counts);
        for (auto& [name, log10] : found.quantities)
            result.distributions.push_back({std::string(r.name), "double", name,
                                            std::string(measure_of(r.error_is)), std::move(log10),
                                            r.claimed_rate});
        std::ranges::move(found.violations, std::back_inserter(result.violations));
    }
    return result;
}

}  // namespace

template <class Query>
evidence evidence_of_queries(std::span<const query_rule> rules, std::span<const Query> queries) {
    const chunks c(queries.size(), least_chunk);
    return with_mpfr(
        {.chunks = c.count(),
         .report_of =
             [rules = std::vector(rules.begin(), rules.end()), queries, c](std::uint64_t chunk) {
                 return report_of(std::span(rules), queries, c, chunk);
             },
         .describe = [](report&) {}});
}
template evidence evidence_of_queries(std::span<const query_rule>,
                                      std::span<const vertex_face<double>>);
template evidence evidence_of_queries(std::span<const query_rule>,
                                      std::span<const edge_edge<double>>);

std::vector<query_rule> query_rules() {
    std::vector<query_rule> all;
    errbound::for_each_rule(errbound::all_rules(),
                            [&]<class Rule>() { all.push_back(query_rule_of<Rule>()); });
    return all;
}

}  // namespace ccd::lab
