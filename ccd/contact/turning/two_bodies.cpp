#include "ccd/contact/turning/two_bodies.hpp"

#include <ccd/methods/transform.hpp>
#include <cmath>
#include <optional>

#include "ccd/contact/condition.hpp"
#include "ccd/contact/first_times.hpp"
#include "ccd/contact/moving_points.hpp"
#include "ccd/contact/turning/body_filter.hpp"
#include "ccd/contact/turning/exact_forms.hpp"

namespace ccd::detail {
namespace {

constexpr first_time never{outcome::separate, 0, 0};

/// A time between two adjacent doubles is at most t_max if the later one is.
first_time up_to(double t_max, const first_time& time) {
    return time.high > t_max ? never : time;
}

/// Returns nothing if the signs of Y and the G_i do not decide in floating point.
template <kind K>
std::optional<first_time> decided_by_signs(std::span<const body_point> points,
                                           const body_filter<K>& bodies, double t_max,
                                           answer wanted) {
    touching_interval part;
    switch (bodies.decide(&part)) {
        case outcome::separate:
            return never;
        case outcome::collides:
            if (part.low > t_max) return never;
            if (wanted == answer::outcome && part.high <= t_max)
                return first_time{outcome::collides, part.low, part.high};
            if (const auto time = bracket_in_fixed_width<K>(points, part))
                return up_to(t_max, {outcome::collides, time->low, time->high});
            return up_to(t_max, first_root_time(y_of_bodies<K>(points), part.low, part.high));
        default:
            return {};
    }
}

/// Same as first_within_of_bodies, for two bodies with these chords.
template <kind K>
first_time first_within_of_two(std::span<const body_point> points, const motion_chords& a,
                               const motion_chords& b, separation d, double t_max, answer wanted) {
    const bool contact = d.first == 0 && d.second == 0;
    const body_filter<K> bodies(points, a, b);
    if (bodies.separated(contact ? 0 : rounded_up_sum(d))) return never;
    if (!are_valid(points)) return {};
    polynomial_source y;
    if constexpr (is_cubic(K)) {
        if (contact && t_max >= 0)
            if (const auto decided = decided_by_signs<K>(points, bodies, t_max, wanted))
                return *decided;
        y = [points] { return y_of_bodies<K>(points); };
    }
    return first_of_valid<K>(points, d, t_max, arithmetic::floating_point_first, y);
}

/// Calls f with the chords of a point's motion, and returns its result.
template <class F>
first_time with_chords(const body_point& p, const F& f) {
    const bool is_prepared = p.prepared != nullptr && &p.prepared->motion() == p.motion;
    return is_prepared ? f(p.prepared->chords()) : f(motion_chords(*p.motion));
}

}  // namespace

template <kind K>
first_time first_within_of_bodies(std::span<const body_point> points, separation d, double t_max,
                                  answer wanted) {
    if (!is_distance(d) || !std::isfinite(t_max)) return {};
    for (const body_point& p : points)
        if (p.motion == nullptr) return {};
    if (!has_two_bodies<K>(points))
        return are_valid(points)
                   ? first_of_valid<K>(points, d, t_max, arithmetic::floating_point_first, {})
                   : first_time{};
    return with_chords(points.front(), [&](const motion_chords& a) {
        return with_chords(points.back(), [&](const motion_chords& b) {
            return first_within_of_two<K>(points, a, b, d, t_max, wanted);
        });
    });
}

template <curve_query Query>
first_time first_within(const Query& query, separation d, double t_max, answer wanted) {
    // The members lie one after the other.
    const auto* points = reinterpret_cast<const body_point*>(&query);
    constexpr std::size_t count = sizeof(query) / sizeof(body_point);
    static_assert(count * sizeof(body_point) == sizeof(query));
    return first_within_of_bodies<kind_of<Query>>({points, count}, d, t_max, wanted);
}

template first_time first_within(const vertex_face_of<body_point>&, separation, double, answer);
template first_time first_within(const edge_edge_of<body_point>&, separation, double, answer);
template first_time first_within(const vertex_edge_of<body_point>&, separation, double, answer);
template first_time first_within(const vertex_vertex_of<body_point>&, separation, double, answer);

template first_time first_within_of_bodies<kind::vertex_face>(std::span<const body_point>,
                                                              separation, double, answer);
template first_time first_within_of_bodies<kind::edge_edge>(std::span<const body_point>, separation,
                                                            double, answer);
template first_time first_within_of_bodies<kind::vertex_edge>(std::span<const body_point>,
                                                              separation, double, answer);
template first_time first_within_of_bodies<kind::vertex_vertex>(std::span<const body_point>,
                                                                separation, double, answer);

}  // namespace ccd::detail
