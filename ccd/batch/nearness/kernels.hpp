// Nearness of many pairs at rest over SIMD packs. Internal; compiled by the rules of
// ccd/batch/batch_kernels.hpp.
#pragma once

#include <ccd/batch.hpp>
#include <ccd/kind.hpp>
#include <cstddef>
#include <optional>

namespace ccd::detail {

/// A column for each number of nearness_filter::values: region, two weights, weight error, square,
/// its error, distance, its error, normal, its error.
struct nearness_columns {
    static constexpr std::size_t capacity = 64, columns = 12;
    alignas(64) double at[columns][capacity];
};

template <kind K>
struct nearness_kernels_of {
    using pair = pair_of_kind<K>;

    /// Sets one row for each of `count` pairs, at most the capacity. Region -1 leaves a pair to
    /// exact arithmetic.
    void (*data)(const double* positions, const pair* pairs, std::size_t count,
                 nearness_columns& into);
    /// Sets only the columns of the region and the distance with its error.
    void (*distances)(const double* positions, const pair* pairs, std::size_t count,
                      nearness_columns& into);
};
using nearness_kernels = by_kind<nearness_kernels_of>;

const nearness_kernels& nearness_kernels_for(std::optional<instruction_set> set);

namespace baseline {
extern const nearness_kernels nearest;
}
namespace avx2 {
extern const nearness_kernels nearest;
}
namespace avx512 {
extern const nearness_kernels nearest;
}

}  // namespace ccd::detail
