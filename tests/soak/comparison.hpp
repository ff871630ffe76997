// The part of the soak with a reference: deciders against it, on seeded queries of both stored
// kinds.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tests/soak/deciders.hpp"
#include "tests/soak/long_run.hpp"
#include "tests/support/query_families.hpp"

namespace soak {

/// The soak takes one query in this many of a family: 1, but for those that cost the reference
/// tenths of a second, and as much again whoever resorts to it.
unsigned thinning(const query_families::family& family);

/// The first index of `family` after that many blocks of `per_block` of its queries, fewer of one
/// that is thinned.
std::uint64_t family_end(const query_families::family& family, std::uint64_t blocks,
                         std::uint64_t per_block);

/// A query of a family.
struct family_query {
    const query_families::family* family;
    std::uint64_t index;
    query_families::points at;
};
/// A block's queries of one kind, `per_block` of every family, in the order in which deciders get
/// them: neighbours are of one family in even blocks, of different families in odd ones.
std::vector<family_query> block_queries(std::uint64_t seed, std::uint64_t block,
                                        std::uint64_t per_block, query_families::kind which);

/// The families' names, for part::version.
std::string family_names();
/// The row of a family in tables.
std::string row_name(const query_families::family& family);

/// Families and their collisions in the table "family"; in "against the reference" a row for each
/// decider: compared, different.
part comparison_part(decider truth, std::vector<decider> deciders);

}  // namespace soak
