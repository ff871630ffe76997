// Rotation at constant angular velocity. It is not rational in time, so queries may be uncertain.
//
//     const ccd::constant_turn spin{{{}, p}, {0, 0, 1}, angle, p}, still{};
//     const ccd::vertex_face_of<ccd::turning_point> query{{&spin, v}, {&still, f0}, ...};
//     const ccd::enclosed_time touch = ccd::enclosed_time_of_impact(query);
//
// Rational motion in pieces (ccd/bodies/motion.hpp) replaces the true motion. Its distance from
// the true motion has a certified bound: a query is separate if the pieces stay farther apart. It
// collides if the features certainly pass through each other. The bounds assume the errors of the
// C library's sine and cosine (errbound/functions/function_error.hpp); where these are unknown,
// every query with a rotation that could touch is uncertain.
#pragma once

#include <ccd/bodies/motion.hpp>
#include <ccd/curves.hpp>
#include <string>

namespace ccd {

/// x(t) = R(t) (X − centre) + p(t). R(t) is the rotation of from.q, then the turn by `angle` t
/// about `axis`. p(t) is linear from from.p to `end`. The members are the arguments of `turn`
/// (ccd/bodies/motion.hpp), but the motion is not rounded.
struct constant_turn {
    pose from;
    point<double> axis{0, 0, 1};  ///< of any length but 0
    double angle = 0;             ///< in radians, of any size; 0: only a translation
    point<double> end;
    point<double> centre;
};

/// Returns why a turn is invalid, or "".
std::string fault_of(const constant_turn& motion);

/// A point of a body, at rest in the body's own coordinates. `motion` is not owned and not null.
struct turning_point {
    const constant_turn* motion = nullptr;
    point<double> rest;
};

/// Rational motion near a part of a turn. A point X is at most angle · |X − centre| + shift from
/// its true position, at each time.
struct enclosing_motion {
    rigid_motion motion;
    double angle = 0, shift = 0;
};

/// Encloses the turn between two times; t = 0 of the result is `from`, t = 1 is `to`. For a turn by
/// θ <= π/2 between these times, the result's bound `angle` is about θ³/250, at most θ³/220, plus
/// some units in the last place. For larger turns it is infinite. Precondition: 0 <= from < to <=
/// 1; the turn is valid.
enclosing_motion enclose(const constant_turn& motion, double from, double to);

struct enclosed_time {
    /// `separate` and `collides` are certain. `uncertain`: the features come within the bound, but
    /// a contact is not certain, for example because they graze each other; or an input is invalid
    /// or too large.
    ccd::outcome outcome = ccd::outcome::uncertain;
    /// There is no contact in [0, low). If the outcome is `collides`, there is one in [low, high].
    double low = 0, high = 1;
};

struct enclosure_options {
    double resolution = 0x1p-30;  ///< a bracket this narrow is not refined
    /// Bounds the time: each piece takes at most three exact queries. Pieces that come near are
    /// halved.
    int max_pieces = 1000;
};

/// Returns the first time in [0, 1] at which two features touch. Contacts at t = 0 and motion
/// without rotation are exact. Other contacts of a vertex with a vertex, an edge or the border of a
/// face are uncertain, since an arbitrarily small error removes them.
enclosed_time enclosed_time_of_impact(const vertex_face_of<turning_point>& query,
                                      const enclosure_options& options = {});
enclosed_time enclosed_time_of_impact(const edge_edge_of<turning_point>& query,
                                      const enclosure_options& options = {});
enclosed_time enclosed_time_of_impact(const vertex_edge_of<turning_point>& query,
                                      const enclosure_options& options = {});
enclosed_time enclosed_time_of_impact(const vertex_vertex_of<turning_point>& query,
                                      const enclosure_options& options = {});

}  // namespace ccd
