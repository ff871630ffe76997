// Rows of rounded positions, transposed four at a time. Internal; for kernels.
#pragma once

#include <cstddef>

#include "ccd/exact/simd.hpp"

namespace ccd::detail::ERRBOUND_INSTRUCTION_SET {
namespace {

typedef float float_quad __attribute__((vector_size(16)));

/// Of four rows of rounded_positions, the coordinates at one end of the step: axis by axis.
struct row_quads {
    float_quad axis[3];

    row_quads(const float* const (&rows)[4], std::size_t end) {
        float_quad r[4];
        for (std::size_t i = 0; i < 4; ++i)
            __builtin_memcpy(&r[i], rows[i] + 4 * end, sizeof(r[i]));
        const float_quad xy0 = __builtin_shufflevector(r[0], r[2], 0, 4, 1, 5);
        const float_quad xy1 = __builtin_shufflevector(r[1], r[3], 0, 4, 1, 5);
        const float_quad z0 = __builtin_shufflevector(r[0], r[2], 2, 6, 3, 7);
        const float_quad z1 = __builtin_shufflevector(r[1], r[3], 2, 6, 3, 7);
        axis[0] = __builtin_shufflevector(xy0, xy1, 0, 4, 1, 5);
        axis[1] = __builtin_shufflevector(xy0, xy1, 2, 6, 3, 7);
        axis[2] = __builtin_shufflevector(z0, z1, 0, 4, 1, 5);
    }
};

}  // namespace
}  // namespace ccd::detail::ERRBOUND_INSTRUCTION_SET
