#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <ccd/contact.hpp>
#include <ccd/nearness.hpp>
#include <ccd/step.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <tuple>
#include <vector>

#include "ccd/batch/threads.hpp"
#include "ccd/contact/nearness/nearness.hpp"
#include "ccd/step/elements.hpp"
#include "ccd/step/order/buckets.hpp"

namespace ccd {
namespace {

using detail::nearness_at_start;

vertex_rows at_rest(const vertex_rows& positions) {
    return {positions.before, positions.before, positions.vertices};
}

step_options options_of(const near_options& options, const pair_distances& within) {
    step_options search;
    search.threads = options.threads;
    search.stop = options.stop;
    search.filter = options.filter;
    search.distances = within;
    return search;
}

/// Calls visit(pair, data) for each candidate, from several threads at once.
template <class Visit>
void for_each_candidate(mesh_steps& mesh, const vertex_rows& positions,
                        const pair_distances& within, const near_options& options,
                        const Visit& visit) {
    candidate_visitor visitor;
    for_each_kind([&]<kind K>() {
        visitor.of<K>() = [&](std::span<const pair_of_kind<K>> block) {
            for (const auto& candidate : block) {
                const auto pair = detail::canonical(candidate);
                visit(pair, nearness_at_start(positions.before, pair));
            }
        };
    });
    mesh.for_each_candidate(positions, visitor, options_of(options, within));
}

/// True if the exact distance is at most d. The sum in doubles is off by half an ulp, and so is
/// each bound of the distance.
template <class Pair>
bool is_within(const vertex_rows& rows, const Pair& pair, const nearness& data,
               const separation& d) {
    constexpr double ulps = 4 * std::numeric_limits<double>::epsilon();
    const double sum = d.first + d.second, distance = data.distance;
    if (sum == 0) return data.touches();
    if (distance + data.distance_error < sum * (1 - ulps)) return true;
    if (distance - data.distance_error > sum * (1 + ulps)) return false;
    return decide_within(query_of(rows, pair), d).outcome == outcome::collides;
}

template <kind K>
struct found_pairs {
    std::vector<pair_of_kind<K>> pairs;
    std::vector<nearness> data;
};
template <kind K>
using found_by_threads = tbb::enumerable_thread_specific<found_pairs<K>>;

template <class Pair>
struct pair_with_data {
    Pair pair;
    const nearness* data;

