// `exact` as a narrow phase of ipc-toolkit (optional header; needs your ipc-toolkit and Eigen, and
// nothing of it to be rebuilt).
//
//   const ccd::adapters::exact_narrow_phase exact(0.8);
//   ipc::compute_collision_free_stepsize(mesh, before, after, min_distance, nullptr, exact);
//
// The meaning is that of the interface, without tolerance and without a limit of iterations. With
// conservative_rescaling 1, the default:
//
// * An answer is true exactly if the features come within min_distance of each other, or touch if
//   it is 0, at some time in [0, tmax]. Distances are Euclidean and closed: that distance counts.
// * `toi` is never after the first such time, and less than a last place before it: `low` of
//   ccd/contact.hpp. Where the first time is a double, `toi` is that double.
// * `toi` is 0 if they are within min_distance at the start; and where they come within it after
//   the start, but before the least double above 0, since no other double is before that.
// * `toi` is infinite where the answer is false.
//
// A step of that length may end in contact. Who needs a gap, as barriers do, gives less than 1.
// Then the distance asked for is min_distance and the fraction 1 - conservative_rescaling of what
// is above it at the start: so that part of the gap is left at every time up to `toi`, and all that
// get nearer are reported. Where rounding leaves nothing of that fraction, min_distance is asked
// for, and the time multiplied by conservative_rescaling; so `toi` is 0 in no other cases.
//
// Coordinates, min_distance >= 0 and tmax must be finite; if not, nothing is known, and the answer
// is true with `toi` 0. Degenerate triangles and edges are the segments and points that they are.
// Safe to be called by many threads at once. Cost: that of time_of_impact (ccd/contact.hpp); with a
// distance or a gap that of time_within (ccd/separation.hpp), but far less where tmax is below 1
// and the features are not that near by then.
#pragma once

#include <algorithm>
#include <cassert>
#include <ccd/adapters/first_within.hpp>
#include <ccd/adapters/points.hpp>
#include <ccd/adapters/start_distance.hpp>
#include <ccd/contact.hpp>
#include <ccd/query.hpp>
#include <ccd/separation.hpp>
#include <ccd/verdict.hpp>
#include <cmath>
#include <ipc/ccd/narrow_phase_ccd.hpp>
#include <limits>

namespace ccd::adapters {

namespace detail {

/// The interface with the member conservative_rescaling, which early versions of it do not have.
template <class Interface>
struct rescaled : Interface {
    double conservative_rescaling = 1;
};
template <class Interface>
requires requires(Interface& i) {
    i.conservative_rescaling;
}
struct rescaled<Interface> : Interface {};

/// How a version passes positions: the first parameter's type.
template <class Interface, class Position, class... Rest>
Position first_parameter(bool (Interface::*)(Position, Rest...) const);

}  // namespace detail

/// Answers what the toolkit asks by `exact`: docs/from-ipc-toolkit.md says what an answer means.
class exact_narrow_phase : public detail::rescaled<ipc::NarrowPhaseCCD> {
    using position =
        decltype(detail::first_parameter(&ipc::NarrowPhaseCCD::point_point_ccd));  // 2D or 3D
    using position_3d = decltype(detail::first_parameter(&ipc::NarrowPhaseCCD::edge_edge_ccd));

  public:
    /// `rescaling`, in (0, 1], is the public member conservative_rescaling, which the toolkit reads
    /// as well.
    explicit exact_narrow_phase(double rescaling = 1) { conservative_rescaling = rescaling; }

    bool point_point_ccd(position p0_t0, position p1_t0, position p0_t1, position p1_t1,
                         double& toi, double min_distance = 0, double tmax = 1) const override {
        using detail::moving;
        return answer(vertex_vertex<double>{moving(p0_t0, p0_t1), moving(p1_t0, p1_t1)}, toi,
                      min_distance, tmax);
    }

    bool point_edge_ccd(position p_t0, position e0_t0, position e1_t0, position p_t1,
                        position e0_t1, position e1_t1, double& toi, double min_distance = 0,
                        double tmax = 1) const override {
        using detail::moving;
        return answer(
            vertex_edge<double>{moving(p_t0, p_t1), moving(e0_t0, e0_t1), moving(e1_t0, e1_t1)},
            toi, min_distance, tmax);
    }

    bool point_triangle_ccd(position_3d p_t0, position_3d t0_t0, position_3d t1_t0,
                            position_3d t2_t0, position_3d p_t1, position_3d t0_t1,
                            position_3d t1_t1, position_3d t2_t1, double& toi,
                            double min_distance = 0, double tmax = 1) const override {
        using detail::moving;
        return answer(vertex_face<double>{moving(p_t0, p_t1), moving(t0_t0, t0_t1),
                                          moving(t1_t0, t1_t1), moving(t2_t0, t2_t1)},
                      toi, min_distance, tmax);
    }

    bool edge_edge_ccd(position_3d ea0_t0, position_3d ea1_t0, position_3d eb0_t0,
                       position_3d eb1_t0, position_3d ea0_t1, position_3d ea1_t1,
                       position_3d eb0_t1, position_3d eb1_t1, double& toi, double min_distance = 0,
                       double tmax = 1) const override {
        using detail::moving;
        return answer(edge_edge<double>{moving(ea0_t0, ea0_t1), moving(ea1_t0, ea1_t1),
                                        moving(eb0_t0, eb0_t1), moving(eb1_t0, eb1_t1)},
                      toi, min_distance, tmax);
    }

  private:
    template <class Query>
    bool answer(const Query& query, double& toi, double min_distance, double tmax) const {
        assert(0 < conservative_rescaling && conservative_rescaling <= 1);
        if (conservative_rescaling < 1) return answer_with_gap(query, toi, min_distance, tmax);
        const first_time found = detail::first_within(query, {min_distance}, (std::min)(tmax, 1.0));
        return reported(found.outcome, found.low, toi);
    }

    template <class Query>
    bool answer_with_gap(const Query& query, double& toi, double min_distance, double tmax) const {
        const double above = detail::start_distance(query) - min_distance;
        const double gap = (1 - conservative_rescaling) * above;
        if (gap > 0 && std::isfinite(gap)) {
            const first_time found =
                detail::first_within(query, {min_distance, gap}, (std::min)(tmax, 1.0));
            if (!found.at_start()) return reported(found.outcome, found.low, toi);
        }
        // Asked until 1, for the rescaled time to be compared: the least of many answers must not
        // depend on their order, each with the least before as its tmax.
        const first_time found = time_within(query, {min_distance}, std::isnan(tmax) ? tmax : 1);
        const double least = std::numeric_limits<double>::denorm_min();
        const double time =
            (std::max)(conservative_rescaling * found.low, (std::min)(found.low, least));
        const bool late = found.outcome == outcome::collides && time > tmax;
        return reported(late ? outcome::separate : found.outcome, time, toi);
    }

    static bool reported(outcome found, double time, double& toi) {
        const bool is_reported = found != outcome::separate;
        toi = is_reported ? time : std::numeric_limits<double>::infinity();
        return is_reported;
    }
};

}  // namespace ccd::adapters
