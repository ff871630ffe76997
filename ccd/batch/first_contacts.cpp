// Contact data of many queries: see include/ccd/first_contacts.hpp.
#include <ccd/first_contacts.hpp>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "ccd/batch/checks.hpp"
#include "ccd/batch/threads.hpp"

namespace ccd::detail {
namespace {

constexpr const char* caller = "ccd::first_contacts";

template <class QueryAt>
std::vector<first_contact> all_contacts(std::size_t queries, std::span<const first_time> times,
                                        int threads, const QueryAt& query_at) {
    if (queries != times.size())
        throw std::invalid_argument(std::string(caller) + ": " + std::to_string(queries) +
                                    " queries, but " + std::to_string(times.size()) + " times");
    std::vector<first_contact> found(queries);
    for_each_index(queries, threads,
                   [&](std::size_t i) { found[i] = contact_at(query_at(i), times[i]); });
    return found;
}

}  // namespace

template <class Pair>
std::vector<first_contact> contacts_of_pairs(const vertex_rows& positions,
                                             std::span<const Pair> pairs,
                                             std::span<const first_time> times, int threads) {
    check_pointers(caller, positions);
    check_indices(caller, pairs, 0, positions.vertices);
    return all_contacts(pairs.size(), times, threads,
                        [&](std::size_t i) { return query_of(positions, pairs[i]); });
}
template <class Query>
std::vector<first_contact> contacts_of_queries(std::span<const Query> queries,
                                               std::span<const first_time> times, int threads) {
    return all_contacts(queries.size(), times, threads,
                        [&](std::size_t i) -> const Query& { return queries[i]; });
}

template std::vector<first_contact> contacts_of_pairs(const vertex_rows&,
                                                      std::span<const vertex_face_pair>,
                                                      std::span<const first_time>, int);
template std::vector<first_contact> contacts_of_queries(std::span<const vertex_face<double>>,
                                                        std::span<const first_time>, int);
template std::vector<first_contact> contacts_of_pairs(const vertex_rows&,
                                                      std::span<const edge_edge_pair>,
                                                      std::span<const first_time>, int);
template std::vector<first_contact> contacts_of_queries(std::span<const edge_edge<double>>,
                                                        std::span<const first_time>, int);
template std::vector<first_contact> contacts_of_pairs(const vertex_rows&,
                                                      std::span<const vertex_edge_pair>,
                                                      std::span<const first_time>, int);
template std::vector<first_contact> contacts_of_queries(std::span<const vertex_edge<double>>,
                                                        std::span<const first_time>, int);
template std::vector<first_contact> contacts_of_pairs(const vertex_rows&,
                                                      std::span<const vertex_vertex_pair>,
                                                      std::span<const first_time>, int);
template std::vector<first_contact> contacts_of_queries(std::span<const vertex_vertex<double>>,
                                                        std::span<const first_time>, int);

}  // namespace ccd::detail
