// Points of every description of motion (ccd/curves.hpp, ccd/bodies/motion.hpp) over three rings:
// polynomials on [0, 1] with tracked coefficients, numbers at one time, and polynomials in t with
// integer coefficients. Internal.
//
// A point has homogeneous coordinates: polynomials h_x, h_y, h_z and a weight > 0 on [0, 1]; the
// point is h/weight. A ring has these members:
//  * `scalar` and `element`.
//  * coordinate(x, axis): a position's coordinate, relative to an origin or in units of the axis.
//  * in_unit(x, unit): any number, in units of 2^unit.
//  * unit(axis): the axis' unit; 0 if the ring has none.
//  * interpolated(values): Σ C(m, i)(1 − t)^(m−i) t^i values_i.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/bodies/motion.hpp>
#include <ccd/curves.hpp>
#include <ccd/query.hpp>
#include <cmath>
#include <cstddef>
#include <errbound/integers/binary_double.hpp>
#include <errbound/tracked.hpp>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ccd/contact/condition.hpp"
#include "ccd/contact/control_polynomial.hpp"
#include "ccd/contact/rotation.hpp"
#include "ccd/contact/time_polynomial.hpp"

namespace ccd::detail {

inline constexpr std::array coordinate_axes{&point<double>::x, &point<double>::y,
                                            &point<double>::z};

// ---- Rings ----

class tracked_ring {
  public:
    using scalar = errbound::tracked<double>;
    using element = control_polynomial<scalar>;

    explicit tracked_ring(const point<double>& origin) : origin_(origin) {}

    scalar coordinate(double x, std::size_t axis) const {
        return scalar(x) - scalar(origin_.*coordinate_axes[axis]);
    }
    scalar in_unit(double x, int) const { return x; }
    int unit(std::size_t) const { return 0; }

    /// Binomials up to this degree are exact doubles.
    static constexpr std::size_t max_degree = 50;
    element interpolated(std::vector<scalar> values) const {
        const std::size_t degree = values.size() - 1;
        double binomial = 1;
        for (std::size_t i = 0; i <= degree; ++i) {
            if (binomial != 1) values[i] = values[i] * scalar(binomial);
            binomial = binomial * static_cast<double>(degree - i) / static_cast<double>(i + 1);
        }
        return element(std::move(values));
    }

  private:
    point<double> origin_;
};

class ring_at_time {
  public:
    using scalar = errbound::tracked<double>;
    using element = scalar;

    ring_at_time(const point<double>& origin, const scalar& t) : all_times_(origin), t_(t) {}

    scalar coordinate(double x, std::size_t axis) const { return all_times_.coordinate(x, axis); }
    scalar in_unit(double x, int) const { return x; }
    int unit(std::size_t) const { return 0; }

    /// De Casteljau's algorithm.
    element interpolated(std::vector<scalar> values) const {
        for (; values.size() > 1; values.pop_back())
            for (std::size_t i = 0; i + 1 < values.size(); ++i)
                values[i] = values[i] + t_ * (values[i + 1] - values[i]);
        return values[0];
    }

  private:
    tracked_ring all_times_;
    scalar t_;
};

class integer_ring {
  public:
    using scalar = integer;
    using element = time_polynomial;

    /// Precondition: every coordinate is an integer in units of 2^units[axis].
    explicit integer_ring(const axis_units& units) : units_(units) {}

    scalar coordinate(double x, std::size_t axis) const { return in_unit(x, units_[axis]); }
    /// Precondition: x/2^unit is an integer.
    scalar in_unit(double x, int unit) const {
        return errbound::dyadic<integer>::from(x).in_units(unit);
    }
    int unit(std::size_t axis) const { return units_[axis]; }

    element interpolated(std::vector<scalar> values) const {
        return time_polynomial::from_control_values(std::move(values));
    }

