// The oracle's decision of distance. The distance of two features is that of the origin from the
// hull of the differences of their vertices. The hull is a point, a segment, a triangle, or for two
// edges a parallelogram. Signs determine its nearest point at an instant: x is nearest if and only
// if (c - x).x >= 0 for every corner c.
#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <vector>

#include "tests/support/instants.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/whole_points.hpp"

namespace oracle {
namespace {

using namespace detail;

// A corner, a side without its ends, or the interior of the hull.
struct region {
    // The hull's nearest point lies in the region if these are >= 0 and > 0.
    std::vector<polynomial> at_least_0 = {}, above_0 = {};
    // Then this has the sign of that point's distance minus the given distance.
    polynomial excess = {};

    bool has_nearest(const instant& t) const {
        const auto sign = [&](const polynomial& p) { return t.sign(p); };
        return std::ranges::all_of(
                   above_0, [](int s) { return s > 0; }, sign) &&
               std::ranges::all_of(
                   at_least_0, [](int s) { return s >= 0; }, sign);
    }
};

// The hull of the corners, which are in order around it, and the square of the given distance.
template <std::size_t count>
class hull {
  public:
    hull(const std::array<vector, count>& corners, const polynomial& square)
        : corners_(corners), square_(square) {
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t j = 0; j < count; ++j) products_[i][j] = dot(corners[i], corners[j]);
        for (std::size_t i = 0; i < count; ++i) regions_.push_back(corner(i));
        if (count >= 2) regions_.push_back(side(0, 1));
        if (count >= 3) {
            for (std::size_t i = 1; i < count; ++i) regions_.push_back(side(i, (i + 1) % count));
            regions_.push_back(inside());
        }
        // If no other region has the nearest point, the last one has it.
        regions_.back().at_least_0.clear();
        regions_.back().above_0.clear();
    }

    bool is_near(const instant& t) const {
        const auto region = std::ranges::find_if(
            regions_, [&](const auto& candidate) { return candidate.has_nearest(t); });
        return t.sign(region->excess) <= 0;
    }

    // The distance is continuous, so the times at which the features are near are closed intervals.
    // Just outside an end of such an interval, one region has the nearest point (polynomials change
    // sign finitely often), and its excess is positive there. At the end its excess is 0. So roots
    // of the excesses suffice, with the stretch's ends, or its middle if neither belongs to it.
    // Without this shortcut, the roots of all polynomials are tested.
    bool is_near_somewhere(const stretch& when, shortcuts use) const {
        std::vector<polynomial> roots_of;
        for (const region& r : regions_) {
            roots_of.push_back(r.excess);
            if (use == shortcuts::on) continue;
            roots_of.insert(roots_of.end(), r.at_least_0.begin(), r.at_least_0.end());
            roots_of.insert(roots_of.end(), r.above_0.begin(), r.above_0.end());
        }
        return holds_somewhere(when, roots_of, [this](const instant& t) { return is_near(t); });
    }

  private:
    region corner(std::size_t i) const {
        region r{.excess = products_[i][i] - square_};
        for (std::size_t j = 0; j < count; ++j)
            if (j != i) r.at_least_0.push_back(products_[i][j] - products_[i][i]);
        return r;
    }

    // The origin's projection on the line through two corners is their mean with weights w, divided
    // by the sum of the weights. The sum is the square of the side's length. If a weight is 0, the
    // projection is a corner.
    region side(std::size_t i, std::size_t j) const {
        const polynomial& ij = products_[i][j];
        const polynomial wi = products_[j][j] - ij, wj = products_[i][i] - ij;
        const polynomial area = products_[i][i] * products_[j][j] - ij * ij;
        region r{.above_0 = {wi, wj}, .excess = area - square_ * (wi + wj)};
        for (std::size_t k = 0; k < count; ++k)
            if (k != i && k != j)
                r.at_least_0.push_back(wi * products_[i][k] + wj * products_[j][k] - area);
        return r;
    }

    region inside() const {
        const vector normal = cross(corners_[1] - corners_[0], corners_[2] - corners_[0]);
        const polynomial height = dot(normal, corners_[0]);
        return {.excess = height * height - square_ * dot(normal, normal)};
    }

