// The floating-point stages of queries whose features belong to one body each. Internal.
//
// Separating axes first, then bisection of the signs of Y and the G_i, as for linear motion
// (ccd/exact/stages.hpp). Nothing is allocated.
#pragma once

#include <array>
#include <ccd/bodies/motion.hpp>
#include <ccd/kind.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <errbound/roots/control_values.hpp>
#include <errbound/sign.hpp>
#include <span>

#include "ccd/contact/turning/control_maps.hpp"

namespace ccd::detail {

/// An interval that contains the first contact, with Y of opposite certain signs at its ends. All
/// its roots of Y are contacts.
struct touching_interval {
    double low = 0, high = 1;
    double estimate = 0.5;                                        ///< of a root of Y
    errbound::sign_type before = errbound::sign_type::uncertain;  ///< of Y at `low`
    bool one_root = false;  ///< Y certainly has exactly one root there

    /// With at most one uncertain sign, between the values of certain signs, signs change once.
    template <int N>
    constexpr void set(double from, double to, const errbound::roots::control_values<double, N>& y,
                       double error) {
        low = from;
        high = to;
        estimate = from + (to - from) * (y[0] / (y[0] - y[N]));
        const double sign = y[0] > 0 ? 1 : -1;
        before = y[0] > 0 ? errbound::sign_type::positive : errbound::sign_type::negative;
        int first = 0, last = N;
        while (sign * y[first] > error) ++first;
        while (sign * y[last] < -error) --last;
        one_root = last <= first;
    }
};

/// True if all points of each feature have one motion.
template <kind K>
bool has_two_bodies(std::span<const body_point> points);

/// Keeps references. Preconditions: has_two_bodies, valid points.
template <kind K>
class body_filter {
  public:
    body_filter(std::span<const body_point> points, const control_maps& first,
                const control_maps& second);

    /// True if an axis certainly separates the features by more than the distance.
    bool separated_by_axes(double distance) const;

    /// `separate` and `collides` are certain; for the latter, *found is set. `uncertain` if an
    /// affine body meets a turning one, and for VE and VV.
    outcome decide(touching_interval* found) const;

  private:
    static constexpr std::size_t first = kind_traits<K>::first_vertices;
    static constexpr std::size_t count = first + kind_traits<K>::second_vertices;
    using vector = point<double>;

    struct elements;

    std::span<const body_point> points_;
    const control_maps& a_;
    const control_maps& b_;
    std::array<vector, count> from_centre_;
    std::array<vector, 2> a_way_, b_way_;  ///< of the centres, relative to the second one's start
};

}  // namespace ccd::detail
