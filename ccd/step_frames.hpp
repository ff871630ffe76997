// The two frames of a step as the broad phase sees them: swept boxes, exact and rounded.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/mesh.hpp>
#include <cstddef>
#include <span>
#include <vector>

#include "ccd/box_tree.hpp"

namespace ccd {

class step_frames {
  public:
    /// Of two frames of one mesh with finite coordinates, which must outlive this.
    step_frames(const mesh& before, const mesh& after);

    /// The box that an element (1, 2 or 3 vertices) sweeps, in floats.
    ///
    /// Each axis is mapped to about [-1, 1] by the same operations, each of which, the rounding to
    /// float included, preserves order though not strictly. Boxes that touch therefore still touch,
    /// and boxes that overlap here on every axis did so before: only where two ends coincide do
    /// the exact boxes have to be asked.
    template <std::size_t N>
    float_box rounded_box(const std::array<index, N>& element) const {
        const exact_box exact = swept_box(element);
        float_box b;
        for (std::size_t k = 0; k < 3; ++k) {
            b.low[k] = rounded(k, exact.low[k]);
            b.high[k] = rounded(k, exact.high[k]);
        }
        return b;
    }

    /// Whether the closed exact boxes that two elements sweep touch.
    template <std::size_t A, std::size_t B>
    bool touch(const std::array<index, A>& a, const std::array<index, B>& b) const {
        const exact_box x = swept_box(a), y = swept_box(b);
        for (std::size_t k = 0; k < 3; ++k)
            if (x.low[k] > y.high[k] || y.low[k] > x.high[k]) return false;
        return true;
    }

    /// The elements, ordered along a Morton curve through the middles of their boxes. Cost:
    /// O(n log n) unless the middles are spread over very many orders of magnitude, each three of
    /// which cost one more sort of what is left; memory: 8 bytes an element beyond the result.
    template <std::size_t N>
    std::vector<std::array<index, N>> along_curve(
        std::span<const std::array<index, N>> elements) const;

  private:
    struct exact_box {
        std::array<double, 3> low, high;
    };

    template <std::size_t N>
    exact_box swept_box(const std::array<index, N>& element) const {
        exact_box b;
        b.low = b.high = coordinates(before_, element[0]);
        widen(b, coordinates(after_, element[0]));
        for (std::size_t i = 1; i < N; ++i)
            for (const std::vector<point<double>>* frame : {&before_, &after_})
                widen(b, coordinates(*frame, element[i]));
        return b;
    }

    static std::array<double, 3> coordinates(const std::vector<point<double>>& frame, index v) {
        return {frame[v].x, frame[v].y, frame[v].z};
    }
    static void widen(exact_box& b, const std::array<double, 3>& x) {
        for (std::size_t k = 0; k < 3; ++k) {
            b.low[k] = std::min(b.low[k], x[k]);
            b.high[k] = std::max(b.high[k], x[k]);
        }
    }

    float rounded(std::size_t k, double x) const {
        return static_cast<float>((x - middle_[k]) * scale_[k]);
    }

    const std::vector<point<double>>&before_, &after_;
    std::array<double, 3> middle_{}, scale_{};
};

}  // namespace ccd
