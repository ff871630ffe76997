// Statistics of a report.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace ccd::report {

/// The least of the sorted numbers that at least a share `p` of all do not exceed (the nearest
/// rank: always one of the numbers). NaN if there are none.
inline double quantile(std::span<const double> sorted, double p) {
    if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
    const double rank = std::ceil(p * static_cast<double>(sorted.size()));
    const auto last = static_cast<double>(sorted.size());
    return sorted[static_cast<std::size_t>(std::clamp(rank, 1.0, last)) - 1];
}

/// `count` out of `of`, per million; 0 if there are none.
inline double per_million(std::size_t count, std::size_t of) {
    return of == 0 ? 0 : 1e6 * static_cast<double>(count) / static_cast<double>(of);
}

}  // namespace ccd::report
