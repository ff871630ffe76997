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

/// Returns nothing if the stages of ccd/contact/turning/body_filter.hpp do not decide.
template <kind K>
std::optional<first_time> decided_as_bodies(std::span<const body_point> points,
                                            const control_maps& a, const control_maps& b,
                                            separation d, double t_max, answer wanted) {
    if (t_max < 0) return never;
    const body_filter<K> bodies(points, a, b);
    const bool contact = d.first == 0 && d.second == 0;
    if (bodies.separated_by_axes(contact ? 0 : rounded_up_sum(d))) return never;
    if constexpr (is_cubic(K)) {
        if (!contact) return {};
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
            case outcome::uncertain:
                break;
        }
    }
    return {};
}

}  // namespace

template <kind K>
first_time first_within_of_bodies(std::span<const body_point> points, const control_maps& a,
                                  const control_maps& b, separation d, double t_max,
                                  answer wanted) {
    if (const auto decided = decided_as_bodies<K>(points, a, b, d, t_max, wanted)) return *decided;
    polynomial_source y;
    if constexpr (is_cubic(K)) y = [&] { return y_of_bodies<K>(points); };
    return first_of_valid<K>(points, d, t_max, arithmetic::floating_point_first, y);
}

template <curve_query Query>
first_time first_within(const Query& query, separation d, double t_max, answer wanted) {
    constexpr kind K = kind_of<Query>;
    const auto all = points_of(query);
    const std::span<const body_point> points(all);
    if (!is_distance(d) || !std::isfinite(t_max) || !are_valid(points)) return {};
    if (has_two_bodies<K>(points)) {
        const control_maps a(*points.front().motion), b(*points.back().motion);
        return first_within_of_bodies<K>(points, a, b, d, t_max, wanted);
    }
    return first_of_valid<K>(points, d, t_max, arithmetic::floating_point_first, {});
}

template first_time first_within(const vertex_face_of<body_point>&, separation, double, answer);
template first_time first_within(const edge_edge_of<body_point>&, separation, double, answer);
template first_time first_within(const vertex_edge_of<body_point>&, separation, double, answer);
template first_time first_within(const vertex_vertex_of<body_point>&, separation, double, answer);

template first_time first_within_of_bodies<kind::vertex_face>(std::span<const body_point>,
                                                              const control_maps&,
                                                              const control_maps&, separation,
                                                              double, answer);
template first_time first_within_of_bodies<kind::edge_edge>(std::span<const body_point>,
                                                            const control_maps&,
                                                            const control_maps&, separation, double,
                                                            answer);
template first_time first_within_of_bodies<kind::vertex_edge>(std::span<const body_point>,
                                                              const control_maps&,
                                                              const control_maps&, separation,
                                                              double, answer);
template first_time first_within_of_bodies<kind::vertex_vertex>(std::span<const body_point>,
                                                                const control_maps&,
                                                                const control_maps&, separation,
                                                                double, answer);

}  // namespace ccd::detail
