#include "tests/soak/comparison.hpp"

#include <algorithm>
#include <array>
#include <ccd/batch.hpp>
#include <ccd/method.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/reference.hpp>
#include <utility>

#include "ccd/exact/integers.hpp"

namespace soak {
namespace {

using query_families::families;
using query_families::kind;
using query_families::points;

constexpr std::uint64_t queries_per_block = 24;  // of a family and kind

/// A decider of both kinds from one generic function (queries, answers).
template <class Decide>
decider both_kinds(std::string name, Decide decide) {
    return {std::move(name), {decide, decide}};
}

template <class Decide>
decider one_by_one(std::string name, Decide decide) {
    return both_kinds(std::move(name), [decide](auto queries, std::span<ccd::outcome> answers) {
        std::ranges::transform(queries, answers.begin(),
                               [&decide](const auto& q) { return decide(q).outcome; });
    });
}

/// The queries of `queries` by index: each has four vertices of its own.
template <class Query>
struct indexed {
    std::vector<ccd::point<double>> before, after;
    std::vector<ccd::pair_of_query<Query>> queries;

    explicit indexed(std::span<const Query> stored) {
        for (const Query& q : stored) {
            const auto first = static_cast<ccd::vertex_index>(before.size());
            const auto p = ccd::points_of(q);
            // Backwards, so that indices do not ascend, as in a mesh.
            for (std::size_t k = p.size(); k-- > 0;) {
                before.push_back(p[k].t0);
                after.push_back(p[k].t1);
            }
            queries.push_back({first + 3, first + 2, first + 1, first});
        }
    }
    ccd::vertex_rows rows() const { return {&before.data()->x, &after.data()->x, before.size()}; }
};

/// One block's queries of one kind, in the order in which deciders get them.
struct block_queries {
    std::vector<std::size_t> family;
    std::vector<std::uint64_t> index;
    std::vector<points> at;
};

block_queries queries_of(std::uint64_t seed, std::uint64_t block, kind which) {
    block_queries all;
    const auto add = [&](std::size_t f, std::uint64_t index) {
        all.family.push_back(f);
        all.index.push_back(index);
        all.at.push_back(query_families::make(families[f], which, seed, index));
    };
    const auto first = [block](std::size_t f) { return family_end(families[f], block); };
    const auto end = [block](std::size_t f) { return family_end(families[f], block + 1); };
    // In packs, neighbours meet: of one family in even blocks, of different families in odd ones.
    if (block % 2 == 0) {
        for (std::size_t f = 0; f < family_count; ++f) {
            for (std::uint64_t i = first(f); i < end(f); ++i) add(f, i);
        }
    } else {
        for (std::uint64_t k = 0; k < queries_per_block; ++k) {
            for (std::size_t f = 0; f < family_count; ++f) {
                if (first(f) + k < end(f)) add(f, first(f) + k);
            }
        }
    }
    return all;
}

template <kind K>
void compare(std::uint64_t seed, std::uint64_t block, const decider& truth,
             std::span<const decider> deciders, totals& out) {
    using query = typename ccd::kind_traits<K>::template query<double>;
    const block_queries all = queries_of(seed, block, K);
    std::vector<query> queries;
    for (const points& p : all.at) queries.push_back(query_families::as_query<query>(p));

    const auto answers_of = [&](const decider& d) {
        // Made invalid first, so that a query left out is seen.
        std::vector<ccd::outcome> answers(queries.size(), static_cast<ccd::outcome>(255));
        d.decide.of<K>()(queries, answers);
        return answers;
    };
    const std::vector<ccd::outcome> right = answers_of(truth);
    auto& counts = out.families[K == kind::vertex_face ? 0 : 1];
    for (std::size_t i = 0; i < queries.size(); ++i) {
        ++counts[all.family[i]].queries;
        counts[all.family[i]].collisions += right[i] == ccd::outcome::collides;
    }
    std::vector<std::vector<std::string>> wrong(queries.size());
    for (std::size_t d = 0; d < deciders.size(); ++d) {
        const std::vector<ccd::outcome> said = answers_of(deciders[d]);
        out.deciders[d].compared += queries.size();
        for (std::size_t i = 0; i < queries.size(); ++i) {
            if (said[i] == right[i]) continue;
            ++out.deciders[d].differences;
            wrong[i].push_back(deciders[d].name);
        }
    }
    for (std::size_t i = 0; i < queries.size(); ++i) {
        if (wrong[i].empty()) continue;
        ++out.differing_queries;
        out.differences.push_back({all.family[i], K, all.index[i],
                                   right[i] == ccd::outcome::collides, std::move(wrong[i])});
    }
}

}  // namespace

decider reference() {
    return one_by_one("reference", [](const auto& q) { return ccd::decide_reference(q); });
}

std::vector<decider> exact_deciders() {
    std::vector<decider> all;
    all.push_back(
        one_by_one("one by one", [](const auto& q) { return ccd::decide(ccd::method::exact, q); }));
    // The last stages alone: they see what filters decide before them in `exact`.
    all.push_back(one_by_one("integers, unfiltered", [](const auto& q) {
        const ccd::verdict by_integers = ccd::detail::decide_in_integers(q);
        return by_integers.outcome == ccd::outcome::uncertain ? ccd::decide_reference(q)
                                                              : by_integers;
    }));
    for (const ccd::instruction_set set : ccd::instruction_sets()) {
        const std::string name(ccd::name(set));
        all.push_back(
            both_kinds(name + ", stored", [set](auto queries, std::span<ccd::outcome> answers) {
                ccd::decide_batch(queries, answers, {.threads = 1, .set = set});
            }));
        all.push_back(both_kinds(
            name + ", by index",
            [set]<class Query>(std::span<const Query> queries, std::span<ccd::outcome> answers) {
                const indexed<Query> by_index(queries);
                // Two threads: the split of a batch is compared too.
                ccd::decide_batch(by_index.rows(), std::span(std::as_const(by_index.queries)),
                                  answers, {.threads = 2, .set = set});
            }));
    }
    return all;
}

unsigned thinning(const query_families::family& family) {
    return family.thinning > 1 ? 50 * family.thinning : 1;
}

std::uint64_t family_end(const query_families::family& family, std::uint64_t blocks) {
    return blocks * queries_per_block / thinning(family);
}

std::uint64_t query_count(std::uint64_t blocks) {
    std::uint64_t count = 0;
    for (const auto& family : families)
        count += ccd::stored_kinds.size() * family_end(family, blocks);
    return count;
}

std::uint64_t blocks_for(std::uint64_t queries) {
    // One more block always holds at least one query of an unthinned family.
    std::uint64_t low = 0, high = queries;
    while (low < high) {
        const std::uint64_t middle = low + (high - low) / 2;
        if (query_count(middle) >= queries) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return low;
}

void totals::add(const totals& other) {
    blocks += other.blocks;
    for (std::size_t k = 0; k < ccd::stored_kinds.size(); ++k) {
        for (std::size_t f = 0; f < family_count; ++f) {
            families[k][f].queries += other.families[k][f].queries;
            families[k][f].collisions += other.families[k][f].collisions;
        }
    }
    for (const decider_counts& d : other.deciders) {
        const auto same = std::ranges::find(deciders, d.name, &decider_counts::name);
        if (same == deciders.end()) {
            deciders.push_back(d);
        } else {
            same->compared += d.compared;
            same->differences += d.differences;
        }
    }
    differing_queries += other.differing_queries;
    for (const difference& d : other.differences) {
        if (differences.size() < max_kept) differences.push_back(d);
    }
}

totals compare_block(std::uint64_t seed, std::uint64_t block, const decider& truth,
                     std::span<const decider> deciders) {
    totals out;
    out.blocks = 1;
    for (const decider& d : deciders) out.deciders.push_back({.name = d.name});
    compare<kind::vertex_face>(seed, block, truth, deciders, out);
    compare<kind::edge_edge>(seed, block, truth, deciders, out);
    return out;
}

std::string differing_queries_csv(const totals& found, std::uint64_t seed, kind which) {
    std::string text;
    for (const difference& d : found.differences) {
        if (d.which != which) continue;
        text += query_families::csv(query_families::make(families[d.family], which, seed, d.index),
                                    d.collides ? ",1" : ",0");
    }
    return text;
}

}  // namespace soak
