#include "ccd/contact/first_times.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>

#include "ccd/contact/condition.hpp"
#include "ccd/contact/feature_conditions.hpp"

namespace ccd::detail {
namespace {

template <kind K>
paths<K> paths_of(std::span<const control_polygon> points, const axis_exponents& unit) {
    const auto at = [&](std::size_t i) { return path_of(points[i], unit); };
    constexpr std::size_t count = kind_traits<K>::first_vertices + kind_traits<K>::second_vertices;
    if constexpr (count == 4)
        return {at(0), at(1), at(2), at(3)};
    else if constexpr (count == 3)
        return {at(0), at(1), at(2)};
    else
        return {at(0), at(1)};
}

bool are_finite(std::span<const control_polygon> points) {
    return std::all_of(points.begin(), points.end(), [](const control_polygon& p) {
        return std::all_of(p.begin(), p.end(), [](const point<double>& x) {
            return std::isfinite(x.x) && std::isfinite(x.y) && std::isfinite(x.z);
        });
    });
}

/// The answer that needs no algebra, if there is one.
bool is_answered(std::span<const control_polygon> points, double t_max, first_time& answer) {
    if (!are_finite(points) || !std::isfinite(t_max)) return true;
    if (t_max < 0) answer.outcome = outcome::separate;
    return t_max < 0;
}

}  // namespace

template <kind K>
first_time first_contact_of(std::span<const control_polygon> points, double t_max) {
    first_time answer;
    if (is_answered(points, t_max, answer)) return answer;
    const auto q = paths_of<K>(points, whole_exponents(points));
    if constexpr (K == kind::vertex_face || K == kind::edge_edge) {
        const staged_polynomial y = staged(forms_of(q).y());
        if (!y.is_zero())
            return first_time_at_roots(
                y, [&] { return contact_conditions<K>(q); }, t_max);
    }
    return first_time_of(contact_conditions<K>(q), t_max);
}

template <kind K>
first_time first_within_of(std::span<const control_polygon> points, separation d, double t_max) {
    first_time answer;
    if (!std::isfinite(d.first) || !std::isfinite(d.second) || d.first < 0 || d.second < 0)
        return answer;
    if (d.first == 0 && d.second == 0) return first_contact_of<K>(points, t_max);
    if (is_answered(points, t_max, answer)) return answer;
    // One unit for all axes and for d: distance is not what it is if they differ.
    const axis_exponents own = whole_exponents(points);
    const auto last_bit = [](double x) { return errbound::integers::binary_double(x).last_bit(); };
    const int unit = std::min({own.x, own.y, own.z, last_bit(d.first), last_bit(d.second)});
    const integer distance = whole(d.first, unit) + whole(d.second, unit);
    const time_polynomial squared({integer(distance * distance)});
    return first_time_of(distance_conditions<K>(paths_of<K>(points, {unit, unit, unit}), squared),
                         t_max);
}

template first_time first_contact_of<kind::vertex_face>(std::span<const control_polygon>, double);
template first_time first_contact_of<kind::edge_edge>(std::span<const control_polygon>, double);
template first_time first_contact_of<kind::vertex_edge>(std::span<const control_polygon>, double);
template first_time first_contact_of<kind::vertex_vertex>(std::span<const control_polygon>, double);
template first_time first_within_of<kind::vertex_face>(std::span<const control_polygon>, separation,
                                                       double);
template first_time first_within_of<kind::edge_edge>(std::span<const control_polygon>, separation,
                                                     double);
template first_time first_within_of<kind::vertex_edge>(std::span<const control_polygon>, separation,
                                                       double);
template first_time first_within_of<kind::vertex_vertex>(std::span<const control_polygon>,
                                                         separation, double);

}  // namespace ccd::detail