  private:
    axis_units units_;
};

// ---- Units ----

/// The exponent of 0, which is an integer in every unit. It exceeds that of every other double.
inline constexpr int exponent_of_zero = 1024;

/// The largest exponent e for which all numbers are integers in units of 2^e.
template <class Numbers = std::initializer_list<double>>
int common_exponent(const Numbers& numbers) {
    int least = exponent_of_zero;
    for (const double x : numbers)
        if (x != 0) least = std::min(least, errbound::integers::binary_double(x).last_bit());
    return least;
}
inline int common_exponent(const point<double>& p) {
    return common_exponent({p.x, p.y, p.z});
}
inline int common_exponent(const quaternion& q) {
    return common_exponent({q.w, q.x, q.y, q.z});
}
inline int common_exponent(const matrix3& a) {
    int least = exponent_of_zero;
    for (const auto& row : a) least = std::min(least, common_exponent(row));
    return least;
}

inline axis_units least_units(const curve& p) {
    axis_units units{exponent_of_zero, exponent_of_zero, exponent_of_zero};
    for (const point<double>& c : p)
        for (std::size_t axis = 0; axis < 3; ++axis)
            units[axis] = std::min(units[axis], common_exponent({c.*coordinate_axes[axis]}));
    return units;
}
inline axis_units least_units(const rational_curve& p) {
    return least_units(p.points);
}
/// One unit for all axes, since rotations mix them.
inline axis_units least_units(const body_point& p) {
    const int rest = common_exponent(p.rest);
    int unit = rest;
    if (const auto* affine = std::get_if<affine_motion>(p.motion))
        unit = std::min({rest + std::min(common_exponent(affine->a0), common_exponent(affine->a1)),
                         common_exponent(affine->p0), common_exponent(affine->p1)});
    else if (const auto* rigid = std::get_if<rigid_motion>(p.motion))
        unit = std::min({rest, common_exponent(rigid->centre), common_exponent(rigid->p0),
                         common_exponent(rigid->p1)});
    return {unit, unit, unit};
}

template <class Motion>
axis_units common_units(std::span<const Motion> points) {
    axis_units all = least_units(points[0]);
    for (const Motion& p : points.subspan(1)) {
        const axis_units own = least_units(p);
        for (std::size_t axis = 0; axis < 3; ++axis) all[axis] = std::min(all[axis], own[axis]);
    }
    return all;
}

// ---- Homogeneous coordinates ----

template <class Ring>
struct homogeneous_point {
    path<typename Ring::element> h;
    std::optional<typename Ring::element> weight;  ///< none: 1
};

template <class Scalar, class Q = quaternion>
Scalar dot_of(const Q& p, const Q& q) {
    return Scalar(p.w) * Scalar(q.w) + Scalar(p.x) * Scalar(q.x) + Scalar(p.y) * Scalar(q.y) +
           Scalar(p.z) * Scalar(q.z);
}

/// Computes homogeneous coordinates of points. Keeps the rotation of the last point's body.
template <class Ring>
class point_evaluator {
  public:
    using scalar = typename Ring::scalar;
    using element = typename Ring::element;

    explicit point_evaluator(const Ring& ring) : ring_(ring) {}

    homogeneous_point<Ring> operator()(const curve& p) const {
        return {path_of([&](std::size_t axis) {
                    std::vector<scalar> values;
                    for (const point<double>& c : p)
                        values.push_back(ring_.coordinate(c.*coordinate_axes[axis], axis));
                    return ring_.interpolated(std::move(values));
                }),
                std::nullopt};
    }
    homogeneous_point<Ring> operator()(const rational_curve& p) const {
        if (p.weights.empty()) return (*this)(p.points);
        std::vector<scalar> weights;
        const int unit = common_exponent(p.weights);
        for (const double w : p.weights) weights.push_back(ring_.in_unit(w, unit));
        return {
            path_of([&](std::size_t axis) {
                std::vector<scalar> values;
                for (std::size_t i = 0; i < weights.size(); ++i)
                    values.push_back(weights[i] *
                                     ring_.coordinate(p.points[i].*coordinate_axes[axis], axis));
                return ring_.interpolated(std::move(values));
            }),
            ring_.interpolated(weights)};
    }
    homogeneous_point<Ring> operator()(const body_point& p) {
        if (const auto* affine = std::get_if<affine_motion>(p.motion)) return at(*affine, p);
        if (const auto* rigid = std::get_if<rigid_motion>(p.motion)) return at(*rigid, p);
        return {path_of([&](std::size_t axis) {
                    return constant(ring_.coordinate(p.rest.*coordinate_axes[axis], axis));
                }),
                std::nullopt};
    }

  private:
    using matrix = std::array<std::array<element, 3>, 3>;

    template <class ElementOf>
    static path<element> path_of(const ElementOf& element_of) {
        return {{{element_of(0)}}, {{element_of(1)}}, {{element_of(2)}}};
    }
    element constant(scalar x) const { return ring_.interpolated({std::move(x)}); }
    /// from + t(to − from), of degree 0 if the ends are equal.
    element linear(double from, double to, int unit) const {
        if (from == to) return ring_.interpolated({ring_.in_unit(from, unit)});
        return ring_.interpolated({ring_.in_unit(from, unit), ring_.in_unit(to, unit)});
    }
    element position(const point<double>& from, const point<double>& to, std::size_t axis) const {
        const double a = from.*coordinate_axes[axis], b = to.*coordinate_axes[axis];
        if (a == b) return ring_.interpolated({ring_.coordinate(a, axis)});
        return ring_.interpolated({ring_.coordinate(a, axis), ring_.coordinate(b, axis)});
    }
    static element applied(const std::array<element, 3>& row, const std::array<element, 3>& x) {
        return row[0] * x[0] + row[1] * x[1] + row[2] * x[2];
    }

