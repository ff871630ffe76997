// The order of vertices along a space-filling curve, and of elements by their vertices.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "ccd/batch/first_touch.hpp"
#include "ccd/step/swept_boxes.hpp"

namespace ccd::detail {

/// Maps an interval of finite numbers to about [-1, 1], preserving order though not strictly.
class unit_axis {
  public:
    unit_axis() = default;
    unit_axis(double low, double high);
    double operator()(double x) const { return (x - middle_) * scale_; }

  private:
    double middle_ = 0, scale_ = 1;
};

/// A mesh's vertices along a Hilbert curve through the middles of what they sweep. Elements follow
/// the first of their vertices on it, so that neighbours are near each other.
class vertex_order {
  public:
    /// Of all `vertices`; `elements` are some that will be ordered: where they are long, cells of
    /// the curve are. Nothing is done if it was found since forget(). Cost: O(n log n) unless the
    /// middles are spread over very many orders of magnitude, each three of which cost one more
    /// sort of what is left; memory: 16 bytes a vertex, of which it keeps 4.
    template <class Real, std::size_t N>
    void find(const swept_boxes& boxes, std::size_t vertices,
              std::span<const std::array<vertex_index, N>> elements);
    /// The vertices have moved.
    void forget() { known_ = known::nothing; }

    /// Sorts elements of the vertices. Those that are long beside the whole come after all others,
    /// each class along a curve of its own. Cost: O(n); memory: 16 bytes an element and a copy of
    /// the elements.
    template <class Real, std::size_t N>
    void sort(std::vector<std::array<vertex_index, N>>& elements, const swept_boxes& boxes) const;

  private:
    enum class known { nothing, by_floats, by_doubles };

    known known_ = known::nothing;
    std::array<unit_axis, 3> axes_;  ///< of the middles
    first_touch_vector<vertex_index> place_;
};

}  // namespace ccd::detail
