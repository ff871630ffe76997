#include "tests/soak/comparison.hpp"

#include <algorithm>
#include <utility>

namespace soak {
namespace {

using query_families::families;
using query_families::kind;
using query_families::points;

constexpr std::uint64_t queries_per_block = 24;  // of a family and kind

/// Each query has four vertices of its own.
template <kind K>
questions<K> questions_of(const std::vector<family_query>& queries) {
    questions<K> all;
    for (const family_query& q : queries) {
        const auto first = static_cast<ccd::vertex_index>(all.before.size());
        // Backwards, so that indices do not ascend, as in a mesh.
        for (std::size_t k = q.at.size(); k-- > 0;) all.add_vertex(q.at[k]);
        all.add_pair({first + 3, first + 2, first + 1, first});
    }
    return all;
}

template <kind K>
void compare(std::uint64_t seed, std::uint64_t block, const decider& truth,
             std::span<const decider> deciders, findings& out) {
    const std::vector<family_query> queries = block_queries(seed, block, queries_per_block, K);
    const questions<K> asked = questions_of<K>(queries);
    const auto answers_of = [&](const decider& d) {
        // Made invalid first, so that a query left out is seen.
        std::vector<ccd::outcome> answers(queries.size(), static_cast<ccd::outcome>(255));
        d.decide.of<K>()(asked, answers);
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
        const std::vector<ccd::outcome> said = answers_of(d);
        auto& counts = out.table("against the reference")[d.name];
        counts[0] += queries.size();
        for (std::size_t i = 0; i < queries.size(); ++i) {
            if (said[i] == right[i]) continue;
            ++counts[1];
            wrong[i] += d.name + " says " + std::string(ccd::name(said[i])) + "; ";
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

}  // namespace

unsigned thinning(const query_families::family& family) {
    return family.thinning > 1 ? 50 * family.thinning : 1;
}

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

std::string family_names() {
    std::string names;
    for (const auto& f : families) names += row_name(f) + "; ";
    return names;
}

std::string row_name(const query_families::family& family) {
    std::string name(family.name);
    if (thinning(family) > 1) name += ", 1 in " + std::to_string(thinning(family));
    return name;
}

part comparison_part(decider truth, std::vector<decider> deciders) {
    part all{.name = "comparison", .unit = "queries", .version = family_names()};
    all.count = [](std::uint64_t blocks) {
        std::uint64_t count = 0;
        for (const auto& f : families)
            count += ccd::stored_kinds.size() * family_end(f, blocks, queries_per_block);
        return count;
    };
    all.compare_block = [truth = std::move(truth), deciders = std::move(deciders)](
                            std::uint64_t seed, std::uint64_t block) {
        findings out{
            .blocks = 1,
            .tables = {{"family", {"vf queries", "vf collisions", "ee queries", "ee collisions"}},
                       {"against the reference", {"compared", "differences"}}}};
        for (const auto& f : families) out.table("family")[row_name(f)];
        compare<kind::vertex_face>(seed, block, truth, deciders, out);
        compare<kind::edge_edge>(seed, block, truth, deciders, out);
        return out;
    };
    return all;
}

}  // namespace soak
