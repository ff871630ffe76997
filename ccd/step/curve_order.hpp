// The order of elements along a space-filling curve.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "ccd/step/swept_boxes.hpp"

namespace ccd::detail {

/// Orders elements along a Morton curve through the middles of their boxes. Cost: O(n log n) unless
/// the middles are spread over very many orders of magnitude, each three of which cost one more
/// sort of what is left; memory: 8 bytes an element and a copy of the elements.
template <class Real, std::size_t N>
void order_along_curve(std::vector<std::array<vertex_index, N>>& elements,
                       const swept_boxes& boxes);

}  // namespace ccd::detail
