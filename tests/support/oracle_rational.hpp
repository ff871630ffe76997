// The oracle for rational motion: rational Bézier curves, and points of affine and rigid bodies.
//
// Each point is a vector of polynomials over one polynomial > 0. All points of a query are
// multiplied by the denominators of all others, which scales the whole query by one positive
// factor. Rotations are products of quaternions, q X q̄.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/bodies/motion.hpp>
#include <ccd/curves.hpp>
#include <ccd/methods/transform.hpp>
#include <cstddef>
#include <span>
#include <tuple>
#include <variant>
#include <vector>

#include "tests/support/oracle.hpp"
#include "tests/support/whole_points.hpp"

namespace oracle::detail {

/// The point at/over, in units of 2^unit. `over` is positive in [0, 1].
struct quotient_point {
    vector at;
    polynomial over;
};

/// from (1 − t) + to t, in units of 2^unit.
inline polynomial between(double from, double to, int unit) {
    return from_control_values({scaled(from).in_units_of(unit), scaled(to).in_units_of(unit)});
}

inline int unit_of_numbers(std::initializer_list<double> numbers) {
    int unit = 1024;
    for (const double x : numbers) unit = std::min(unit, scaled(x).exponent);
    return unit;
}
inline int unit_of_point(const ccd::point<double>& p) {
    return unit_of_numbers({p.x, p.y, p.z});
}
/// from (1 − t) + to t for each coordinate.
inline vector between(const ccd::point<double>& from, const ccd::point<double>& to, int unit) {
    return {between(from.x, to.x, unit), between(from.y, to.y, unit), between(from.z, to.z, unit)};
}

using quaternion_polynomial = std::array<polynomial, 4>;  // w x y z
inline quaternion_polynomial product(const quaternion_polynomial& a,
                                     const quaternion_polynomial& b) {
    const auto term = [&](std::size_t i, std::size_t j) { return a[i] * b[j]; };
    return {term(0, 0) - term(1, 1) - term(2, 2) - term(3, 3),
            term(0, 1) + term(1, 0) + term(2, 3) - term(3, 2),
            term(0, 2) + term(2, 0) + term(3, 1) - term(1, 3),
            term(0, 3) + term(3, 0) + term(1, 2) - term(2, 1)};
}

inline int least_unit(const ccd::rational_curve& p) {
    int unit = 1024;
    for (const auto& c : p.points) unit = std::min(unit, unit_of_point(c));
    return unit;
}
inline quotient_point quotient_of(const ccd::rational_curve& p, int unit) {
    std::vector<double> weights(p.weights.begin(), p.weights.end());
    weights.resize(p.points.size(), 1);
    int weight_unit = 1024;
    for (const double w : weights) weight_unit = std::min(weight_unit, scaled(w).exponent);
    quotient_point r;
    std::vector<integer> w, h;
    for (const double x : weights) w.push_back(scaled(x).in_units_of(weight_unit));
    r.over = from_control_values(w);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        h.clear();
        for (std::size_t i = 0; i < w.size(); ++i)
            h.push_back(w[i] * scaled(p.points[i].*axes[axis]).in_units_of(unit));
        r.at[axis] = from_control_values(h);
    }
    return r;
}

