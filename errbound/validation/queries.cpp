// Stored queries in shadowed arithmetic, every rule.
#include <algorithm>
#include <array>
#include <ccd/methods/transform.hpp>
#include <errbound/validation/validation.hpp>
#include <map>
#include <utility>

#include "errbound/validation/blocks.hpp"

namespace errbound::validation {

void shadow_session::note(std::string_view quantity, const claim& c, const ball& x, bool promises) {
    auto found = quantities_.find(quantity);
    if (found == quantities_.end())
        found = quantities_.emplace(std::string(quantity), distribution()).first;
    if (std::isfinite(c.value) && x.is_defined()) off_.compute(c.value, x);
    add_ratio(found->second, promises, c, x, off_);
}

namespace {

/// Products of degree 72 in 53-bit coordinates need some 4000 bits to be exact; few queries ask.
constexpr std::array<mpfr_prec_t, 4> precisions{384, 1536, 6144, 24576};
constexpr std::uint64_t block_size = 16;
constexpr std::size_t kept_violations = 5;

struct tally {
    rule_counts counts;
    std::map<std::string, distribution, std::less<>> quantities;
    std::map<std::uint64_t, violation> violations;  ///< by query, the first of them

    void add(std::uint64_t index, violation found) {
        violations.emplace(index, std::move(found));
        if (violations.size() > kept_violations) violations.erase(std::prev(violations.end()));
    }
    void merge(tally& other) {
        counts.cases += other.counts.cases;
        counts.values += other.counts.values;
        counts.violations += other.counts.violations;
        counts.undetermined += other.counts.undetermined;
        for (const auto& [name, log10] : other.quantities) quantities[name].merge(log10);
        for (auto& [index, found] : other.violations) add(index, std::move(found));
    }
};

template <class Query>
std::string text_of(const Query& query) {
    std::string text;
    for (const int end : {0, 1})
        for (const auto& p : ccd::points_of(query)) {
            const auto& x = end == 0 ? p.t0 : p.t1;
            text += hexadecimal(x.x) + "," + hexadecimal(x.y) + "," + hexadecimal(x.z) + "\n";
        }
    return text;
}

void check(const rule& r, const ccd::vertex_face<double>& query, shadow_session& session) {
    r.check_vertex_face(query, session);
}
void check(const rule& r, const ccd::edge_edge<double>& query, shadow_session& session) {
    r.check_edge_edge(query, session);
}

template <class Query>
void check(const rule& r, const Query& query, std::uint64_t index, tally& to) {
    for (const mpfr_prec_t precision : precisions) {
        shadow_session session(precision);
        check(r, query, session);
        if (session.undetermined() > 0 && precision != precisions.back()) continue;
        ++to.counts.cases;
        to.counts.values += session.values();
        to.counts.violations += session.violations();
        to.counts.undetermined += session.undetermined();
        for (const auto& [name, log10] : session.quantities()) to.quantities[name].merge(log10);
        if (session.violations() > 0) {
            const auto& first = session.first_violation();
            to.add(index, {.rule = std::string(r.name),
                           .number = "double",
                           .what = "query " + std::to_string(index) + ", " + first.operation +
                                   ": " + first.what,
                           .code = text_of(query)});
        }
        return;
    }
}

template <class Query>
report validate(std::span<const rule> rules, std::span<const Query> queries, int threads,
                const progress& show) {
    struct worker {
        std::vector<tally> tallies;
    };
    const std::uint64_t blocks = (queries.size() + block_size - 1) / block_size;
    const auto workers = in_blocks<worker>(threads, blocks, show, [&](worker& w, std::uint64_t b) {
        w.tallies.resize(rules.size());
        const std::size_t end = std::min<std::size_t>(queries.size(), (b + 1) * block_size);
        for (std::size_t i = b * block_size; i < end; ++i)
            for (std::size_t k = 0; k < rules.size(); ++k)
                check(rules[k], queries[i], i, w.tallies[k]);
    });
    report result;
    for (std::size_t k = 0; k < rules.size(); ++k) {
        tally sum;
        for (const auto& w : workers)
            if (!w->tallies.empty()) sum.merge(w->tallies[k]);
        sum.counts.rule = rules[k].name;
        sum.counts.number = "double";
        result.counts.push_back(sum.counts);
        for (auto& [name, log10] : sum.quantities)
            result.distributions.push_back({std::string(rules[k].name), "double", name,
                                            rules[k].promises ? "bound/error" : "error/value",
                                            std::move(log10)});
        for (auto& [index, found] : sum.violations) result.violations.push_back(std::move(found));
    }
    return result;
}

}  // namespace

report validate_queries(std::span<const rule> rules,
                        std::span<const ccd::vertex_face<double>> queries, int threads,
                        const progress& show) {
    return validate(rules, queries, threads, show);
}
report validate_queries(std::span<const rule> rules,
                        std::span<const ccd::edge_edge<double>> queries, int threads,
                        const progress& show) {
    return validate(rules, queries, threads, show);
}

}  // namespace errbound::validation
