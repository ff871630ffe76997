#include "ccd/contact/first_times.hpp"

#include <algorithm>
#include <cmath>
#include <errbound/integers/binary_double.hpp>

#include "ccd/contact/condition.hpp"
#include "ccd/contact/feature_conditions.hpp"
#include "ccd/contact/time_polynomial.hpp"

namespace ccd::detail {
namespace {

template <kind K>
paths<K, time_polynomial> in_units(std::span<const curve> points, const axis_exponents& unit) {
    return paths_of<K, time_polynomial>(points, [&](const curve& p) -> path<time_polynomial> {
        return {{{coordinate_in_time(p, &point<double>::x, unit.x)}},
                {{coordinate_in_time(p, &point<double>::y, unit.y)}},
                {{coordinate_in_time(p, &point<double>::z, unit.z)}}};
    });
}

/// Each axis has a unit of its own: contact does not depend on them.
template <kind K>
first_time first_contact(std::span<const curve> points, double t_max) {
    const auto q = in_units<K>(points, whole_exponents(points));
    if constexpr (K == kind::vertex_face || K == kind::edge_edge) {
        const time_polynomial y = forms_of(q).y()[0];
        if (!y.is_zero())
            return first_time_at_roots(
                y, [&] { return contact_conditions<K>(q); }, t_max);
    }
    return first_time_of(contact_conditions<K>(q), t_max);
}

/// One unit for all axes and for d.
template <kind K>
first_time first_at_distance(std::span<const curve> points, separation d, double t_max) {
    const axis_exponents own = whole_exponents(points);
    const auto last_bit = [](double x) { return errbound::integers::binary_double(x).last_bit(); };
    const int unit = std::min({own.x, own.y, own.z, last_bit(d.first), last_bit(d.second)});
    const integer distance = whole(d.first, unit) + whole(d.second, unit);
    const auto q = in_units<K>(points, {unit, unit, unit});
    const time_polynomial squared({integer(distance * distance)});
    return first_time_of(distance_conditions<K>(q, squared), t_max);
}

}  // namespace

bool is_distance(separation d) {
    return std::isfinite(d.first) && std::isfinite(d.second) && d.first >= 0 && d.second >= 0;
}

bool is_question(std::span<const curve> points, separation d, double t_max) {
    const auto is_finite = [](const point<double>& p) {
        return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    };
    const auto is_curve = [&](const curve& p) {
        return !p.empty() && std::all_of(p.begin(), p.end(), is_finite);
    };
    return is_distance(d) && std::isfinite(t_max) &&
           std::all_of(points.begin(), points.end(), is_curve);
}

template <kind K>
first_time first_within_of(std::span<const curve> points, separation d, double t_max) {
    if (!is_question(points, d, t_max)) return {};
    if (t_max < 0) return {outcome::separate, 0, 0};
    return d.first == 0 && d.second == 0 ? first_contact<K>(points, t_max)
                                         : first_at_distance<K>(points, d, t_max);
}

template first_time first_within_of<kind::vertex_face>(std::span<const curve>, separation, double);
template first_time first_within_of<kind::edge_edge>(std::span<const curve>, separation, double);
template first_time first_within_of<kind::vertex_edge>(std::span<const curve>, separation, double);
template first_time first_within_of<kind::vertex_vertex>(std::span<const curve>, separation,
                                                         double);

}  // namespace ccd::detail
