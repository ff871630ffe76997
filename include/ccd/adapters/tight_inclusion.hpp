// Calls with the signatures of Tight-Inclusion, decided by `exact`. Needs Eigen, but no file of
// Tight-Inclusion.
//
//     namespace ticcd = ccd::adapters::tight_inclusion;
//
// replaces its header; calls, with doubles or floats, need no change. An answer `false` certifies
// that the features stay free, or farther apart than ms on some axis; `toi` is not after the first
// time of an answer `true` (see vertexFaceCCD). Coordinates, ms >= 0 and t_max must be finite;
// otherwise the answer is `true` with `toi` 0. Thread-safe. Cost: that of time_of_impact
// (ccd/contact.hpp); with ms > 0 that of time_within, or less if t_max < 1.
#pragma once

#include <Eigen/Core>
#include <ccd/adapters/first_within.hpp>
#include <ccd/adapters/points.hpp>
#include <ccd/contact.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>
#include <cmath>
#include <concepts>
#include <limits>
#include <type_traits>

namespace ccd::adapters::tight_inclusion {

using Scalar = double;
using Vector3 = Eigen::Matrix<Scalar, 3, 1>;
using Array3 = Eigen::Array<Scalar, 3, 1>;

enum class CCDRootFindingMethod { DEPTH_FIRST_SEARCH, BREADTH_FIRST_SEARCH };

inline constexpr bool DEFAULT_NO_ZERO_TOI = false;
inline constexpr Scalar DEFAULT_CCD_DISTANCE_TOL = 1e-6;

namespace detail {

/// Only `toi` determines T; arguments of these types convert.
template <class T>
using scalar = std::type_identity_t<T>;
template <class T>
using vector = std::type_identity_t<Eigen::Matrix<T, 3, 1>>;
template <class T>
using array = std::type_identity_t<Eigen::Array<T, 3, 1>>;

/// A distance of at least sqrt(3) ms, without overflow: its second double, (sqrt(3) - 1) ms, is
/// rounded up.
inline separation ball_around_box(double ms) {
    constexpr double sqrt_3_less_1 = 0x1.76cf5d0b09955p-1;  // the least double above it
    return {ms, ms == 0 ? 0 : std::nextafter(sqrt_3_less_1 * ms, 2 * ms)};
}

/// The last number of type T that is not after t.
template <std::floating_point T>
T not_after(double t) {
    const T rounded = static_cast<T>(t);
    return rounded <= t ? rounded : std::nextafter(rounded, T(0));
}

template <class T, class Query>
bool answer(const Query& query, double ms, double t_max, bool no_zero_toi, T& toi) {
    first_time found = adapters::detail::first_within(query, ball_around_box(ms), t_max);
    if (no_zero_toi && found.at_start()) found = time_of_impact(query, t_max);
    toi = found.outcome == outcome::separate ? std::numeric_limits<T>::infinity()
                                             : not_after<T>(found.low);
    return found.outcome != outcome::separate;
}

}  // namespace detail

/// Vertex v and triangle f0 f1 f2, whose positions move linearly from t0 to t1.
///
/// ms = 0: true if and only if they touch in [0, t_max]. `toi` is the last T not after the first
/// contact. ms > 0: true if and only if their Euclidean distance gets down to sqrt(3) ms, rounded
/// up by less than two units in the last place. The ball of this radius contains the box of
/// Tight-Inclusion, so `false` certifies the same as there. So pairs up to 1.74 ms apart along an
/// axis are reported; for a Euclidean distance call ccd::time_within. `toi` is infinite if the
/// answer is false.
///
/// err, tolerance, max_itr and ccd_method are ignored, since decisions are exact; output_tolerance
/// is set to tolerance. With no_zero_toi, a pair within sqrt(3) ms at the start is tested for
/// contact only. Then `toi` is 0 only for invalid input, for a pair that touches at
/// the start, and for times below the least positive T.
template <class T>
requires std::same_as<T, double> || std::same_as<T, float>
bool vertexFaceCCD(
    const detail::vector<T>& v_t0, const detail::vector<T>& f0_t0, const detail::vector<T>& f1_t0,
    const detail::vector<T>& f2_t0, const detail::vector<T>& v_t1, const detail::vector<T>& f0_t1,
    const detail::vector<T>& f1_t1, const detail::vector<T>& f2_t1, const detail::array<T>& /*err*/,
    detail::scalar<T> ms, T& toi, detail::scalar<T> tolerance, detail::scalar<T> t_max,
    long /*max_itr*/, detail::scalar<T>& output_tolerance, bool no_zero_toi = DEFAULT_NO_ZERO_TOI,
    CCDRootFindingMethod /*ccd_method*/ = CCDRootFindingMethod::BREADTH_FIRST_SEARCH) {
    using adapters::detail::moving;
    output_tolerance = tolerance;
    return detail::answer(vertex_face<double>{moving(v_t0, v_t1), moving(f0_t0, f0_t1),
                                              moving(f1_t0, f1_t1), moving(f2_t0, f2_t1)},
                          ms, t_max, no_zero_toi, toi);
}

/// Same as vertexFaceCCD, for the edges ea0 ea1 and eb0 eb1.
template <class T>
requires std::same_as<T, double> || std::same_as<T, float>
bool edgeEdgeCCD(const detail::vector<T>& ea0_t0, const detail::vector<T>& ea1_t0,
                 const detail::vector<T>& eb0_t0, const detail::vector<T>& eb1_t0,
                 const detail::vector<T>& ea0_t1, const detail::vector<T>& ea1_t1,
                 const detail::vector<T>& eb0_t1, const detail::vector<T>& eb1_t1,
                 const detail::array<T>& /*err*/, detail::scalar<T> ms, T& toi,
                 detail::scalar<T> tolerance, detail::scalar<T> t_max, long /*max_itr*/,
                 detail::scalar<T>& output_tolerance, bool no_zero_toi = DEFAULT_NO_ZERO_TOI,
                 CCDRootFindingMethod /*ccd_method*/ = CCDRootFindingMethod::BREADTH_FIRST_SEARCH) {
    using adapters::detail::moving;
    output_tolerance = tolerance;
    return detail::answer(edge_edge<double>{moving(ea0_t0, ea0_t1), moving(ea1_t0, ea1_t1),
                                            moving(eb0_t0, eb0_t1), moving(eb1_t0, eb1_t1)},
                          ms, t_max, no_zero_toi, toi);
}

}  // namespace ccd::adapters::tight_inclusion
