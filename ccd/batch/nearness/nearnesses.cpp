#include <algorithm>
#include <ccd/nearness.hpp>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "ccd/batch/batch_worker.hpp"
#include "ccd/batch/checks.hpp"
#include "ccd/batch/nearness/kernels.hpp"
#include "ccd/batch/threads.hpp"
#include "ccd/contact/nearness/nearness.hpp"

namespace ccd::detail {

const nearness_kernels& nearness_kernels_for(std::optional<instruction_set> set) {
    switch (runnable(set)) {
#ifdef ERRBOUND_HAVE_X86_KERNELS
        case instruction_set::avx512:
            return avx512::nearest;
        case instruction_set::avx2:
            return avx2::nearest;
#endif
        default:
            return baseline::nearest;
    }
}

namespace {

/// Pairs at the start, a block at a time.
template <class Pair>
void find_at_start(const nearness_kernels& kernels, const vertex_rows& rows,
                   std::span<const Pair> pairs, nearness* found) {
    constexpr kind K = kind_of<Pair>;
    nearness_columns columns;
    for (std::size_t first = 0; first < pairs.size(); first += columns.capacity) {
        const auto block = pairs.subspan(first, std::min(columns.capacity, pairs.size() - first));
        kernels.of<K>().data(rows.before, block.data(), block.size(), columns);
        for (std::size_t i = 0; i < block.size(); ++i) {
            nearness_row row;
            for (std::size_t c = 0; c < row.size(); ++c) row[c] = columns.at[c][i];
            found[first + i] =
                row[0] >= 0 ? nearness_of_row<K>(row) : nearness_of(query_of(rows, block[i]));
        }
    }
}

}  // namespace

template <class Item>
std::vector<nearness> nearnesses_of_items(const batch_input<Item>& queries,
                                          const std::span<const first_time>* times,
                                          const nearness_options& options) {
    const std::string caller = "ccd::nearnesses";
    const nearness_kernels& kernels = nearness_kernels_for(options.set);
    batch_input<Item> input = queries;
    const std::size_t count = input.items.size();
    const bool pairs_at_start = any_pair<Item> && times == nullptr && options.t == 0;
    if constexpr (any_pair<Item>) {
        if (pairs_at_start) input.positions.after = input.positions.before;
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
    const auto find = [&](std::size_t i) {
        if (times == nullptr) return nearness_of(query_at(input, i), options.t);
        const first_time& time = (*times)[i];
        return time.outcome == outcome::collides ? nearness_of(query_at(input, i), time.low)
                                                 : nearness();
    };
    std::vector<nearness> found(count);
    for_each_part(count, options.threads, [&](std::size_t begin, std::size_t end) {
        constexpr std::size_t size = 2048;  // queries between two calls of options.stop
        for (std::size_t first = begin, last; first < end; first = last) {
            stop_if_requested(options.stop);
            last = std::min(first + size, end);
            if constexpr (any_pair<Item>) {
                if (pairs_at_start) {
                    find_at_start(kernels, input.positions,
                                  input.items.subspan(first, last - first), &found[first]);
                    continue;
                }
            }
            for (std::size_t i = first; i < last; ++i) found[i] = find(i);
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