    homogeneous_point<Ring> at(const affine_motion& m, const body_point& p) {
        const int unit = std::min(common_exponent(m.a0), common_exponent(m.a1));
        if (last_ != p.motion) {
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t j = 0; j < 3; ++j)
                    rotation_[i][j] = linear(m.a0[i][j], m.a1[i][j], unit);
            last_ = p.motion;
        }
        const int unit_of_rest = ring_.unit(0) - unit;
        const auto x = rest_of(p.rest, {}, unit_of_rest);
        return {path_of([&](std::size_t i) {
                    return applied(rotation_[i], x) + position(m.p0, m.p1, i);
                }),
                std::nullopt};
    }
    homogeneous_point<Ring> at(const rigid_motion& m, const body_point& p) {
        const auto x = rest_of(p.rest, m.centre, ring_.unit(0));
        if (never_turns(m))
            return {path_of([&](std::size_t i) { return x[i] + position(m.p0, m.p1, i); }),
                    std::nullopt};
        if (last_ != p.motion) {
            set_rotation(m);
            last_ = p.motion;
        }
        return {path_of([&](std::size_t i) {
                    return applied(rotation_[i], x) + weight_ * position(m.p0, m.p1, i);
                }),
                weight_};
    }
    std::array<element, 3> rest_of(const point<double>& rest, const point<double>& centre,
                                   int unit) const {
        const auto difference = [&](double x, double c) {
            if (c == 0) return constant(ring_.in_unit(x, unit));
            return constant(ring_.in_unit(x, unit) - ring_.in_unit(c, unit));
        };
        return {difference(rest.x, centre.x), difference(rest.y, centre.y),
                difference(rest.z, centre.z)};
    }
    void set_rotation(const rigid_motion& m) {
        const int unit = std::min(common_exponent(m.q0), common_exponent(m.q1));
        const auto r =
            rotation_of<element>({linear(m.q0.w, m.q1.w, unit), linear(m.q0.x, m.q1.x, unit),
                                  linear(m.q0.y, m.q1.y, unit), linear(m.q0.z, m.q1.z, unit)});
        rotation_ = r.matrix;
        weight_ = r.weight;
    }

    const Ring& ring_;
    const body_motion* last_ = nullptr;
    matrix rotation_;
    element weight_;

  public:
    /// True if R(t) is the identity at all t.
    static bool never_turns(const rigid_motion& m) {
        const auto is_real = [](const quaternion& q) { return q.x == 0 && q.y == 0 && q.z == 0; };
        return is_real(m.q0) && is_real(m.q1);
    }
};

inline bool have_one_weight(const curve&, const curve&) {
    return true;
}
inline bool have_one_weight(const rational_curve& p, const rational_curve& q) {
    return std::equal(p.weights.begin(), p.weights.end(), q.weights.begin(), q.weights.end());
}
inline bool have_one_weight(const body_point& p, const body_point& q) {
    if (p.motion == q.motion) return true;
    const auto *a = std::get_if<rigid_motion>(p.motion), *b = std::get_if<rigid_motion>(q.motion);
    return a && b && a->q0 == b->q0 && a->q1 == b->q1;
}

// ---- Validity, boxes, origins ----

inline bool is_finite(const point<double>& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}
inline bool is_valid(const curve& p) {
    return !p.empty() && std::all_of(p.begin(), p.end(), is_finite);
}
inline bool is_valid(const rational_curve& p) {
    return is_valid(p.points) && fault_of(p).empty();
}
/// True if fault_of reports nothing.
bool is_valid(const body_motion& motion);
/// True if all points are valid.
template <class Motion>
bool are_valid(std::span<const Motion> points) {
    return std::all_of(points.begin(), points.end(), [](const Motion& p) { return is_valid(p); });
}
inline bool are_valid(std::span<const body_point> points) {
    const body_motion* last = nullptr;
    for (const body_point& p : points) {
        if (p.motion == nullptr || !is_finite(p.rest)) return false;
        if (p.motion != last && !is_valid(*p.motion)) return false;
        last = p.motion;
    }
    return true;
}

inline point<double> origin_of(const curve& p) {
    return p[0];
}
inline point<double> origin_of(const rational_curve& p) {
    return p.points[0];
}
/// Any finite point is an origin; bounds are best if it is near the points.
inline point<double> origin_of(const body_point& p) {
    if (const auto* affine = std::get_if<affine_motion>(p.motion)) return affine->p0;
    if (const auto* rigid = std::get_if<rigid_motion>(p.motion)) return rigid->p0;
    return p.rest;
}

inline bool is_of_low_degree(const curve& p) {
    return p.size() - 1 <= tracked_ring::max_degree;
}
inline bool is_of_low_degree(const rational_curve& p) {
    return is_of_low_degree(p.points);
}
inline bool is_of_low_degree(const body_point&) {
    return true;
}

/// A box that contains the point at all t.
struct motion_box {
    std::array<double, 3> low, high;
};
inline motion_box box_of(const curve& p) {
    const double infinity = std::numeric_limits<double>::infinity();
    motion_box box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (const point<double>& c : p)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.low[axis] = std::min(box.low[axis], c.*coordinate_axes[axis]);
            box.high[axis] = std::max(box.high[axis], c.*coordinate_axes[axis]);
        }
    return box;
}
/// The weights are positive, so the control points' convex hull contains the curve.
inline motion_box box_of(const rational_curve& p) {
    return box_of(p.points);
}

}  // namespace ccd::detail
