#pragma once

#include <cstddef>
#include <cstdint>

#include "ccd/exact/simd.hpp"

namespace ccd::detail::ERRBOUND_INSTRUCTION_SET {
namespace {

typedef float float_quad __attribute__((vector_size(16)));

template <int... Places>
float_quad chosen(const float_quad& a, const float_quad& b) {
#if defined __clang__ || __GNUC__ >= 12
    return __builtin_shufflevector(a, b, Places...);
#else
    typedef std::int32_t places __attribute__((vector_size(16)));
    return __builtin_shuffle(a, b, places{Places...});
#endif
}

/// Four rows of rounded_positions at one end of the step, axis by axis.
struct row_quads {
    float_quad axis[3];

    row_quads(const float* const (&rows)[4], std::size_t end) {
        float_quad r[4];
        for (std::size_t i = 0; i < 4; ++i)
            __builtin_memcpy(&r[i], rows[i] + 4 * end, sizeof(r[i]));
        const float_quad xy0 = chosen<0, 4, 1, 5>(r[0], r[2]);
        const float_quad xy1 = chosen<0, 4, 1, 5>(r[1], r[3]);
        const float_quad z0 = chosen<2, 6, 3, 7>(r[0], r[2]);
        const float_quad z1 = chosen<2, 6, 3, 7>(r[1], r[3]);
        axis[0] = chosen<0, 4, 1, 5>(xy0, xy1);
        axis[1] = chosen<2, 6, 3, 7>(xy0, xy1);
        axis[2] = chosen<0, 4, 1, 5>(z0, z1);
    }
};

}  // namespace
}  // namespace ccd::detail::ERRBOUND_INSTRUCTION_SET