    std::array<vector, count> corners_;
    std::array<std::array<polynomial, count>, count> products_;
    polynomial square_;
    std::vector<region> regions_;
};

// True if on one axis all corners are on one side of the origin and farther than the distance, at
// both ends of the step. If they move along lines, this holds throughout.
template <std::size_t count>
bool beyond_on_an_axis(const std::array<vector, count>& corners, const integer& distance) {
    const auto all_above = [&](std::size_t axis, int side) {
        return std::ranges::all_of(corners, [&](const vector& c) {
            integer at = 0;
            const auto above = [&](const integer& coefficient) {
                at += coefficient;  // the position at the start, then at the end
                return side * at > distance;
            };
            return !c[axis].empty() && c[axis].size() <= 2 && std::ranges::all_of(c[axis], above);
        });
    };
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (all_above(axis, 1) || all_above(axis, -1)) return true;
    return false;
}

std::array<vector, 3> corners_of(const ccd::vertex_face_of<vector>& q) {
    return {q.f0 - q.v, q.f1 - q.v, q.f2 - q.v};
}
std::array<vector, 4> corners_of(const ccd::edge_edge_of<vector>& q) {
    return {q.b0 - q.a0, q.b1 - q.a0, q.b1 - q.a1, q.b0 - q.a1};
}
std::array<vector, 2> corners_of(const ccd::vertex_edge_of<vector>& q) {
    return {q.e0 - q.v, q.e1 - q.v};
}
std::array<vector, 1> corners_of(const ccd::vertex_vertex_of<vector>& q) {
    return {q.w - q.v};
}

template <class Query>
bool is_near_somewhere(const Query& query, const polynomial& square, shortcuts use,
                       const stretch& when) {
    const auto corners = corners_of(query);
    return hull<std::tuple_size_v<decltype(corners_of(query))>>(corners, square)
        .is_near_somewhere(when, use);
}

// `make(points)` returns the query of the points.
template <std::size_t count, class Make>
bool decide_within(const std::array<ccd::curve, count>& points, double d1, double d2, shortcuts use,
                   const interval& when, const Make& make) {
    if (is_empty(when)) return false;
    const int unit = std::min({unit_of(points, 0), unit_of(points, 1), unit_of(points, 2),
                               scaled(d1).exponent, scaled(d2).exponent});
    const integer distance = scaled(d1).in_units_of(unit) + scaled(d2).in_units_of(unit);
    const auto query = make(in_units(points, {unit, unit, unit}));
    if (use == shortcuts::on && beyond_on_an_axis(corners_of(query), distance)) return false;
    polynomial square{distance * distance};
    trim(square);
    return within_of(query, square, use, stretch_of(when));
}

}  // namespace

namespace detail {

bool within_of(const ccd::vertex_face_of<vector>& q, const polynomial& square, shortcuts use,
               const stretch& when) {
    return is_near_somewhere(q, square, use, when);
}
bool within_of(const ccd::edge_edge_of<vector>& q, const polynomial& square, shortcuts use,
               const stretch& when) {
    return is_near_somewhere(q, square, use, when);
}
bool within_of(const ccd::vertex_edge_of<vector>& q, const polynomial& square, shortcuts use,
               const stretch& when) {
    return is_near_somewhere(q, square, use, when);
}
bool within_of(const ccd::vertex_vertex_of<vector>& q, const polynomial& square, shortcuts use,
               const stretch& when) {
    return is_near_somewhere(q, square, use, when);
}

}  // namespace detail

bool within(const ccd::vertex_face_curves& query, double d1, double d2, shortcuts use,
            const interval& when) {
    return decide_within(std::array{query.v, query.f0, query.f1, query.f2}, d1, d2, use, when,
                         [](const auto& p) {
                             return ccd::vertex_face_of<vector>{p[0], p[1], p[2], p[3]};
                         });
}

bool within(const ccd::edge_edge_curves& query, double d1, double d2, shortcuts use,
            const interval& when) {
    return decide_within(std::array{query.a0, query.a1, query.b0, query.b1}, d1, d2, use, when,
                         [](const auto& p) {
                             return ccd::edge_edge_of<vector>{p[0], p[1], p[2], p[3]};
                         });
}

bool within(const ccd::vertex_edge_curves& query, double d1, double d2, shortcuts use,
            const interval& when) {
    return decide_within(std::array{query.v, query.e0, query.e1}, d1, d2, use, when,
                         [](const auto& p) {
                             return ccd::vertex_edge_of<vector>{p[0], p[1], p[2]};
                         });
}

bool within(const ccd::vertex_vertex_curves& query, double d1, double d2, shortcuts use,
            const interval& when) {
    return decide_within(std::array{query.v, query.w}, d1, d2, use, when, [](const auto& p) {
        return ccd::vertex_vertex_of<vector>{p[0], p[1]};
    });
}

}  // namespace oracle
