#include <ccd/contact.hpp>
#include <stdexcept>
#include <string>

#include "ccd/batch/checks.hpp"
#include "ccd/batch/threads.hpp"

namespace ccd::detail {
namespace {

/// Returns compute(query, given[i]) for each query. `name` is that of `given`, for messages.
template <class Item, class Given, class Compute>
auto for_each_item(const std::string& caller, const batch_input<Item>& queries,
                   const std::string& name, std::span<const Given> given, int threads,
                   const Compute& compute) {
    const auto& [items, positions] = queries;
    if constexpr (any_pair<Item>) {
        check_pointers(caller.c_str(), positions);
        check_indices(caller.c_str(), items, 0, positions.vertices);
    }
    if (items.size() != given.size())
        throw std::invalid_argument(caller + ": number of " + name + " is " +
                                    std::to_string(given.size()) + "; expected " +
                                    std::to_string(items.size()) + ", one for each query");
    std::vector<decltype(compute(query_at(queries, 0), given[0]))> found(items.size());
    for_each_index(items.size(), threads,
                   [&](std::size_t i) { found[i] = compute(query_at(queries, i), given[i]); });
    return found;
}

}  // namespace

template <class Item>
std::vector<first_contact> contacts_of_items(const batch_input<Item>& queries,
                                             std::span<const first_time> times, int threads) {
    return for_each_item(
        "ccd::first_contacts", queries, "times", times, threads,
        [](const auto& query, const first_time& time) { return contact_at(query, time); });
}

template <class Item>
std::vector<time_derivative> derivatives_of_items(const batch_input<Item>& queries,
                                                  std::span<const first_contact> contacts,
                                                  int threads) {
    return for_each_item("ccd::time_derivatives", queries, "contacts", contacts, threads,
                         [](const auto& query, const first_contact& contact) {
                             return derivative_of(query, contact);
                         });
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

using derivatives = std::vector<time_derivative>;
using found = std::span<const first_contact>;
template derivatives derivatives_of_items(const batch_input<vertex_face_pair>&, found, int);
template derivatives derivatives_of_items(const batch_input<edge_edge_pair>&, found, int);
template derivatives derivatives_of_items(const batch_input<vertex_edge_pair>&, found, int);
template derivatives derivatives_of_items(const batch_input<vertex_vertex_pair>&, found, int);
template derivatives derivatives_of_items(const batch_input<vertex_face<double>>&, found, int);
template derivatives derivatives_of_items(const batch_input<edge_edge<double>>&, found, int);
template derivatives derivatives_of_items(const batch_input<vertex_edge<double>>&, found, int);
template derivatives derivatives_of_items(const batch_input<vertex_vertex<double>>&, found, int);

}  // namespace ccd::detail
