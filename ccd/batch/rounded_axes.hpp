// Separating axes in single precision. Internal; host, SIMD and device code share it.
//
// A translation per axis and one scale map coordinates to about [−1, 1] in float: X̃ = (x −
// c)·s, rounded after each operation. Each operation is monotone, so X̃ < Ỹ proves x < y. `margin`
// covers the errors of sums. Proof: proofs/filters/RoundedAxes.v, rounded_monotone,
// rounded_face_separate, rounded_edges_separate.
#pragma once

#include <algorithm>
#include <ccd/kind.hpp>
#include <cstddef>
#include <limits>

#include "ccd/exact/static_filter/difference_extents.hpp"

namespace ccd::detail::rounded_axes {

/// If two projections x ± y, computed in float, differ by more than this, their order is exact.
/// With ε = 2^-23 and sizes up to 1.01, a coordinate has an error of at most 1.01ε. A sum has 2.02ε
/// from its coordinates and 2.02ε from its own rounding, hence 4.04ε. A difference of two sums has
/// 8.08ε from them and 4.04ε from its own rounding, less than 13ε in all.
inline constexpr float margin = 13 * std::numeric_limits<float>::epsilon();

/// Bounds that a computed gap must exceed: `along` a coordinate axis, and `across` two, on x ± y.
/// The default proves separation.
struct least_gaps {
    float along = 0, across = margin;
};
/// Gaps that prove more than `distance`, which is in units of the floats. They are rounded up by
/// more than all rounding errors. The axis x ± y has length √2. Errors of single coordinates are
/// less than those of sums.
constexpr least_gaps gaps_beyond(double distance) {
    return {static_cast<float>(1.000001 * distance + 1.01 * double(margin)),
            static_cast<float>(1.414215 * distance + 1.01 * double(margin))};
}

/// The box around all positions of both frames. NaN coordinates do not widen it.
struct extent {
    double low[3], high[3];

    static constexpr extent nothing() {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        return {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    }
    constexpr void widen(std::size_t axis, double x) {
        low[axis] = std::min(low[axis], x);
        high[axis] = std::max(high[axis], x);
    }
};

class frame {
  public:
    frame() = default;
    explicit constexpr frame(const extent& e) {
        // Coordinates are halved before the addition, so that nothing overflows. The radius is
        // measured from the rounded middle, which may be far from the centre of a scene of a few
        // ulps. The scale is at most 2^1000, so that it is finite.
        double radius = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            middle_[k] = e.low[k] / 2 + e.high[k] / 2;
            radius = std::max(radius, std::max(e.high[k] - middle_[k], middle_[k] - e.low[k]));
        }
        scale_ = 1 / std::max(radius, 0x1p-1000);
    }
    constexpr float operator()(std::size_t axis, double x) const {
        return static_cast<float>((x - middle_[axis]) * scale_);
    }
    /// Floats per unit of the coordinates.
    constexpr double scale() const { return scale_; }

  private:
    double middle_[3], scale_;
};

template <class S>
struct gap {
    S above, below;
};
template <class Pair, class S>
constexpr gap<S> gap_between(const S (&x)[4]) {
    using std::max, std::min;
    if constexpr (kind_traits<kind_of<Pair>>::first_vertices == 1)
        return {x[0] - max(max(x[1], x[2]), x[3]), min(min(x[1], x[2]), x[3]) - x[0]};
    else
        return {min(x[2], x[3]) - max(x[0], x[1]), min(x[0], x[1]) - max(x[2], x[3])};
}
template <class Pair, class S>
constexpr S separated_by(const S (&start)[4], const S (&end)[4]) {
    using std::max, std::min;
    const gap<S> g0 = gap_between<Pair>(start), g1 = gap_between<Pair>(end);
    return max(min(g0.above, g1.above), min(g0.below, g1.below));
}

/// Same as static_filter::separated_by_axes, in single precision, with the gaps `least`.
/// x[axis][end of the step][point] has points in the order of the indices; S is float or a pack.
template <class Pair, class S>
constexpr static_filter::mask<S> separated(const S (&x)[3][2][4], const least_gaps& least = {}) {
    using std::max;
    S along(-1.0f), across(-1.0f);
    for (std::size_t k = 0; k < 3; ++k) along = max(along, separated_by<Pair>(x[k][0], x[k][1]));
    for (std::size_t k = 0; k < 3; ++k) {
        const auto &u = x[k], &v = x[(k + 1) % 3];
        S sum[2][4], difference[2][4];
        for (std::size_t end = 0; end < 2; ++end)
            for (std::size_t p = 0; p < 4; ++p) {
                sum[end][p] = u[end][p] + v[end][p];
                difference[end][p] = u[end][p] - v[end][p];
            }
        across = max(across, separated_by<Pair>(sum[0], sum[1]));
        across = max(across, separated_by<Pair>(difference[0], difference[1]));
    }
    const static_filter::mask<S> by_coordinates = along > S(least.along),
                                 by_diagonals = across > S(least.across);
    return by_coordinates | by_diagonals;
}

}  // namespace ccd::detail::rounded_axes
