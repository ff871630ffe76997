// Kernels for nearness: see ccd/batch/batch_kernels.hpp for the rules of this file.
#include "ccd/batch/nearness/kernels.hpp"

#include "ccd/contact/nearness/in_doubles.hpp"

namespace ccd::detail::ERRBOUND_INSTRUCTION_SET {
namespace {

constexpr std::size_t capacity = nearness_columns::capacity;
static_assert(capacity % width == 0);

/// Coordinates of pairs, by vertex and axis. The last pair fills its pack.
template <std::size_t N>
struct vertex_columns {
    alignas(64) double at[N][3][capacity];

    vertex_columns(const double* positions, const void* pairs, std::size_t count) {
        for (std::size_t i = 0; i < capacity && (i < count || i % width != 0); ++i) {
            vertex_index pair[N];
            const std::size_t from = i < count ? i : count - 1;
            __builtin_memcpy(pair, static_cast<const char*>(pairs) + from * sizeof pair,
                             sizeof pair);
            for (std::size_t v = 0; v < N; ++v)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    at[v][axis][i] = positions[3 * std::size_t(pair[v]) + axis];
        }
    }
};

template <kind K, bool WithData>
[[gnu::flatten]] void find(const double* positions, const pair_of_kind<K>* pairs, std::size_t count,
                           nearness_columns& into) {
    constexpr std::size_t n = sizeof(pair_of_kind<K>) / sizeof(vertex_index);
    if (count == 0) return;
    const vertex_columns<n> x(positions, pairs, count);
    for (std::size_t i = 0; i < count; i += width) {
        nearness_filter::resting_points<pack, n> points;
        for (std::size_t v = 0; v < n; ++v)
            points.at[v] = {pack::load_aligned(&x.at[v][0][i]), pack::load_aligned(&x.at[v][1][i]),
                            pack::load_aligned(&x.at[v][2][i])};
        const auto found = nearness_filter::values_of<K, pack>(points);
        const auto put = [&](std::size_t column, const pack& value) {
            value.store_aligned(&into.at[column][i]);
        };
        put(0, found.region);
        put(6, found.distance);
        put(7, found.distance_error);
        if constexpr (WithData) {
            put(1, found.first);
            put(2, found.second);
            put(3, found.weight_error);
            put(4, found.square);
            put(5, found.square_error);
            put(8, found.normal.x);
            put(9, found.normal.y);
            put(10, found.normal.z);
            put(11, found.normal_error);
        }
    }
}

template <kind K>
constexpr nearness_kernels_of<K> kernels_of{find<K, true>, find<K, false>};

}  // namespace

constinit const nearness_kernels nearest = {
    kernels_of<kind::vertex_face>, kernels_of<kind::edge_edge>, kernels_of<kind::vertex_edge>,
    kernels_of<kind::vertex_vertex>};

}  // namespace ccd::detail::ERRBOUND_INSTRUCTION_SET
