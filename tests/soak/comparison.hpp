// The comparison that `./run soak` repeats: deciders against a reference, on seeded queries.
//
// A run is a sequence of blocks. Block b of a seed holds the same queries on every machine, some of
// every family and of both kinds, so that a number of blocks is all the state that a run has.
#pragma once

#include <ccd/query.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/query_families.hpp"

namespace soak {

inline constexpr std::size_t family_count = std::size(query_families::families);

/// Decides queries[i] into answers[i], by whatever means. Called from several threads at once.
template <class Query>
using batch_decider = std::function<void(std::span<const Query>, std::span<ccd::outcome>)>;

struct decider {
    std::string name;
    ccd::by_stored_kind<batch_decider> decide;
};

/// ccd::decide_reference.
decider reference();
/// All that promise the reference's answers: `exact` one by one, its last stages without the
/// filters, and batches on every instruction set of this machine, of stored queries and by index.
std::vector<decider> exact_deciders();

/// The soak takes one query in this many of a family: 1, but for those that cost the reference
/// tenths of a second, and as much again whoever resorts to it.
unsigned thinning(const query_families::family& family);

/// The first index of `family` after that many blocks, of either kind: each block has 24 queries of
/// a family and kind, fewer of one that is thinned.
std::uint64_t family_end(const query_families::family& family, std::uint64_t blocks);
/// All queries of that many blocks.
std::uint64_t query_count(std::uint64_t blocks);
/// The least number of blocks with at least so many queries.
std::uint64_t blocks_for(std::uint64_t queries);

struct kind_counts {
    std::uint64_t queries = 0;
    std::uint64_t collisions = 0;  ///< by the reference
    friend bool operator==(const kind_counts&, const kind_counts&) = default;
};

struct decider_counts {
    std::string name;
    std::uint64_t compared = 0;
    std::uint64_t differences = 0;
    friend bool operator==(const decider_counts&, const decider_counts&) = default;
};

/// A query on which some deciders did not answer as the reference.
struct difference {
    std::size_t family = 0;
    query_families::kind which{};
    std::uint64_t index = 0;
    bool collides = false;           ///< by the reference
    std::vector<std::string> wrong;  ///< names of deciders
    friend bool operator==(const difference&, const difference&) = default;
};

/// What a run found so far.
struct totals {
    /// So many differences are kept; those beyond are only counted.
    static constexpr std::size_t max_kept = 10000;

    std::uint64_t blocks = 0;
    std::vector<kind_counts> families[ccd::stored_kinds.size()] = {
        std::vector<kind_counts>(family_count), std::vector<kind_counts>(family_count)};
    std::vector<decider_counts> deciders;
    std::uint64_t differing_queries = 0;
    std::vector<difference> differences;

    void add(const totals& other);
    friend bool operator==(const totals&, const totals&) = default;
};

/// Compares all `deciders` with `truth` on one block. Throws what they throw.
totals compare_block(std::uint64_t seed, std::uint64_t block, const decider& truth,
                     std::span<const decider> deciders);

/// The differing queries of one kind as `ccd query` reads them: hexadecimal floats, the reference's
/// answer as truth. Empty if there are none.
std::string differing_queries_csv(const totals& found, std::uint64_t seed,
                                  query_families::kind which);

}  // namespace soak
