#include <algorithm>
#include <ccd/exact.hpp>
#include <ccd/method.hpp>
#include <ccd/reference.hpp>
#include <utility>

#include "ccd/exact/integers.hpp"
#include "tests/soak/parts.hpp"

namespace soak {
namespace {

using query_families::families;
using query_families::kind;
using query_families::points;

constexpr std::uint64_t queries_per_block = 24;  // of a family and kind

/// The soak takes one query in this many of a family: 1, unless they cost the reference tenths of a
/// second.
unsigned thinning(const query_families::family& family) {
    return family.thinning > 1 ? 50 * family.thinning : 1;
}

/// Each query has four separate vertices.
template <kind K>
query_list<K> listed(const std::vector<family_query>& queries) {
    query_list<K> all;
    for (const family_query& q : queries) {
        const auto first = static_cast<ccd::vertex_index>(all.before.size());
        // In reverse order, so that indices do not ascend.
        for (std::size_t k = q.at.size(); k-- > 0;) all.add_vertex(q.at[k]);
        all.add_pair({first + 3, first + 2, first + 1, first});
    }
    return all;
}

template <kind K>
void compare(std::uint64_t seed, std::uint64_t block, const decider& truth,
             std::span<const decider> deciders, findings& out) {
    const std::vector<family_query> queries = block_queries(seed, block, queries_per_block, K);
    const query_list<K> list = listed<K>(queries);
    const auto answers_of = [&](const decider& d) {
        // Invalid initial values, so that a skipped query is detected.
        std::vector<ccd::outcome> answers(queries.size(), static_cast<ccd::outcome>(255));
        d.decide.of<K>()(list, answers);
        return answers;
    };
    const std::vector<ccd::outcome> right = answers_of(truth);
    const std::size_t column = K == kind::vertex_face ? 0 : 2;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        auto& counts = out.table("family")[row_name(*queries[i].family)];
        ++counts[column];
        counts[column + 1] += right[i] == ccd::outcome::collides;
        out.stir(static_cast<std::uint64_t>(right[i]));
    }
    std::vector<std::string> wrong(queries.size());
    for (const decider& d : deciders) {
        const std::vector<ccd::outcome> found = answers_of(d);
        auto& counts = out.table("against the reference")[d.name];
        counts[0] += queries.size();
        for (std::size_t i = 0; i < queries.size(); ++i) {
            if (found[i] == right[i]) continue;
            ++counts[1];
            wrong[i] += d.name + " returns " + std::string(ccd::name(found[i])) + "; ";
        }
    }
    for (std::size_t i = 0; i < queries.size(); ++i) {
        if (wrong[i].empty()) continue;
        const bool collides = right[i] == ccd::outcome::collides;
        out.differ({std::string(short_name(K)) + " " + std::string(queries[i].family->name) + " " +
                        std::to_string(queries[i].index) + ": " + wrong[i] + "the reference " +
                        std::string(ccd::name(right[i])),
                    "differences-" + std::string(short_name(K)) + ".csv",
                    query_families::csv(queries[i].at, collides ? ",1" : ",0")});
    }
}

/// Calls `decide(queries, answers)` for every kind.
template <class Decide>
decider of_all_kinds(std::string name, const Decide& decide) {
    decider all{.name = std::move(name)};
    ccd::for_each_kind([&]<ccd::kind K>() { all.decide.of<K>() = decide; });
    return all;
}

decider exact_one_by_one() {
    return of_all_kinds(
        "one by one", []<ccd::kind K>(const query_list<K>& list, std::span<ccd::outcome> answers) {
            ccd::stage_report report;
            std::ranges::transform(list.stored, answers.begin(), [&](const auto& q) {
                if constexpr (requires { ccd::decide_exact(q, &report); })
                    return ccd::decide_exact(q, &report).outcome;
                else
                    return ccd::decide_exact(q).outcome;
            });
            return report;
        });
}

}  // namespace

std::uint64_t family_end(const query_families::family& family, std::uint64_t blocks,
                         std::uint64_t per_block) {
    return blocks * per_block / thinning(family);
}

