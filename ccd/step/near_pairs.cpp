#include <algorithm>
#include <array>
#include <ccd/contact.hpp>
#include <ccd/nearness.hpp>
#include <ccd/step.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "ccd/batch/nearness/kernels.hpp"
#include "ccd/batch/threads.hpp"
#include "ccd/step/elements.hpp"
#include "ccd/step/narrow_phase.hpp"

namespace ccd {
namespace {

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

/// A distance and its error.
struct estimate {
    double distance, error;
};

/// Calls visit(pair, estimate) for each candidate in its reported form, from several threads at
/// once.
template <class Visit>
void for_each_candidate(mesh_steps& mesh, const vertex_rows& rows, const pair_distances& within,
                        const near_options& options, const Visit& visit) {
    const detail::nearness_kernels& kernels = detail::nearness_kernels_for(options.set);
    candidate_visitor visitor;
    for_each_kind([&]<kind K>() {
        visitor.of<K>() = [&](std::span<const pair_of_kind<K>> candidates) {
            detail::nearness_columns columns;
            std::array<pair_of_kind<K>, columns.capacity> pairs;
            for (; !candidates.empty();) {
                const std::size_t count = std::min(pairs.size(), candidates.size());
                std::ranges::transform(candidates.first(count), pairs.begin(),
                                       detail::canonical<pair_of_kind<K>>);
                candidates = candidates.subspan(count);
                kernels.of<K>().distances(rows.before, pairs.data(), count, columns);
                for (std::size_t i = 0; i < count; ++i) {
                    if (columns.at[0][i] >= 0) {
                        visit(pairs[i], estimate{columns.at[6][i], columns.at[7][i]});
                    } else {
                        const nearness data = nearness_of(query_of(rows, pairs[i]));
                        visit(pairs[i], estimate{data.distance, data.distance_error});
                    }
                }
            }
        };
    });
    mesh.for_each_candidate(rows, visitor, options_of(options, within));
}

/// True if the exact distance is at most d. The sum in doubles is off by half an ulp, and so is
/// each bound of the distance.
template <class Pair>
bool is_within(const vertex_rows& rows, const Pair& pair, const estimate& found,
               const separation& d) {
    constexpr double ulps = 4 * std::numeric_limits<double>::epsilon();
    const double sum = d.first + d.second;
    if (found.distance + found.error < sum * (1 - ulps)) return true;
    if (found.distance - found.error > sum * (1 + ulps)) return false;
    return decide_within(query_of(rows, pair), d).outcome == outcome::collides;
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

/// The nearest of some pairs, and bounds of the least distance.
struct nearest_pair {
    double low = nearness::unknown, high = nearness::unknown;
    double distance = nearness::unknown;
    kind of = kind::vertex_face;
    std::array<vertex_index, 4> vertices{};

    nearest_pair() = default;
    /// One pair; bounds are rounded outwards.
    template <class Pair>
    nearest_pair(const Pair& pair, const estimate& found)
        : distance(found.distance), of(kind_of<Pair>) {
        constexpr double ulp = std::numeric_limits<double>::epsilon();
        if (std::isfinite(found.error)) {
            low = std::max(distance - found.error, 0.0) * (1 - ulp);
            high = (distance + found.error) * (1 + ulp);
        } else {
            low = std::numeric_limits<double>::max();
        }
        std::ranges::copy(vertices_of(pair), vertices.begin());
    }

    bool exists() const { return vertices[0] != vertices[1]; }
    void add(const nearest_pair& other) {
        const double least = std::min(low, other.low);
        if (other.exists() && (!exists() || std::tuple(other.distance, other.of, other.vertices) <
                                                std::tuple(distance, of, vertices)))
            *this = other;
        low = least;
    }
};

/// The nearest of the pairs whose boxes, widened for `within`, touch.
nearest_pair nearest_candidate(mesh_steps& mesh, const vertex_rows& rows, double within,
                               const near_options& options) {
    detail::per_thread<nearest_pair> of_threads;
    for_each_candidate(mesh, rows, {.all = within}, options,
                       [&](const auto& pair, const estimate& found) {
                           nearest_pair& local = of_threads.local();
                           if (!(found.distance - found.error > local.distance))
                               local.add({pair, found});
                       });
    nearest_pair nearest;
    for (const nearest_pair* one : of_threads.all()) nearest.add(*one);
    return nearest;
}

/// The nearest pair of the mesh, by searches within growing distances.
nearest_pair nearest_of_all(mesh_steps& mesh, const vertex_rows& rows,
                            const near_options& options) {
    constexpr double largest = std::numeric_limits<double>::max();
    double within = 0;  // in most meshes, pairs whose boxes touch give an upper bound
    for (;;) {
        const nearest_pair found = nearest_candidate(mesh, rows, within, options);
        if (found.high <= within || within == largest) return found;
        if (found.exists()) {
            within = std::min(found.high, largest);
        } else {
            const double extent = extent_of(rows);
            if (!(within < extent)) return found;
            const double next = within == 0 ? extent * 0x1p-48 : 16 * within;
            within = std::clamp(next, std::numeric_limits<double>::denorm_min(), largest);
        }
    }
}

}  // namespace

near_lists near_pairs(mesh_steps& mesh, const vertex_rows& positions, const pair_distances& within,
                      const near_options& options) {
    const vertex_rows rows = at_rest(positions);
    by_kind<detail::lists_of_threads> found;
    for_each_candidate(mesh, rows, within, options,
                       [&]<class Pair>(const Pair& pair, const estimate& distance) {
                           if (is_within(rows, pair, distance, within.of(pair)))
                               found.of<kind_of<Pair>>().local().pairs.push_back(pair);
                       });
    near_lists near;
    detail::on_threads(options.threads, [&] {
        for_each_kind([&]<kind K>() {
            near.pairs.of<K>() = detail::take_sorted<pair_of_kind<K>>(found.of<K>());
        });
    });
    const nearness_options of_data{
        .threads = options.threads, .set = options.set, .stop = options.stop};
    for_each_kind(
        [&]<kind K>() { near.data.of<K>() = nearnesses(rows, near.pairs.of<K>(), of_data); });
    return near;
}
near_lists near_pairs(const mesh& mesh, const pair_distances& within, const near_options& options) {
    mesh_steps steps(mesh);
    return near_pairs(steps, vertex_rows(mesh, mesh), within, options);
}

least_distance_result least_distance(mesh_steps& mesh, const vertex_rows& positions,
                                     const near_options& options) {
    const vertex_rows rows = at_rest(positions);
    const nearest_pair nearest = nearest_of_all(mesh, rows, options);
    if (!(nearest.high < nearness::unknown)) return {};
    least_distance_result result{nearest.low, nearest.high, nearest.of, nearest.vertices, {}};
    visit_kind(nearest.of, [&]<kind K>() {
        const auto& v = nearest.vertices;
        const pair_of_kind<K> pair = [&]<std::size_t... I>(std::index_sequence<I...>) {
            return pair_of_kind<K>{v[I]...};
        }
        (std::make_index_sequence<sizeof(pair_of_kind<K>) / sizeof(vertex_index)>());
        result.data = nearness_of(query_of(rows, pair));
    });
    return result;
}
least_distance_result least_distance(const mesh& mesh, const near_options& options) {
    mesh_steps steps(mesh);
    return least_distance(steps, vertex_rows(mesh, mesh), options);
}

}  // namespace ccd
