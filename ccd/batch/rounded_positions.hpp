// Positions in single precision, for the first stage of the batch kernels. Internal.
#pragma once

#include <ccd/batch.hpp>
#include <cstddef>
#include <vector>

#include "ccd/batch/rounded_axes.hpp"

namespace ccd::detail {

class rounded_positions {
  public:
    /// Floats of a vertex: x y z at the start, a zero, x y z at the end of the step, a zero.
    static constexpr std::size_t row = 8;

    /// Precondition: positions are finite. Cost: some 5 ns a vertex; memory: 32 bytes a vertex.
    explicit rounded_positions(const vertex_rows& rows) : floats_(row * rows.vertices) {
        rounded_axes::extent extent = rounded_axes::extent::nothing();
        for (const double* frame : {rows.before, rows.after})
            for (std::size_t v = 0; v < rows.vertices; ++v)
                for (std::size_t k = 0; k < 3; ++k)  // six independent chains
                    extent.widen(k, frame[3 * v + k]);
        const rounded_axes::frame rounded(extent);
        scale_ = rounded.scale();
        for (std::size_t v = 0; v < rows.vertices; ++v)
            for (std::size_t k = 0; k < 3; ++k) {
                floats_[row * v + k] = rounded(k, rows.before[3 * v + k]);
                floats_[row * v + 4 + k] = rounded(k, rows.after[3 * v + k]);
            }
    }

    const float* data() const { return floats_.data(); }
    double scale() const { return scale_; }

  private:
    std::vector<float> floats_;
    double scale_;
};

/// Positions, and their rounded values if available.
struct batch_positions {
    vertex_rows exact;
    const float* rounded = nullptr;  ///< rounded_positions::data(), or null
    double scale = 0;                ///< of `rounded`

    explicit batch_positions(const vertex_rows& rows) : exact(rows) {}
    batch_positions(const vertex_rows& rows, const rounded_positions& floats)
        : exact(rows), rounded(floats.data()), scale(floats.scale()) {}
};

}  // namespace ccd::detail
