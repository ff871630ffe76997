// The floating-point stages of queries whose features belong to one body each. Internal.
//
// Axes that separate the points' chords first, then bisection of the signs of Y and the G_i, as for
// linear motion (ccd/exact/stages.hpp). Nothing is allocated.
#pragma once

#include <array>
#include <ccd/bodies/motion.hpp>
#include <ccd/kind.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <errbound/roots/control_values.hpp>
#include <errbound/sign.hpp>
#include <optional>
#include <span>

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

/// The motion as one of a rigid body; nothing if it is affine with another matrix than 1.
std::optional<rigid_motion> as_rigid(const body_motion& motion);

/// True if all points of each feature have one motion.
template <kind K>
bool has_two_bodies(std::span<const body_point> points) {
    constexpr std::size_t first = kind_traits<K>::first_vertices;
    for (std::size_t i = 1; i < points.size(); ++i)
        if (i != first && points[i].motion != points[i - 1].motion) return false;
    return true;
}

/// Keeps references. Preconditions: has_two_bodies; the chords are those of the two motions.
template <kind K>
class body_filter {
  public:
    body_filter(std::span<const body_point> points, const motion_chords& first,
                const motion_chords& second)
        : points_(points), a_(first), b_(second) {}

    /// True if the points are valid and the features certainly stay farther apart than the
    /// distance.
    bool separated(double distance) const;

    /// `separate` and `collides` are certain; for the latter, *found is set. `uncertain` if an
    /// affine body meets a turning one, and for VE and VV. Precondition: the points are valid.
    outcome decide(touching_interval* found) const;

  private:
    static constexpr std::size_t first = kind_traits<K>::first_vertices;
    static constexpr std::size_t count = first + kind_traits<K>::second_vertices;

    struct elements;

    std::span<const body_point> points_;
    const motion_chords& a_;
    const motion_chords& b_;
};

}  // namespace ccd::detail
