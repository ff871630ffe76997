#include "ccd/step/order/hilbert_curve.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "ccd/step/elements.hpp"

namespace {

using ccd::detail::hilbert_position;
using ccd::detail::spread_bits;

// The curve visits all cells of a cube once, each next to the one before.
TEST(HilbertCurve, GoesFromNeighbourToNeighbour) {
    for (const unsigned bits : {1U, 2U, 5U}) {
        const std::uint64_t n = std::uint64_t(1) << bits;
        std::vector<std::array<int, 3>> cells(n * n * n, {-1, -1, -1});
        for (std::uint64_t x = 0; x < n; ++x)
            for (std::uint64_t y = 0; y < n; ++y)
                for (std::uint64_t z = 0; z < n; ++z) {
                    const auto morton = spread_bits(x) | spread_bits(y) << 1 | spread_bits(z) << 2;
                    auto& cell = cells.at(hilbert_position(morton, bits));
                    ASSERT_EQ(cell[0], -1);
                    cell = {static_cast<int>(x), static_cast<int>(y), static_cast<int>(z)};
                }
        for (std::size_t i = 1; i < cells.size(); ++i) {
            int steps = 0;
            for (std::size_t k = 0; k < 3; ++k) steps += std::abs(cells[i][k] - cells[i - 1][k]);
            ASSERT_EQ(steps, 1) << bits << " bits, cell " << i;
        }
    }
}

}  // namespace