    friend auto operator<=>(const pair_with_data& a, const pair_with_data& b) {
        return a.pair <=> b.pair;
    }
    friend bool operator==(const pair_with_data& a, const pair_with_data& b) {
        return a.pair == b.pair;
    }
};

template <kind K>
void take_sorted(const found_by_threads<K>& found, near_lists& into) {
    using item = pair_with_data<pair_of_kind<K>>;
    std::vector<const found_pairs<K>*> shares;
    vertex_index last = 0;
    for (const auto& share : found) {
        shares.push_back(&share);
        for (const auto& pair : share.pairs) last = std::max(last, vertices_of(pair)[0]);
    }
    if (shares.empty()) return;
    const std::vector<item> items = detail::sorted_by_vertex<item>(
        shares.size(), last,
        [&](std::size_t share, const auto& visit) {
            const auto& [pairs, data] = *shares[share];
            for (std::size_t i = 0; i < pairs.size(); ++i) visit(item{pairs[i], &data[i]});
        },
        [](const item& x) { return vertices_of(x.pair)[0]; });
    auto& pairs = into.pairs.of<K>();
    auto& data = into.data.of<K>();
    pairs.reserve(items.size());
    data.reserve(items.size());
    for (const item& x : items) {
        pairs.push_back(x.pair);
        data.push_back(*x.data);
    }
}

/// The largest extent of the positions along an axis, at most the largest double.
double extent_of(const vertex_rows& rows) {
    double most = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double low = nearness::unknown, high = -nearness::unknown;
        for (std::size_t v = 0; v < rows.vertices; ++v) {
            low = std::min(low, rows.before[3 * v + axis]);
            high = std::max(high, rows.before[3 * v + axis]);
        }
        if (low <= high) most = std::max(most, high - low);
    }
    return std::min(most, std::numeric_limits<double>::max());
}

/// True if a pair was found.
bool is_found(const least_distance_result& found) {
    return found.vertices[0] != found.vertices[1];
}
bool is_before(const least_distance_result& a, const least_distance_result& b) {
    return !is_found(b) || (is_found(a) && std::tuple(a.data.distance, a.kind, a.vertices) <
                                               std::tuple(b.data.distance, b.kind, b.vertices));
}

void keep_least(const least_distance_result& one, least_distance_result& least) {
    const double low = std::min(one.low, least.low);
    if (is_before(one, least)) least = one;
    least.low = low;
}

/// The bounds of one pair's distance, rounded outwards.
template <class Pair>
least_distance_result of_pair(const Pair& pair, const nearness& data) {
    constexpr double ulp = std::numeric_limits<double>::epsilon();
    least_distance_result one{.kind = kind_of<Pair>, .vertices = {}, .data = data};
    const double error = data.distance_error;
    const bool known = std::isfinite(error);
    one.low = known ? std::max(data.distance - error, 0.0) * (1 - ulp)
                    : std::numeric_limits<double>::max();
    one.high = known ? (data.distance + error) * (1 + ulp) : nearness::unknown;
    std::ranges::copy(vertices_of(pair), one.vertices.begin());
    return one;
}

/// The least distance of the pairs whose boxes, widened for `within`, touch.
least_distance_result least_of_candidates(mesh_steps& mesh, const vertex_rows& positions,
                                          double within, const near_options& options) {
    tbb::enumerable_thread_specific<least_distance_result> of_threads;
    for_each_candidate(mesh, positions, {.all = within}, options,
                       [&](const auto& pair, const nearness& data) {
                           least_distance_result& local = of_threads.local();
                           keep_least(of_pair(pair, data), local);
                       });
    least_distance_result least;
    for (const auto& one : of_threads) keep_least(one, least);
    return least;
}

}  // namespace

near_lists near_pairs(mesh_steps& mesh, const vertex_rows& positions, const pair_distances& within,
                      const near_options& options) {
    const vertex_rows rows = at_rest(positions);
    by_kind<found_by_threads> found;
    for_each_candidate(mesh, rows, within, options,
                       [&]<class Pair>(const Pair& pair, const nearness& data) {
                           if (!is_within(rows, pair, data, within.of(pair))) return;
                           auto& local = found.of<kind_of<Pair>>().local();
                           local.pairs.push_back(pair);
                           local.data.push_back(data);
                       });
    near_lists sorted;
    detail::on_threads(options.threads, [&] {
        for_each_kind([&]<kind K>() { take_sorted<K>(found.of<K>(), sorted); });
    });
    return sorted;
}
near_lists near_pairs(const mesh& mesh, const pair_distances& within, const near_options& options) {
    mesh_steps steps(mesh);
    return near_pairs(steps, vertex_rows(mesh, mesh), within, options);
}

least_distance_result least_distance(mesh_steps& mesh, const vertex_rows& positions,
                                     const near_options& options) {
    constexpr double largest = std::numeric_limits<double>::max();
    const vertex_rows rows = at_rest(positions);
    double within = 0;  // pairs whose boxes touch give an upper bound in most meshes
    for (;;) {
        const least_distance_result found = least_of_candidates(mesh, rows, within, options);
        if (found.high <= within || within == largest) return found;
        if (is_found(found)) {
            within = std::min(found.high, largest);
        } else {
            const double extent = extent_of(rows);
            if (!(within < extent)) return found;
            within = std::min(within == 0 ? extent * 0x1p-48 : 16 * within, largest);
        }
    }
}
least_distance_result least_distance(const mesh& mesh, const near_options& options) {
    mesh_steps steps(mesh);
    return least_distance(steps, vertex_rows(mesh, mesh), options);
}

}  // namespace ccd
