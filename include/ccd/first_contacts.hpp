// Contact data of many queries at once, over threads: for those whose first times are known
// (ccd/first_times.hpp, or a step's).
#pragma once

#include <ccd/batch.hpp>
#include <ccd/contact.hpp>
#include <ccd/contact_data.hpp>
#include <span>
#include <vector>

namespace ccd {

namespace detail {

template <class Pair>
std::vector<first_contact> contacts_of_pairs(const vertex_rows& positions,
                                             std::span<const Pair> pairs,
                                             std::span<const first_time> times, int threads);
template <class Query>
std::vector<first_contact> contacts_of_queries(std::span<const Query> queries,
                                               std::span<const first_time> times, int threads);

}  // namespace detail

/// contact_at of each query and its first time, of any kind: by index, or stored. On at most so
/// many threads; 0: one per core. Throws std::invalid_argument if there are not as many times as
/// queries, an index is out of range or positions are null.
///
/// Cost: that of contact_at for each contact. Memory: the result's.
template <pair_range Pairs>
std::vector<first_contact> first_contacts(const vertex_rows& positions, const Pairs& pairs,
                                          std::span<const first_time> times, int threads = 0) {
    return detail::contacts_of_pairs(positions, detail::items_of<Pairs>(pairs), times, threads);
}
template <query_range Queries>
std::vector<first_contact> first_contacts(const Queries& queries, std::span<const first_time> times,
                                          int threads = 0) {
    return detail::contacts_of_queries(detail::items_of<Queries>(queries), times, threads);
}

}  // namespace ccd