inline int least_unit(const ccd::body_point& p) {
    const int rest = unit_of_point(p.rest);
    if (const auto* m = std::get_if<ccd::affine_motion>(p.motion)) {
        int a = 1024;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j)
                a = std::min(a, unit_of_numbers({m->a0[i][j], m->a1[i][j]}));
        return std::min({rest + a, unit_of_point(m->p0), unit_of_point(m->p1)});
    }
    if (const auto* m = std::get_if<ccd::rigid_motion>(p.motion))
        return std::min(
            {rest, unit_of_point(m->p0), unit_of_point(m->p1), unit_of_point(m->centre)});
    return rest;
}
inline quotient_point quotient_of(const ccd::body_point& p, int unit) {
    quotient_point r{{}, {integer(1)}};
    if (const auto* m = std::get_if<ccd::affine_motion>(p.motion)) {
        const int rest = unit_of_point(p.rest);
        r.at = between(m->p0, m->p1, unit);
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) {
                polynomial x{scaled(p.rest.*axes[j]).in_units_of(rest)};
                trim(x);
                r.at[i] = r.at[i] + between(m->a0[i][j], m->a1[i][j], unit - rest) * x;
            }
    } else if (const auto* m = std::get_if<ccd::rigid_motion>(p.motion)) {
        const int q_unit = std::min(unit_of_numbers({m->q0.w, m->q0.x, m->q0.y, m->q0.z}),
                                    unit_of_numbers({m->q1.w, m->q1.x, m->q1.y, m->q1.z}));
        const quaternion_polynomial q{
            between(m->q0.w, m->q1.w, q_unit), between(m->q0.x, m->q1.x, q_unit),
            between(m->q0.y, m->q1.y, q_unit), between(m->q0.z, m->q1.z, q_unit)};
        const vector x = between(p.rest, p.rest, unit) - between(m->centre, m->centre, unit);
        const quaternion_polynomial conjugate{q[0], -q[1], -q[2], -q[3]};
        const auto turned = product(product(q, {polynomial(), x[0], x[1], x[2]}), conjugate);
        r.over = product(q, conjugate)[0];
        const vector shift = between(m->p0, m->p1, unit);
        for (std::size_t axis = 0; axis < 3; ++axis)
            r.at[axis] = turned[axis + 1] + r.over * shift[axis];
    } else {
        r.at = between(p.rest, p.rest, unit);
    }
    return r;
}

/// Calls decide(query of vectors, common factor), in units of 2^unit.
template <template <class> class Query, class Motion, class Decide>
bool with_common_factor(const Query<Motion>& query, int unit, const Decide& decide) {
    const auto points = ccd::points_of(query);
    std::vector<quotient_point> all;
    for (const Motion& p : points) all.push_back(quotient_of(p, unit));
    std::array<vector, std::tuple_size_v<decltype(ccd::points_of(query))>> scaled_points;
    // Equal denominators count once.
    std::vector<polynomial> factors;
    for (const auto& p : all)
        if (std::ranges::find(factors, p.over) == factors.end()) factors.push_back(p.over);
    polynomial common{integer(1)};
    for (const polynomial& f : factors) common = common * f;
    for (std::size_t i = 0; i < all.size(); ++i) {
        scaled_points[i] = all[i].at;
        for (const polynomial& f : factors)
            if (f != all[i].over)
                for (polynomial& x : scaled_points[i]) x = x * f;
    }
    return std::apply([&](const auto&... p) { return decide(Query<vector>{p...}, common); },
                      scaled_points);
}

template <class Query>
int least_unit_of(const Query& query) {
    int unit = 1024;
    for (const auto& p : ccd::points_of(query)) unit = std::min(unit, least_unit(p));
    return unit;
}

}  // namespace oracle::detail

namespace oracle {

template <template <class> class Query, rational_motion Motion>
bool collides(const Query<Motion>& query, shortcuts, const interval& when) {
    if (detail::is_empty(when)) return false;
    return detail::with_common_factor(query, detail::least_unit_of(query),
                                      [&](const auto& q, const auto&) {
                                          return detail::collides_of(q, detail::stretch_of(when));
                                      });
}
template <template <class> class Query, rational_motion Motion>
bool within(const Query<Motion>& query, double d1, double d2, shortcuts use, const interval& when) {
    if (detail::is_empty(when)) return false;
    const int unit = std::min(
        {detail::least_unit_of(query), detail::scaled(d1).exponent, detail::scaled(d2).exponent});
    const detail::integer d =
        detail::scaled(d1).in_units_of(unit) + detail::scaled(d2).in_units_of(unit);
    using detail::operator*;
    return detail::with_common_factor(query, unit, [&](const auto& q, const auto& common) {
        detail::polynomial square{d * d};
        detail::trim(square);
        return detail::within_of(q, common * common * square, use, detail::stretch_of(when));
    });
}

}  // namespace oracle
