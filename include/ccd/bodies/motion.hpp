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
// contact; tenths of a second at extreme exponents, seconds with features of several bodies.
#pragma once

#include <array>
#include <ccd/curves.hpp>
#include <ccd/query.hpp>
#include <cstddef>
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

class prepared_motion;

/// A point of a body, at rest in the body's own coordinates. `motion` is not owned and not null.
struct body_point {
    const body_motion* motion = nullptr;
    point<double> rest;
    const prepared_motion* prepared = nullptr;  ///< of *motion, or null: see prepared_motion::at
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

/// A turn by `angle`, in radians and of any size, about the direction `axis`, by the right-hand
/// rule. It starts with the rotation from.q, and `centre` moves from from.p to `end`. The pieces
/// turn by at most a quarter of a turn, at equal intervals of time in [0, 1]. Their ends are
/// rounded, and each begins exactly where the last one ended. Returns one piece without rotation if
/// `axis` is 0, and one that fault_of reports if `angle` or `axis` is not finite. Throws
/// std::length_error or std::bad_alloc if there are too many pieces.
std::vector<spline_piece<rigid_motion>> turn(const pose& from, const point<double>& axis,
                                             double angle, const point<double>& end,
                                             const point<double>& centre = {});

/// The motion along a line between the rounded ends of A(t)X + p(t). Each coordinate at an end is
/// ((A_x X.x + A_y X.y) + A_z X.z) + p, rounded after every operation.
moving_point<double> rounded_ends(const affine_motion& motion, const point<double>& rest);

namespace detail {

template <>
inline constexpr bool is_motion<body_point> = true;

/// Approximates a motion between two times by a chord for each point. Let y = X − centre for a rest
/// position X. At every time, x(t) is within error_of(|y|₁) of the point that moves at constant
/// speed from ends_of(y).t0 to ends_of(y).t1.
struct motion_chords {
    enum class motion_kind { rests, keeps_direction, turns };

    explicit motion_chords(const body_motion& motion, double from = 0, double to = 1);

    moving_point<double> ends_of(const point<double>& y) const {
        std::array<double, 6> x;
        for (std::size_t k = 0; k < 6; ++k)
            x[k] = ((column[0][k] * y.x + column[1][k] * y.y) + column[2][k] * y.z) + shift[k];
        return {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
    }
    /// If the bound is infinite or NaN, it bounds nothing. `length` is |y.x| + |y.y| + |y.z|.
    double error_of(double length) const { return error_per_length * length + error; }

    /// The columns of A(t) or R(t), and the translation: three numbers for each of the two times.
    std::array<std::array<double, 6>, 3> column{};
    std::array<double, 6> shift{};
    point<double> centre;
    double error_per_length = 0, error = 0;  ///< infinite if the motion is invalid or too extreme
    motion_kind motion = motion_kind::rests;
    bool is_affine = false;    ///< not a rigid body
    double largest_entry = 1;  ///< bounds the entries of `column`
    /// A body that turns: its quaternions, scaled by a power of two, w x y z at both times. The
    /// scale makes the largest coordinate of the motion's q0 and q1 at least 1/2 and at most 1.
    /// Smaller coordinates may have underflowed.
    std::array<std::array<double, 4>, 2> q{};

  private:
    void set_identity();
    void set_shift(const point<double>& p0, const point<double>& p1);
    void set(const affine_motion& m);
    void set(const rigid_motion& m);

    double from_, to_;
};

}  // namespace detail

/// A motion with numbers that each query needs, computed once. Queries of its points give the same
/// results as those of {&motion, rest}. They take a quarter to half of the time if boxes or axes
/// decide.
class prepared_motion {
  public:
    explicit prepared_motion(const body_motion& motion) : motion_(motion), chords_(motion) {}

    const body_motion& motion() const { return motion_; }
    const detail::motion_chords& chords() const { return chords_; }
    /// The point of this body that rests at `rest`. Precondition: *this outlives its queries.
    body_point at(const point<double>& rest) const { return {&motion_, rest, this}; }

  private:
    body_motion motion_;
    detail::motion_chords chords_;
};

}  // namespace ccd
