// Positions in single precision, for the first cull of the batch kernels. Internal.
//
// All coordinates are mapped to about [−1, 1] by one translation per axis and one scale for all,
// and rounded to float: X̃ = fl((x − c)·s). Each of these operations preserves order though not
// strictly, so X̃ < Ỹ proves x < y. Sums of two coordinates have an absolute error: see `margin`.
#pragma once

#include <algorithm>
#include <ccd/batch.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace ccd {

class rounded_positions {
  public:
    /// Floats of a vertex: x y z at the start, a zero, x y z at the end of the step, a zero.
    static constexpr std::size_t row = 8;

    /// Two projections x ± y that differ by more than this, as computed in float, differ in exact
    /// arithmetic and have the same order. In units of ε = 2^-23, for sizes up to 1.01: a
    /// coordinate is off by 1.01ε (and far less, from double), a sum by that of its two and 2.02ε
    /// of its own, hence 4.04ε; a difference of two sums by 8.08ε and 4.04ε of its own: less than
    /// 13ε in all.
    static constexpr float margin = 13 * std::numeric_limits<float>::epsilon();

    /// Of finite positions. Cost: some 5 ns a vertex; memory: 32 bytes a vertex.
    explicit rounded_positions(const vertex_rows& rows) : floats_(row * rows.vertices) {
        double low[3], high[3];
        constexpr double infinity = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < 3; ++k) low[k] = infinity, high[k] = -infinity;
        for (const double* frame : {rows.before, rows.after})
            for (std::size_t v = 0; v < rows.vertices; ++v)
                for (std::size_t k = 0; k < 3; ++k) {  // six chains side by side
                    low[k] = std::min(low[k], frame[3 * v + k]);
                    high[k] = std::max(high[k], frame[3 * v + k]);
                }
        // Halved before they are added or subtracted, so that nothing overflows. The scale is at
        // most 2^1000, so that it is finite: of smaller scenes little or nothing is culled here.
        double half_extent = 0, middle[3];
        for (std::size_t k = 0; k < 3; ++k) {
            middle[k] = low[k] / 2 + high[k] / 2;
            half_extent = std::max(half_extent, high[k] / 2 - low[k] / 2);
        }
        const double scale = 1 / std::max(half_extent, 0x1p-1000);
        for (std::size_t v = 0; v < rows.vertices; ++v)
            for (std::size_t k = 0; k < 3; ++k) {
                floats_[row * v + k] = rounded(rows.before[3 * v + k], middle[k], scale);
                floats_[row * v + 4 + k] = rounded(rows.after[3 * v + k], middle[k], scale);
            }
    }

    const float* data() const { return floats_.data(); }

  private:
    static float rounded(double x, double middle, double scale) {
        return static_cast<float>((x - middle) * scale);
    }

    std::vector<float> floats_;
};

}  // namespace ccd
