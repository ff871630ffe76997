#include <ccd/contact.hpp>
#include <stdexcept>
#include <string>

#include "ccd/batch/checks.hpp"
#include "ccd/batch/threads.hpp"

namespace ccd::detail {

template <class Item>
std::vector<first_contact> contacts_of_items(const batch_input<Item>& queries,
                                             std::span<const first_time> times, int threads) {
    const std::string caller = "ccd::first_contacts";
    const auto& [items, positions] = queries;
    if constexpr (any_pair<Item>) {
        check_pointers(caller.c_str(), positions);
        check_indices(caller.c_str(), items, 0, positions.vertices);
    }
    if (items.size() != times.size())
        throw std::invalid_argument(caller + ": number of times is " +
                                    std::to_string(times.size()) + "; expected " +
                                    std::to_string(items.size()) + ", one for each query");
    std::vector<first_contact> found(items.size());
    for_each_index(items.size(), threads,
                   [&](std::size_t i) { found[i] = contact_at(query_at(queries, i), times[i]); });
    return found;
}

using contacts = std::vector<first_contact>;
using times = std::span<const first_time>;
template contacts contacts_of_items(const batch_input<vertex_face_pair>&, times, int);
template contacts contacts_of_items(const batch_input<edge_edge_pair>&, times, int);
template contacts contacts_of_items(const batch_input<vertex_edge_pair>&, times, int);
template contacts contacts_of_items(const batch_input<vertex_vertex_pair>&, times, int);
template contacts contacts_of_items(const batch_input<vertex_face<double>>&, times, int);
template contacts contacts_of_items(const batch_input<edge_edge<double>>&, times, int);
template contacts contacts_of_items(const batch_input<vertex_edge<double>>&, times, int);
template contacts contacts_of_items(const batch_input<vertex_vertex<double>>&, times, int);

}  // namespace ccd::detail
