// Control points of a body's points, in floating point. Internal.
#pragma once

#include <array>
#include <ccd/bodies/motion.hpp>
#include <cstddef>
#include <optional>

namespace ccd::detail {

/// The motion as one of a rigid body; nothing if it is affine with another matrix than 1.
std::optional<rigid_motion> as_rigid(const body_motion& motion);

/// A point that rests at X moves along a rational curve with the control points
/// linear[j](X − centre) + p0 + along[j](p1 − p0), for j < count.
///
/// Let u = 2^-53. Entries of `linear` are at most `largest_entry`, computed with errors of at most
/// 25u·largest_entry. `weight` has relative errors of at most 10u. `along` has errors of at most
/// 5u.
struct control_maps {
    enum class motion_kind { rests, keeps_direction, turns };

    explicit control_maps(const body_motion& motion);

    motion_kind motion = motion_kind::rests;
    std::size_t count = 1;
    std::array<matrix3, 4> linear;
    std::array<double, 4> along{};
    /// The coefficients C(n, j)w_j s^(n−j) t^j of the curve's weight.
    std::array<double, 4> weight{1, 1, 1, 1};
    double largest_entry = 1;
    point<double> p0, p1, centre;
    /// A body that turns: its quaternions, scaled by a power of two, w x y z at t = 0 and t = 1.
    /// The largest coordinate is in [1/2, 1]. Others may have underflowed.
    std::array<std::array<double, 4>, 2> q{};
    /// False if the motion is too extreme for the bounds above.
    bool usable = true;
    bool is_affine = false;  ///< not a rigid body

  private:
    void set(const affine_motion& m);
    void set(const rigid_motion& m);
    void set_rotation(const rigid_motion& m);
};

}  // namespace ccd::detail
