#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "ccd/batch/first_touch.hpp"
#include "ccd/step/swept_boxes.hpp"

namespace ccd::detail {

/// Maps a finite interval to about [-1, 1]. Monotone, but not strictly.
class unit_axis {
  public:
    unit_axis() = default;
    unit_axis(double low, double high);
    double operator()(double x) const { return (x - middle_) * scale_; }

  private:
    double middle_ = 0, scale_ = 1;
};

/// Orders vertices along a Hilbert curve through the middles of their swept boxes, and elements by
/// their first vertex on it.
class vertex_order {
  public:
    /// Orders all `vertices`, unless that was done since forget(). Cells suit the lengths of
    /// `elements`, a sample. Cost: O(n log n), plus one more sort of the rest for each three orders
    /// of magnitude of very uneven spreads. Memory: 16 bytes a vertex, of which it keeps 4.
    template <class Real, std::size_t N>
    void find(const swept_boxes& boxes, std::size_t vertices,
              std::span<const std::array<vertex_index, N>> elements);
    /// Call after vertices have moved.
    void forget() { known_ = known::nothing; }

    /// Sorts elements. Elements that are long compared with the whole come last, each class along a
    /// separate curve. Cost: O(n). Memory: 16 bytes an element and a copy of the elements.
    template <class Real, std::size_t N>
    void sort(std::vector<std::array<vertex_index, N>>& elements, const swept_boxes& boxes) const;

  private:
    enum class known { nothing, by_floats, by_doubles };

    known known_ = known::nothing;
    std::array<unit_axis, 3> axes_;  ///< of the middles
    first_touch_vector<vertex_index> place_;
};

}  // namespace ccd::detail
