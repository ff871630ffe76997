#include "ccd/contact/curve_filter.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <errbound/tracked.hpp>
#include <limits>
#include <vector>

#include "ccd/contact/control_polynomial.hpp"
#include "ccd/contact/feature_conditions.hpp"
#include "ccd/exact/features.hpp"

namespace ccd::detail {
namespace {

using errbound::sign_type;
using number = errbound::tracked<double>;
using polynomial = control_polynomial<number>;

/// True if p is certainly above q by more than `distance`. Rounding is monotone: if the rounded
/// difference exceeds a double, so does the difference.
bool above(std::span<const curve> p, std::span<const curve> q, double point<double>::*axis,
           double distance) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const curve& points : p)
        for (const point<double>& x : points) low = std::min(low, x.*axis);
    for (const curve& points : q)
        for (const point<double>& x : points) high = std::max(high, x.*axis);
    return low - high > distance;
}

template <kind K>
bool boxes_are_separate(std::span<const curve> points, double distance) {
    constexpr std::size_t first = kind_traits<K>::first_vertices;
    const auto p = points.first(first), q = points.subspan(first);
    for (const auto axis : {&point<double>::x, &point<double>::y, &point<double>::z})
        if (above(p, q, axis, distance) || above(q, p, axis, distance)) return true;
    return false;
}

/// Binomials up to this degree are exact doubles.
constexpr std::size_t max_degree = 50;
polynomial coordinate(const curve& points, double origin, double point<double>::*axis) {
    const std::size_t degree = points.size() - 1;
    std::vector<number> h;
    double binomial = 1;
    for (std::size_t i = 0; i <= degree; ++i) {
        h.push_back((number(points[i].*axis) - number(origin)) * number(binomial));
        binomial = binomial * static_cast<double>(degree - i) / static_cast<double>(i + 1);
    }
    return polynomial(std::move(h));
}
path<polynomial> path_of(const curve& points, const point<double>& origin) {
    return {{{coordinate(points, origin.x, &point<double>::x)}},
            {{coordinate(points, origin.y, &point<double>::y)}},
            {{coordinate(points, origin.z, &point<double>::z)}}};
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

bool is_of_low_degree(std::span<const curve> points) {
    return std::all_of(points.begin(), points.end(),
                       [](const curve& p) { return p.size() - 1 <= max_degree; });
}
template <kind K>
paths<K, polynomial> relative_paths(std::span<const curve> points) {
    const point<double> origin = points[0][0];
    return paths_of<K, polynomial>(points, [&](const curve& p) { return path_of(p, origin); });
}

/// The point at t relative to `origin`, by de Casteljau's algorithm.
path<number> position(const curve& points, const point<double>& origin, const number& t) {
    const auto along = [&](double origin_there, double point<double>::*axis) {
        std::vector<number> h;
        for (const point<double>& p : points) h.push_back(number(p.*axis) - number(origin_there));
        for (; h.size() > 1; h.pop_back())
            for (std::size_t i = 0; i + 1 < h.size(); ++i) h[i] = h[i] + t * (h[i + 1] - h[i]);
        return errbound::bernstein<number, 0>{{h[0]}};
    };
    return {along(origin.x, &point<double>::x), along(origin.y, &point<double>::y),
            along(origin.z, &point<double>::z)};
}

}  // namespace

template <kind K>
bool certainly_separate(std::span<const curve> points) {
    if (boxes_are_separate<K>(points, 0)) return true;
    if (!is_of_low_degree(points)) return false;
    const auto q = relative_paths<K>(points);
    if constexpr (is_cubic(K)) {
        const sign_type s = forms_of(q).y()[0].sign_throughout();
        if (s == sign_type::positive || s == sign_type::negative) return true;
    }
    const auto conditions = contact_conditions<K>(q);
    return std::all_of(conditions.begin(), conditions.end(), is_excluded);
}

template <kind K>
std::vector<bool> possible_conditions(std::span<const curve> points, separation d) {
    const double infinity = std::numeric_limits<double>::infinity();
    const bool separate =
        boxes_are_separate<K>(points, std::nextafter(d.first + d.second, infinity));
    const bool known = !separate && is_of_low_degree(points);
    const auto q = known ? relative_paths<K>(points) : paths<K, polynomial>{};
    const number distance = number(d.first) + number(d.second);
    std::vector<bool> possible;
    visit_distance_conditions<K>(q, polynomial({distance * distance}), [&](const auto& make) {
        possible.push_back(known ? !is_excluded(make()) : !separate);
    });
    return possible;
}

template <kind K>
outcome touches_at_root(std::span<const curve> points, const number& t) {
    const point<double> origin = points[0][0];
    const auto q =
        paths_of<K, number>(points, [&](const curve& p) { return position(p, origin, t); });
    // If N is not zero, the weights decide contact; if it is zero, all of them are zero.
    return decided_by_weights(forms_of(q));
}

template bool certainly_separate<kind::vertex_face>(std::span<const curve>);
template bool certainly_separate<kind::edge_edge>(std::span<const curve>);
template bool certainly_separate<kind::vertex_edge>(std::span<const curve>);
template bool certainly_separate<kind::vertex_vertex>(std::span<const curve>);
template std::vector<bool> possible_conditions<kind::vertex_face>(std::span<const curve>,
                                                                  separation);
template std::vector<bool> possible_conditions<kind::edge_edge>(std::span<const curve>, separation);
template std::vector<bool> possible_conditions<kind::vertex_edge>(std::span<const curve>,
                                                                  separation);
template std::vector<bool> possible_conditions<kind::vertex_vertex>(std::span<const curve>,
                                                                    separation);
template outcome touches_at_root<kind::vertex_face>(std::span<const curve>, const number&);
template outcome touches_at_root<kind::edge_edge>(std::span<const curve>, const number&);

}  // namespace ccd::detail