std::vector<family_query> block_queries(std::uint64_t seed, std::uint64_t block,
                                        std::uint64_t per_block, kind which) {
    std::vector<family_query> all;
    const auto add = [&](const query_families::family& f, std::uint64_t index) {
        all.push_back({&f, index, query_families::make(f, which, seed, index)});
    };
    const auto first = [&](const auto& f) { return family_end(f, block, per_block); };
    const auto end = [&](const auto& f) { return family_end(f, block + 1, per_block); };
    if (block % 2 == 0) {
        for (const auto& f : families)
            for (std::uint64_t i = first(f); i < end(f); ++i) add(f, i);
    } else {
        for (std::uint64_t k = 0; k < per_block; ++k)
            for (const auto& f : families)
                if (first(f) + k < end(f)) add(f, first(f) + k);
    }
    return all;
}

std::uint64_t queries_in(std::uint64_t blocks, std::uint64_t per_block) {
    std::uint64_t count = 0;
    for (const auto& f : families) count += family_end(f, blocks, per_block);
    return count;
}

count_table family_table(std::vector<std::string> columns) {
    count_table table{"family", std::move(columns)};
    for (const auto& f : families) table[row_name(f)];
    return table;
}

std::string row_name(const query_families::family& family) {
    std::string name(family.name);
    if (thinning(family) > 1) name += ", 1 in " + std::to_string(thinning(family));
    return name;
}

part comparison_part(decider truth, std::vector<decider> deciders) {
    part all{.name = "comparison", .unit = "queries"};
    all.count = [](std::uint64_t blocks) {
        return ccd::stored_kinds.size() * queries_in(blocks, queries_per_block);
    };
    all.compare_block = [truth = std::move(truth), deciders = std::move(deciders)](
                            std::uint64_t seed, std::uint64_t block) {
        findings out{
            .blocks = 1,
            .tables = {family_table({"vf queries", "vf collisions", "ee queries", "ee collisions"}),
                       {"against the reference", {"compared", "differences"}}}};
        compare<kind::vertex_face>(seed, block, truth, deciders, out);
        compare<kind::edge_edge>(seed, block, truth, deciders, out);
        return out;
    };
    return all;
}

decider reference() {
    return one_by_one("reference", [](const auto& q) { return ccd::decide_reference(q); });
}

std::vector<decider> exact_deciders() {
    std::vector<decider> all{exact_one_by_one()};
    for (const ccd::instruction_set set : ccd::instruction_sets()) {
        const std::string name(ccd::name(set));
        all.push_back(of_all_kinds(
            name + ", stored", [set](const auto& list, std::span<ccd::outcome> answers) {
                return ccd::decide_batch(list.stored, answers,
                                         {.threads = 1, .set = set, .explain = true});
            }));
        all.push_back(of_all_kinds(name + ", by index", [set](const auto& list,
                                                              std::span<ccd::outcome> answers) {
            // Two threads, since the split of a batch is compared, too. Reports no stages, since
            // the skipped ones depend on the split.
            return ccd::decide_batch(list.rows(), list.pairs, answers, {.threads = 2, .set = set});
        }));
    }
    return all;
}

decider unfiltered_integers() {
    return one_by_one("integers, unfiltered", [](const auto& q) {
        const ccd::verdict by_integers = ccd::detail::decide_in_integers(q);
        return by_integers.outcome == ccd::outcome::uncertain ? ccd::decide_reference(q)
                                                              : by_integers;
    });
}

std::vector<decider> symmetric_deciders() {
    std::vector<decider> all = exact_deciders();
    for (const ccd::method method : {ccd::method::tight, ccd::method::safe}) {
        all.push_back(one_by_one(
            std::string(ccd::info(method).name),
            [method](const auto& q) requires requires { ccd::decide(method, q); } {
                return ccd::decide(method, q);
            }));
        all.back().may_be_uncertain = true;
    }
    return all;
}

}  // namespace soak
