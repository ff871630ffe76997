// Positions in single precision, for the first stage of the batch kernels. Internal.
#pragma once

#include <algorithm>
#include <ccd/batch.hpp>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "ccd/batch/rounded_axes.hpp"

namespace ccd::detail {

class rounded_positions {
  public:
    /// Floats of a vertex: x y z at the start, a zero, x y z at the end of the step, a zero.
    static constexpr std::size_t row = 8;

    rounded_positions() = default;
    explicit rounded_positions(const vertex_rows& rows) { round(rows); }

    /// Cost: some 5 ns a vertex; memory: 32 bytes a vertex. The floats are for a box around all
    /// positions, with this share of its size as room on each side. Precondition: positions are
    /// finite, also below.
    void round(const vertex_rows& rows, double room = 0) {
        extent_ = rounded_axes::extent::nothing();
        for (const double* frame : {rows.before, rows.after})
            for (std::size_t v = 0; v < rows.vertices; ++v)
                for (std::size_t k = 0; k < 3; ++k)  // six independent chains
                    extent_.widen(k, frame[3 * v + k]);
        if (room > 0) widen(room);
        frame_ = rounded_axes::frame(extent_);
        floats_.resize(row * rows.vertices);
        for (std::size_t v = 0; v < rows.vertices; ++v) set(rows, v);
    }
    /// Rounds the positions of these vertices in the same box. Returns false if they are not in it.
    bool round_again(const vertex_rows& rows, std::span<const vertex_index> vertices) {
        for (const vertex_index v : vertices) {
            for (const double* frame : {rows.before, rows.after})
                for (std::size_t k = 0; k < 3; ++k) {
                    const double x = frame[3 * std::size_t(v) + k];
                    if (x < extent_.low[k] || extent_.high[k] < x) return false;
                }
            set(rows, v);
        }
        return true;
    }

    const float* data() const { return floats_.data(); }
    double scale() const { return frame_.scale(); }

  private:
    void set(const vertex_rows& rows, std::size_t v) {
        for (std::size_t k = 0; k < 3; ++k) {
            floats_[row * v + k] = frame_(k, rows.before[3 * v + k]);
            floats_[row * v + 4 + k] = frame_(k, rows.after[3 * v + k]);
        }
    }
    void widen(double room) {
        constexpr double most = std::numeric_limits<double>::max();
        for (std::size_t k = 0; k < 3; ++k) {
            const double by = room * (extent_.high[k] / 2 - extent_.low[k] / 2);
            extent_.low[k] = std::max(extent_.low[k] - by, -most);
            extent_.high[k] = std::min(extent_.high[k] + by, most);
        }
    }

    std::vector<float> floats_;
    rounded_axes::extent extent_ = rounded_axes::extent::nothing();
    rounded_axes::frame frame_;
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
