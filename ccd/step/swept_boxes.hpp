// The two frames of a step as the search for candidates sees them: swept boxes, exact and rounded.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/batch.hpp>
#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>

#include "ccd/step/box_tree.hpp"

namespace ccd::detail {

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

/// The sampling stride of `count` to take for a sample of about a thousand.
constexpr std::size_t sampling_stride(std::size_t count) {
    return 1 + count / 1024;
}

class swept_boxes {
  public:
    /// Of finite positions, whose memory must outlive this.
    explicit swept_boxes(const vertex_rows& positions) : positions_(positions) {
        if (positions.vertices == 0) return;
        const box<double> all = hull_of_all();
        for (std::size_t k = 0; k < 3; ++k) axes_[k] = unit_axis(all.low[k], all.high[k]);
    }

    /// The box that an element (1, 2 or 3 vertices) sweeps. In doubles it is exact. In floats each
    /// axis is mapped to about [-1, 1] and rounded, which preserves order though not strictly:
    /// boxes that touch still do, and boxes that touch without a common end did so before. Where
    /// ends coincide, ask touch().
    /// Proof: proofs/RoundedAxes.v, swept_face_separate, swept_edges_separate, swept_boxes_touch.
    template <class Real, std::size_t N>
    box<Real> swept_box(const std::array<index, N>& element) const {
        box<double> exact = box_of(positions_.before, element[0]);
        widen(exact, positions_.after, element[0]);
        for (std::size_t i = 1; i < N; ++i)
            for (const double* frame : {positions_.before, positions_.after})
                widen(exact, frame, element[i]);
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
    bool need_doubles(std::span<const std::array<index, N>> elements) const {
        std::size_t confused = 0, samples = 0;
        for (std::size_t i = 0; i < elements.size();
             i += sampling_stride(elements.size()), ++samples) {
            const box<double> exact = swept_box<double>(elements[i]);
            const box<float> rounded = swept_box<float>(elements[i]);
            bool merged = false;
            for (std::size_t k = 0; k < 3; ++k)
                merged |= exact.low[k] != exact.high[k] && rounded.low[k] == rounded.high[k];
            confused += merged;
        }
        return confused > samples / 16;
    }

  private:
    static box<double> box_of(const double* frame, index v) {
        const double* row = frame + 3 * std::size_t(v);
        return {{row[0], row[1], row[2]}, {row[0], row[1], row[2]}};
    }
    static void widen(box<double>& b, const double* frame, index v) {
        const double* row = frame + 3 * std::size_t(v);
        for (std::size_t k = 0; k < 3; ++k) {
            b.low[k] = std::min(b.low[k], row[k]);
            b.high[k] = std::max(b.high[k], row[k]);
        }
    }
    box<double> hull_of_all() const {
        box<double> all = box_of(positions_.before, 0);
        for (const double* frame : {positions_.before, positions_.after})
            for (std::size_t v = 0; v < positions_.vertices; ++v)
                widen(all, frame, static_cast<index>(v));
        return all;
    }

    vertex_rows positions_;
    std::array<unit_axis, 3> axes_;
};

}  // namespace ccd::detail
