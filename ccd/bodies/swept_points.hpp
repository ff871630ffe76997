// Boxes around the ways of a body's points. Internal.
#pragma once

#include <array>
#include <ccd/bodies/motion.hpp>
#include <ccd/query.hpp>
#include <vector>

#include "ccd/step/trees/box_tree.hpp"

namespace ccd::detail {

/// A rational motion's control points are affine maps of the rest position X, and each x(t) is a
/// convex combination of them: their box contains the point's way. Holds these maps, rounded, and a
/// bound of a control point's error for all points of a box at rest.
class swept_points {
  public:
    /// Preconditions: the motion is valid, `rest` is finite.
    swept_points(const body_motion& motion, const box<double>& rest);

    /// Precondition: x is in the box at rest.
    box<double> box_of(const point<double>& x) const;
    /// Contains the ways of all points of a box in the box at rest.
    box<double> box_of(const box<double>& b) const;
    /// Contains the ways of all points in the box at rest.
    box<double> box_of_all() const { return box_of(rest_); }

  private:
    struct affine_map {
        matrix3 linear;
        std::array<double, 3> shift;
    };
    void set_error();
    template <class EndsOf>
    box<double> box_around(const EndsOf& ends_of) const;

    box<double> rest_;
    point<double> centre_;
    std::vector<affine_map> maps_;  ///< empty: the body rests
    matrix3 error_of_linear_{};     ///< the most of all maps
    std::array<double, 3> error_of_shift_{}, error_{};
};

/// Widens a box on all sides by at least `by`, within the range of doubles.
box<double> widened(const box<double>& b, double by);

}  // namespace ccd::detail
