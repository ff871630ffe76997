#include "ccd/contact/curve_filter.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace ccd::detail {
namespace {

using errbound::sign_type;
using number = tracked_ring::scalar;
using polynomial = tracked_polynomial;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Extends the interval by x's values. The last rounding needs at most one double more.
void include(const number& x, double& low, double& high) {
    const double below = x.value() - x.error(), above = x.value() + x.error();
    low = std::isfinite(below) ? std::min(low, std::nextafter(below, -infinity)) : -infinity;
    high = std::isfinite(above) ? std::max(high, std::nextafter(above, infinity)) : infinity;
}

bool is_excluded(const condition<polynomial>& c) {
    const auto excludes = [&](const polynomial& p) {
        const sign_type s = p.sign_throughout();
        return s == sign_type::positive || (s == sign_type::negative && !c.also_below);
    };
    const auto is_negative = [](const polynomial& p) {
        return p.sign_throughout() == sign_type::negative;
    };
    if (std::any_of(c.vanishing.begin(), c.vanishing.end(), excludes)) return true;
    const auto sides = c.sides();
    return std::any_of(sides.nonnegative.begin(), sides.nonnegative.end(), is_negative);
}

}  // namespace

motion_box box_of(const homogeneous_point<tracked_ring>& p) {
    motion_box box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    const std::array h{&p.h.x[0], &p.h.y[0], &p.h.z[0]};
    const polynomial weight = p.weight ? *p.weight : polynomial({number(1)});
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t size = std::max(h[axis]->size(), weight.size());
        const std::vector<number> above = h[axis]->elevated_to(size),
                                  below = weight.elevated_to(size);
        for (std::size_t i = 0; i < size; ++i) {
            if (sign_of(below[i]) != sign_type::positive)
                box.low[axis] = -infinity, box.high[axis] = infinity;
            else
                include(above[i] / below[i], box.low[axis], box.high[axis]);
        }
    }
    return box;
}

bool boxes_are_separate(std::span<const motion_box> boxes, std::size_t first, double distance) {
    // Rounding is monotone: if the rounded difference exceeds a double, so does the difference.
    const auto above = [&](std::span<const motion_box> p, std::span<const motion_box> q,
                           std::size_t axis) {
        double low = infinity, high = -infinity;
        for (const motion_box& b : p) low = std::min(low, b.low[axis]);
        for (const motion_box& b : q) high = std::max(high, b.high[axis]);
        return low - high > distance;
    };
    const auto p = boxes.first(first), q = boxes.subspan(first);
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (above(p, q, axis) || above(q, p, axis)) return true;
    return false;
}

template <kind K>
bool certainly_separate(const paths<K, polynomial>& q) {
    if constexpr (is_cubic(K)) {
        const sign_type s = forms_of(q).y()[0].sign_throughout();
        if (s == sign_type::positive || s == sign_type::negative) return true;
    }
    const auto conditions = contact_conditions<K>(q);
    return std::all_of(conditions.begin(), conditions.end(), is_excluded);
}

template <kind K>
std::vector<bool> possible_conditions(const paths<K, polynomial>& q, const polynomial& squared) {
    std::vector<bool> possible;
    visit_distance_conditions<K>(
        q, squared, [&](const auto& make) { possible.push_back(!is_excluded(make())); });
    return possible;
}

template bool certainly_separate(const paths<kind::vertex_face, polynomial>&);
template bool certainly_separate(const paths<kind::edge_edge, polynomial>&);
template bool certainly_separate(const paths<kind::vertex_edge, polynomial>&);
template bool certainly_separate(const paths<kind::vertex_vertex, polynomial>&);
template std::vector<bool> possible_conditions(const paths<kind::vertex_face, polynomial>&,
                                               const polynomial&);
template std::vector<bool> possible_conditions(const paths<kind::edge_edge, polynomial>&,
                                               const polynomial&);
template std::vector<bool> possible_conditions(const paths<kind::vertex_edge, polynomial>&,
                                               const polynomial&);
template std::vector<bool> possible_conditions(const paths<kind::vertex_vertex, polynomial>&,
                                               const polynomial&);

}  // namespace ccd::detail
