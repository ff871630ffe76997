#include "ccd/contact/first_times.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <errbound/integers/binary_double.hpp>
#include <vector>

#include "ccd/contact/condition.hpp"
#include "ccd/contact/curve_filter.hpp"
#include "ccd/contact/feature_conditions.hpp"
#include "ccd/contact/time_polynomial.hpp"

namespace ccd::detail {
namespace {

constexpr first_time never{outcome::separate, 0, 0};

template <kind K>
paths<K, time_polynomial> in_units(std::span<const curve> points, const axis_exponents& unit) {
    return paths_of<K, time_polynomial>(points, [&](const curve& p) -> path<time_polynomial> {
        return {{{coordinate_in_time(p, &point<double>::x, unit.x)}},
                {{coordinate_in_time(p, &point<double>::y, unit.y)}},
                {{coordinate_in_time(p, &point<double>::z, unit.z)}}};
    });
}

/// Contact does not depend on units, so each axis has its own.
template <kind K>
first_time first_contact(std::span<const curve> points, double t_max, arithmetic by) {
    const bool filtered = by == arithmetic::floating_point_first;
    if (filtered && certainly_separate<K>(points)) return never;
    const auto q = in_units<K>(points, whole_exponents(points));
    if constexpr (is_cubic(K)) {
        const time_polynomial y = forms_of(q).y()[0];
        if (!y.is_zero()) {
            root_test test{{}, [&] { return contact_conditions<K>(q); }};
            if (filtered)
                test.holds_at = [&](const auto& t) { return touches_at_root<K>(points, t); };
            return first_time_at_roots(y, test, t_max);
        }
    }
    return first_time_of(contact_conditions<K>(q), t_max);
}

/// Uses one unit for all axes and d.
template <kind K>
first_time first_at_distance(std::span<const curve> points, separation d, double t_max,
                             arithmetic by) {
    std::vector<bool> possible;
    if (by == arithmetic::floating_point_first) {
        possible = possible_conditions<K>(points, d);
        if (std::find(possible.begin(), possible.end(), true) == possible.end()) return never;
    }
    const axis_exponents own = whole_exponents(points);
    const auto last_bit = [](double x) { return errbound::integers::binary_double(x).last_bit(); };
    const int unit = std::min({own.x, own.y, own.z, last_bit(d.first), last_bit(d.second)});
    const integer distance = whole(d.first, unit) + whole(d.second, unit);
    const time_polynomial squared({distance * distance});
    exact_conditions conditions;
    std::size_t visited = 0;
    visit_distance_conditions<K>(in_units<K>(points, {unit, unit, unit}), squared,
                                 [&](const auto& make) {
                                     const std::size_t i = visited++;
                                     if (possible.empty() || possible[i])
                                         conditions.push_back(make());
                                 });
    return first_time_of(conditions, t_max);
}

bool is_valid_query(std::span<const curve> points, separation d, double t_max) {
    const auto is_finite = [](const point<double>& p) {
        return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    };
    const auto is_curve = [&](const curve& p) {
        return !p.empty() && std::all_of(p.begin(), p.end(), is_finite);
    };
    return is_distance(d) && std::isfinite(t_max) &&
           std::all_of(points.begin(), points.end(), is_curve);
}

}  // namespace

bool is_distance(separation d) {
    return std::isfinite(d.first) && std::isfinite(d.second) && d.first >= 0 && d.second >= 0;
}

template <kind K>
first_time first_within_of(std::span<const curve> points, separation d, double t_max,
                           arithmetic by) {
    if (!is_valid_query(points, d, t_max)) return {};
    if (t_max < 0) return never;
    return d.first == 0 && d.second == 0 ? first_contact<K>(points, t_max, by)
                                         : first_at_distance<K>(points, d, t_max, by);
}

template first_time first_within_of<kind::vertex_face>(std::span<const curve>, separation, double,
                                                       arithmetic);
template first_time first_within_of<kind::edge_edge>(std::span<const curve>, separation, double,
                                                     arithmetic);
template first_time first_within_of<kind::vertex_edge>(std::span<const curve>, separation, double,
                                                       arithmetic);
template first_time first_within_of<kind::vertex_vertex>(std::span<const curve>, separation, double,
                                                         arithmetic);

}  // namespace ccd::detail
