// The data of one query from the numbers of nearness_filter::values. Internal.
#pragma once

#include <array>
#include <ccd/kind.hpp>
#include <ccd/nearness.hpp>

namespace ccd::detail {

/// The members of nearness_filter::values, in order.
using nearness_row = std::array<double, 12>;

/// Precondition: the region is not -1.
template <kind K>
nearness nearness_of_row(const nearness_row& row);

}  // namespace ccd::detail
