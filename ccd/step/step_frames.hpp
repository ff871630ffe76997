// The two frames of a step as the broad phase sees them: swept boxes, exact and rounded.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/mesh.hpp>
#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "ccd/step/box_tree.hpp"

namespace ccd {

/// Maps an interval of finite numbers to about [-1, 1], preserving order though not strictly.
class unit_axis {
  public:
    unit_axis() = default;
    unit_axis(double low, double high) {
        // Halved before adding, and the inverse bounded: neither may overflow. A flat axis keeps
        // its unit (its radius is −0 where rounding is downward).
        middle_ = low / 2 + high / 2;
        const double radius = std::max(high - middle_, middle_ - low);
        if (radius > 0) scale_ = std::min(1 / radius, std::numeric_limits<double>::max());
    }
    double operator()(double x) const { return (x - middle_) * scale_; }

  private:
    double middle_ = 0, scale_ = 1;
};

class step_frames {
  public:
    /// Of two frames of one mesh with finite coordinates, which must outlive this.
    step_frames(const mesh& before, const mesh& after);

    /// The box that an element (1, 2 or 3 vertices) sweeps. In doubles it is exact. In floats each
    /// axis is mapped to about [-1, 1] and rounded, which preserves order though not strictly:
    /// boxes that touch still do, and boxes that touch without a common end did so before. Where
    /// ends coincide, ask touch().
    /// Proof: proofs/RoundedAxes.v, swept_face_separate, swept_edges_separate, swept_boxes_touch.
    template <class Real, std::size_t N>
    box<Real> swept_box(const std::array<index, N>& element) const {
        box<double> exact;
        exact.low = exact.high = coordinates(before_, element[0]);
        widen(exact, coordinates(after_, element[0]));
        for (std::size_t i = 1; i < N; ++i)
            for (const std::vector<point<double>>* frame : {&before_, &after_})
                widen(exact, coordinates(*frame, element[i]));
        if constexpr (std::is_same_v<Real, double>) {
            return exact;
        } else {
            box<float> rounded;
            for (std::size_t k = 0; k < 3; ++k) {
                rounded.low[k] = static_cast<float>(axes_[k](exact.low[k]));
                rounded.high[k] = static_cast<float>(axes_[k](exact.high[k]));
            }
            return rounded;
        }
    }

    /// Whether the closed exact boxes that two elements sweep touch.
    template <std::size_t A, std::size_t B>
    bool touch(const std::array<index, A>& a, const std::array<index, B>& b) const {
        const box<double> x = swept_box<double>(a), y = swept_box<double>(b);
        for (std::size_t k = 0; k < 3; ++k)
            if (x.low[k] > y.high[k] || y.low[k] > x.high[k]) return false;
        return true;
    }

    /// Whether floats would confuse the boxes: of a sample, more than one in sixteen have an axis
    /// on which only doubles tell their ends apart. So it is where small parts are very far apart.
    template <std::size_t N>
    bool need_doubles(std::span<const std::array<index, N>> elements) const;

    /// The elements, ordered along a Morton curve through the middles of their boxes. Cost:
    /// O(n log n) unless the middles are spread over very many orders of magnitude, each three of
    /// which cost one more sort of what is left; memory: 8 bytes an element beyond the result.
    template <class Real, std::size_t N>
    std::vector<std::array<index, N>> along_curve(
        std::span<const std::array<index, N>> elements) const;

  private:
    static std::array<double, 3> coordinates(const std::vector<point<double>>& frame, index v) {
        return {frame[v].x, frame[v].y, frame[v].z};
    }
    static void widen(box<double>& b, const std::array<double, 3>& x) {
        for (std::size_t k = 0; k < 3; ++k) {
            b.low[k] = std::min(b.low[k], x[k]);
            b.high[k] = std::max(b.high[k], x[k]);
        }
    }

    const std::vector<point<double>>&before_, &after_;
    std::array<unit_axis, 3> axes_;
};

}  // namespace ccd
