// Bodies that turn: points of affine and rigid bodies between two poses, decided exactly.
//
//     const ccd::body_motion spin = ccd::shorter_arc({q0, p0}, {q1, p1});
//     const ccd::body_motion still = ccd::resting{};
//     const auto vertex = [&](auto x) { return ccd::body_point{&spin, x}; };
//     const ccd::vertex_face_of<ccd::body_point> query{vertex(v), {&still, f0}, ...};
//     const ccd::first_time touch = ccd::time_of_impact(query);
//
// Positions such as v and f0 are in the body's rest frame. Calls of ccd/curves.hpp accept such
// queries and decide about the poses as given, without rounding. Cost: below a microsecond for a
// decision in floating point, some microseconds for a first time, 0.1 to 1 ms for degenerate
// contact; 0.16 s was seen.
#pragma once

#include <array>
#include <ccd/curves.hpp>
#include <ccd/query.hpp>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace ccd {

/// w + xi + yj + zk, finite and of any length but 0: it means the rotation of q/|q|, without
/// rounding.
struct quaternion {
    double w = 1, x = 0, y = 0, z = 0;
    friend bool operator==(const quaternion&, const quaternion&) = default;
};

/// The rotation q/|q|, then the translation p.
struct pose {
    quaternion q;
    point<double> p;
    friend bool operator==(const pose&, const pose&) = default;
};

using matrix3 = std::array<std::array<double, 3>, 3>;  ///< rows
inline constexpr matrix3 identity3{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/// Every point rests at its rest position X.
struct resting {
    friend bool operator==(const resting&, const resting&) = default;
};

/// x(t) = A(t)X + p(t) with A and p linear in t: every point moves along a line.
struct affine_motion {
    matrix3 a0 = identity3, a1 = identity3;
    point<double> p0, p1;
    friend bool operator==(const affine_motion&, const affine_motion&) = default;
};

/// x(t) = R(t)(X − centre) + p(t) with p linear in t, where R(t) is the rotation of the quaternion
/// q(t) = (1 − t)q0 + t q1, normalised. The body turns about the point that is `centre` at rest. t
/// is the parameter of this interpolation; the speed of rotation is not constant. It depends on the
/// lengths of q0 and q1 and the angle between them. A piece turns by less than half a turn: q0·q1
/// must certainly be > 0.
struct rigid_motion {
    quaternion q0, q1;
    point<double> p0, p1;
    point<double> centre;
    friend bool operator==(const rigid_motion&, const rigid_motion&) = default;
};

using body_motion = std::variant<resting, affine_motion, rigid_motion>;

/// A point of a body, at rest in the body's own coordinates. `motion` is not owned and not null.
struct body_point {
    const body_motion* motion = nullptr;
    point<double> rest;
};

/// Returns "" if the motion is valid, else the reason, such as `q0·q1 is -1; expected a number
/// certainly > 0`.
std::string fault_of(const body_motion& motion);

/// False if the motion's ends are equal.
bool moves(const body_motion& motion);

/// The motion from one pose to another, with −q1 for q1 if that is the shorter arc.
rigid_motion shorter_arc(const pose& from, const pose& to);

/// A screw motion about the direction d, whose length is the tangent of half the angle at t = 1. At
/// t the angle is 2 atan(t|d|). The axis goes through `centre`, which moves to `end`. At t = 0 all
/// points are at their rest positions. No number is rounded.
rigid_motion screw(const point<double>& d, const point<double>& centre, const point<double>& end);

/// A turn from `from` by `angle`, in radians and of any size, about the direction `axis`, while
/// `centre` moves to `end`. The pieces turn by at most a quarter of a turn, at equal intervals of
/// time in [0, 1]. Their ends are rounded, and each begins exactly where the last one ended.
/// Returns one piece without rotation if `axis` is 0, and one that fault_of reports if `angle` or
/// `axis` is not finite. Throws std::length_error or std::bad_alloc if there are too many pieces.
std::vector<spline_piece<rigid_motion>> turn(const pose& from, const point<double>& axis,
                                             double angle, const point<double>& end,
                                             const point<double>& centre = {});

/// The motion along a line between the rounded ends of A(t)X + p(t). Each coordinate at an end is
/// ((A_x X.x + A_y X.y) + A_z X.z) + p, rounded after every operation.
moving_point<double> rounded_ends(const affine_motion& motion, const point<double>& rest);

namespace detail {
template <>
inline constexpr bool is_motion<body_point> = true;
}  // namespace detail

}  // namespace ccd
