#include "ccd/bodies/swept_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

#include "ccd/contact/moving_points.hpp"

namespace ccd::detail {
namespace {

using number = tracked_ring::scalar;
using evaluated = homogeneous_point<tracked_ring>;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double largest = std::numeric_limits<double>::max();

/// The motion about the centre 0, and its part without translation.
std::array<body_motion, 2> parts_of(const body_motion& motion) {
    body_motion about_zero = motion;
    if (auto* rigid = std::get_if<rigid_motion>(&about_zero)) rigid->centre = {};
    body_motion linear = about_zero;
    if (auto* affine = std::get_if<affine_motion>(&linear)) affine->p0 = affine->p1 = {};
    if (auto* rigid = std::get_if<rigid_motion>(&linear)) rigid->p0 = rigid->p1 = {};
    return {about_zero, linear};
}

}  // namespace

swept_points::swept_points(const body_motion& motion, const box<double>& rest) : rest_(rest) {
    if (std::holds_alternative<resting>(motion)) return;
    if (const auto* rigid = std::get_if<rigid_motion>(&motion)) centre_ = rigid->centre;
    const auto [about_zero, linear] = parts_of(motion);
    const tracked_ring ring({0, 0, 0});
    point_evaluator<tracked_ring> evaluate(ring), evaluate_linear(ring);
    // Three columns of the matrix, and the translation.
    const std::array<evaluated, 4> columns{evaluate_linear(body_point{&linear, {1, 0, 0}}),
                                           evaluate_linear(body_point{&linear, {0, 1, 0}}),
                                           evaluate_linear(body_point{&linear, {0, 0, 1}}),
                                           evaluate(body_point{&about_zero, {}})};
    std::size_t size = columns[3].weight ? columns[3].weight->size() : 1;
    for (const evaluated& c : columns)
        size = std::max({size, c.h.x[0].size(), c.h.y[0].size(), c.h.z[0].size()});
    // Without a weight it is 1, whose coefficients after elevation are binomials.
    const std::vector<number> weight =
        (columns[3].weight ? *columns[3].weight : tracked_ring::element({number(1)}))
            .elevated_to(size);
    maps_.resize(size);
    for (std::size_t j = 0; j < 4; ++j) {
        const std::array rows{&columns[j].h.x[0], &columns[j].h.y[0], &columns[j].h.z[0]};
        for (std::size_t i = 0; i < 3; ++i) {
            const std::vector<number> h = rows[i]->elevated_to(size);
            for (std::size_t k = 0; k < size; ++k) {
                const number value = h[k] / weight[k];
                double& error = j < 3 ? error_of_linear_[i][j] : error_of_shift_[i];
                (j < 3 ? maps_[k].linear[i][j] : maps_[k].shift[i]) = value.value();
                error = std::max(error, value.error());
            }
        }
    }
    set_error();
}

/// A control point has the errors of the map, and at most 16 roundings. Each is at most 2^-53 of
/// the sum of its terms' magnitudes, or 2^-1075.
void swept_points::set_error() {
    const std::array centre{centre_.x, centre_.y, centre_.z};
    for (std::size_t i = 0; i < 3; ++i) {
        double most = 0, error = error_of_shift_[i];
        for (const affine_map& map : maps_) most = std::max(most, std::abs(map.shift[i]));
        for (std::size_t j = 0; j < 3; ++j) {
            const double x =
                std::max(std::abs(rest_.low[j]), std::abs(rest_.high[j])) + std::abs(centre[j]);
            double entry = 0;
            for (const affine_map& map : maps_) entry = std::max(entry, std::abs(map.linear[i][j]));
            most += entry * x;
            error += error_of_linear_[i][j] * x;
        }
        error_[i] = 1.0001 * (error + 0x1p-49 * most) + 0x1p-1070;
    }
}

/// ends_of(map, i) returns the least and greatest coordinate i of the control points.
template <class EndsOf>
box<double> swept_points::box_around(const EndsOf& ends_of) const {
    box<double> b;
    for (std::size_t i = 0; i < 3; ++i) {
        double low = infinity, high = -infinity;
        for (const affine_map& map : maps_) {
            const auto [least, greatest] = ends_of(map, i);
            low = std::min(low, least);
            high = std::max(high, greatest);
        }
        // Overflow: an infinite or undefined coordinate may be lost in the comparisons above.
        if (!(error_[i] < infinity)) low = -largest, high = largest;
        b.low[i] = std::max(-largest, std::nextafter(low - error_[i], -infinity));
        b.high[i] = std::min(largest, std::nextafter(high + error_[i], infinity));
    }
    return b;
}

box<double> swept_points::box_of(const point<double>& x) const {
    if (maps_.empty()) return {{x.x, x.y, x.z}, {x.x, x.y, x.z}};
    const std::array from_centre{x.x - centre_.x, x.y - centre_.y, x.z - centre_.z};
    return box_around([&](const affine_map& map, std::size_t i) {
        const auto& row = map.linear[i];
        const double at = row[0] * from_centre[0] + row[1] * from_centre[1] +
                          row[2] * from_centre[2] + map.shift[i];
        return std::pair(at, at);
    });
}

box<double> swept_points::box_of(const box<double>& b) const {
    if (maps_.empty()) return b;
    const std::array centre{centre_.x, centre_.y, centre_.z};
    return box_around([&](const affine_map& map, std::size_t i) {
        double least = map.shift[i], greatest = map.shift[i];
        for (std::size_t j = 0; j < 3; ++j) {
            const double p = map.linear[i][j] * (b.low[j] - centre[j]),
                         q = map.linear[i][j] * (b.high[j] - centre[j]);
            least += std::min(p, q);
            greatest += std::max(p, q);
        }
        return std::pair(least, greatest);
    });
}

box<double> widened(const box<double>& b, double by) {
    if (by == 0) return b;
    box<double> w;
    for (std::size_t i = 0; i < 3; ++i) {
        w.low[i] = std::max(-largest, std::nextafter(b.low[i] - by, -infinity));
        w.high[i] = std::min(largest, std::nextafter(b.high[i] + by, infinity));
    }
    return w;
}

}  // namespace ccd::detail
