#include <ccd/nearness.hpp>
#include <stdexcept>
#include <string>

#include "ccd/batch/checks.hpp"
#include "ccd/batch/threads.hpp"
#include "ccd/contact/nearness/nearness.hpp"

namespace ccd::detail {

template <class Item>
std::vector<nearness> nearnesses_of_items(const batch_input<Item>& queries,
                                          const std::span<const first_time>* times,
                                          const nearness_options& options) {
    const std::string caller = "ccd::nearnesses";
    constexpr std::size_t block = 2048;  // queries between polls of options.stop
    batch_input<Item> input = queries;
    const std::size_t count = input.items.size();
    const bool at_start = times == nullptr && options.t == 0;
    if constexpr (any_pair<Item>) {
        if (at_start) input.positions.after = input.positions.before;
        check_pointers(caller.c_str(), input.positions);
        check_indices(caller.c_str(), input.items, 0, input.positions.vertices);
    }
    if (times == nullptr && !(options.t >= 0 && options.t <= 1))
        throw std::invalid_argument(caller + ": t is " + text_of(options.t) +
                                    "; expected a number in [0, 1]");
    if (times != nullptr && times->size() != count)
        throw std::invalid_argument(caller + ": number of times is " +
                                    std::to_string(times->size()) + "; expected " +
                                    std::to_string(count) + ", one for each query");
    std::vector<nearness> found(count);
    const auto find = [&](std::size_t i) {
        if constexpr (any_pair<Item>)
            if (at_start) return nearness_at_start(input.positions.before, input.items[i]);
        if (times == nullptr) return nearness_of(query_at(input, i), options.t);
        const first_time& time = (*times)[i];
        return time.outcome == outcome::collides ? nearness_of(query_at(input, i), time.low)
                                                 : nearness();
    };
    for_each_part(count, options.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if ((i - begin) % block == 0) stop_if_requested(options.stop);
            found[i] = find(i);
        }
    });
    return found;
}

using all = std::vector<nearness>;
using some_times = const std::span<const first_time>*;
using with = const nearness_options&;
template all nearnesses_of_items(const batch_input<vertex_face_pair>&, some_times, with);
template all nearnesses_of_items(const batch_input<edge_edge_pair>&, some_times, with);
template all nearnesses_of_items(const batch_input<vertex_edge_pair>&, some_times, with);
template all nearnesses_of_items(const batch_input<vertex_vertex_pair>&, some_times, with);
template all nearnesses_of_items(const batch_input<vertex_face<double>>&, some_times, with);
template all nearnesses_of_items(const batch_input<edge_edge<double>>&, some_times, with);
template all nearnesses_of_items(const batch_input<vertex_edge<double>>&, some_times, with);
template all nearnesses_of_items(const batch_input<vertex_vertex<double>>&, some_times, with);

}  // namespace ccd::detail
