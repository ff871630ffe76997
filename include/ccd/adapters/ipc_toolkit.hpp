// `exact` as a narrow phase of ipc-toolkit. Needs your ipc-toolkit and Eigen; nothing of the
// toolkit is rebuilt.
//
//   const ccd::adapters::exact_narrow_phase exact(0.8, 1e-4);
//   ipc::compute_collision_free_stepsize(mesh, before, after, min_distance, nullptr, exact);
//
// Decisions are exact, without tolerance or limit of iterations, and thread-safe. Coordinates and
// min_distance >= 0 must be finite, and tmax neither NaN nor -inf; otherwise the answer is true
// with `toi` 0. Cost: that of time_of_impact (ccd/contact.hpp). With a distance or a gap it is that
// of time_within, but far less if the features stay farther apart than these until tmax.
#pragma once

#include <cassert>
#include <ccd/adapters/kept_gap.hpp>
#include <ccd/adapters/points.hpp>
#include <ccd/query.hpp>
#include <ipc/ccd/narrow_phase_ccd.hpp>
#include <limits>

namespace ccd::adapters {

namespace detail {

/// Adds the member conservative_rescaling, which early versions of the interface lack.
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

/// An exact ipc::NarrowPhaseCCD; docs/collision-detection.md compares it with the toolkit's.
///
/// With conservative_rescaling 1, the default:
///
/// * An answer is true if and only if the features come within min_distance at some time in [0,
///   min(tmax, 1)]. A min_distance of 0 means contact. Distances are Euclidean and closed:
///   min_distance counts.
/// * `toi` is never after the first such time, and less than one ulp before it: `low` of
///   ccd/contact.hpp. If the first time is a double, `toi` is that double.
/// * `toi` is 0 if the features are within min_distance at the start, or come within it before the
///   least double above 0.
/// * `toi` is infinite if the answer is false.
///
/// A step of that length may end in contact. For a gap, as barriers need, set a
/// conservative_rescaling below 1. The distance tested is then min_distance plus a gap: the
/// fraction 1 - conservative_rescaling of the distance above min_distance at the start, at most
/// max_gap. The gap remains at every time up to `toi`, and all features that get nearer are
/// reported. The distance at the start is an estimate. If its error or rounding leaves no gap,
/// min_distance is tested, and the time is multiplied by conservative_rescaling. `toi` is 0 only
/// for invalid input, for features within min_distance at the start, and for times below the least
/// double above 0. Degenerate triangles and edges are the segments and points that they are.
class exact_narrow_phase : public detail::rescaled<ipc::NarrowPhaseCCD> {
    using position =
        decltype(detail::first_parameter(&ipc::NarrowPhaseCCD::point_point_ccd));  // 2D or 3D
    using position_3d = decltype(detail::first_parameter(&ipc::NarrowPhaseCCD::edge_edge_ccd));

  public:
    /// The largest gap that is kept for conservative_rescaling, > 0.
    double max_gap;

    /// `rescaling`, in (0, 1], is the public member conservative_rescaling, which the toolkit
    /// reads.
    explicit exact_narrow_phase(double rescaling = 1,
                                double largest_gap = std::numeric_limits<double>::infinity())
        : max_gap(largest_gap) {
        conservative_rescaling = rescaling;
    }

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
        assert(0 < conservative_rescaling && conservative_rescaling <= 1 && max_gap > 0);
        const detail::narrow_answer found =
            detail::answer(query, {conservative_rescaling, max_gap}, min_distance, tmax);
        toi = found.toi;
        return found.collides;
    }
};

}  // namespace ccd::adapters
