// Directions of any length. Internal.
#pragma once

#include <algorithm>
#include <ccd/query.hpp>
#include <cmath>

namespace ccd::detail {

/// The same direction with its largest coordinate in [1, 2), so that its length neither overflows
/// nor underflows.
inline point<double> scaled_direction(const point<double>& d) {
    const double most = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
    if (!(most > 0 && std::isfinite(most))) return d;
    const int shift = -std::ilogb(most);
    return {std::scalbn(d.x, shift), std::scalbn(d.y, shift), std::scalbn(d.z, shift)};
}

}  // namespace ccd::detail
