// The oracle's decision of distance. The distance of two features is that of the origin from the
// hull of the differences of their vertices. The hull is a point, a segment, a triangle, or for two
// edges a parallelogram. Signs determine its nearest point at an instant: x is nearest if and only
// if (c - x).x >= 0 for every corner c.
#include <algorithm>
#include <array>
#include <ccd/methods/transform.hpp>
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

template <class Query>
auto corners_of(const Query& q) {
    if constexpr (ccd::kind_of<Query> == ccd::kind::edge_edge)
        return std::array{q.b0 - q.a0, q.b1 - q.a0, q.b1 - q.a1, q.b0 - q.a1};
    else
        return ccd::detail::with_members(q, [](const vector& v, const auto&... corner) {
            return std::array<vector, sizeof...(corner)>{corner - v...};
        });
}

}  // namespace

namespace detail {

template <template <class> class Query>
bool within_of(const Query<vector>& query, const polynomial& square, shortcuts use,
               const stretch& when) {
    return hull(corners_of(query), square).is_near_somewhere(when, use);
}

}  // namespace detail

template <template <class> class Query>
bool within(const Query<ccd::curve>& query, double d1, double d2, shortcuts use,
            const interval& when) {
    if (is_empty(when)) return false;
    const auto points = ccd::points_of(query);
    const int unit = std::min({unit_of(points, 0), unit_of(points, 1), unit_of(points, 2),
                               scaled(d1).exponent, scaled(d2).exponent});
    const integer distance = scaled(d1).in_units_of(unit) + scaled(d2).in_units_of(unit);
    const auto whole = std::apply([](const auto&... p) { return Query<vector>{p...}; },
                                  in_units(points, {unit, unit, unit}));
    if (use == shortcuts::on && beyond_on_an_axis(corners_of(whole), distance)) return false;
    polynomial square{distance * distance};
    trim(square);
    return within_of(whole, square, use, stretch_of(when));
}

#define ERRBOUND_ORACLE_OF(KIND)                                                                 \
    template bool detail::within_of(const ccd::KIND##_of<vector>&, const polynomial&, shortcuts, \
                                    const stretch&);                                             \
    template bool within(const ccd::KIND##_of<ccd::curve>&, double, double, shortcuts,           \
                         const interval&);
ERRBOUND_ORACLE_OF(vertex_face)
ERRBOUND_ORACLE_OF(edge_edge)
ERRBOUND_ORACLE_OF(vertex_edge)
ERRBOUND_ORACLE_OF(vertex_vertex)
#undef ERRBOUND_ORACLE_OF

}  // namespace oracle
