#include "ccd/contact/first_times.hpp"

#include <algorithm>
#include <array>
#include <ccd/bodies/motion.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "ccd/contact/condition.hpp"
#include "ccd/contact/curve_filter.hpp"
#include "ccd/contact/feature_conditions.hpp"
#include "ccd/contact/moving_points.hpp"
#include "ccd/contact/time_polynomial.hpp"
#include "ccd/contact/weighted_paths.hpp"
#include "ccd/exact/features.hpp"

namespace ccd::detail {
namespace {

constexpr first_time never{outcome::separate, 0, 0};

template <class Motion>
constexpr bool has_control_points = requires(const Motion& p) {
    box_of(p);
};

/// Bounds of the query in floating point.
template <kind K, class Motion>
class filter {
  public:
    explicit filter(std::span<const Motion> points) : points_(points) {}

    bool boxes_are_separate(double distance) {
        if constexpr (has_control_points<Motion>) {
            return separate(points_, distance);
        } else {
            return separate(paths().own, distance);
        }
    }
    /// False if no tracked polynomials exist.
    bool has_paths() const {
        return std::all_of(points_.begin(), points_.end(),
                           [](const Motion& p) { return is_of_low_degree(p); });
    }
    const weighted_paths<K, tracked_ring>& paths() {
        if (!paths_) paths_.emplace(points_, tracked_ring(origin_of(points_[0])));
        return *paths_;
    }
    /// Decides if a VF or EE query touches at a time t at which Y = 0, given by an enclosure.
    outcome touches_at_root(const errbound::tracked<double>& t) const {
        const weighted_paths<K, ring_at_time> at_t(points_, {origin_of(points_[0]), t});
        // If N is not zero, the weights decide contact; if it is zero, all of them are zero.
        return decided_by_weights(forms_of(at_t.q));
    }

  private:
    template <class Points>
    static bool separate(const Points& points, double distance) {
        std::array<motion_box, weighted_paths<K, tracked_ring>::count> boxes;
        std::transform(points.begin(), points.end(), boxes.begin(),
                       [](const auto& p) { return box_of(p); });
        return detail::boxes_are_separate(boxes, kind_traits<K>::first_vertices, distance);
    }

    std::span<const Motion> points_;
    std::optional<weighted_paths<K, tracked_ring>> paths_;
};

/// Contact does not depend on units, so each axis has its own.
template <kind K, class Motion>
first_time first_contact(std::span<const Motion> points, double t_max, arithmetic by) {
    const bool filtered = by == arithmetic::floating_point_first;
    filter<K, Motion> bounds(points);
    if (filtered && (bounds.boxes_are_separate(0) ||
                     (bounds.has_paths() && certainly_separate<K>(bounds.paths().q))))
        return never;
    const weighted_paths<K, integer_ring> exact(points, integer_ring(common_units(points)));
    if constexpr (is_cubic(K)) {
        const time_polynomial y = forms_of(exact.q).y()[0];
        if (!y.is_zero()) {
            root_test test{{}, [&] { return contact_conditions<K>(exact.q); }};
            if (filtered) test.holds_at = [&](const auto& t) { return bounds.touches_at_root(t); };
            return first_time_at_roots(y, test, t_max);
        }
    }
    return first_time_of(contact_conditions<K>(exact.q), t_max);
}

/// Uses one unit for all axes and d.
template <kind K, class Motion>
first_time first_at_distance(std::span<const Motion> points, separation d, double t_max,
                             arithmetic by) {
    std::vector<bool> possible;
    if (by == arithmetic::floating_point_first) {
        filter<K, Motion> bounds(points);
        if (bounds.boxes_are_separate(
                std::nextafter(d.first + d.second, std::numeric_limits<double>::infinity())))
            return never;
        if (bounds.has_paths()) {
            const auto& tracked = bounds.paths();
            const auto distance =
                errbound::tracked<double>(d.first) + errbound::tracked<double>(d.second);
            possible = possible_conditions<K>(
                tracked.q,
                tracked.times_squared_weights(tracked_polynomial({distance * distance})));
            if (std::find(possible.begin(), possible.end(), true) == possible.end()) return never;
        }
    }
    const axis_units own = common_units(points);
    const int unit = std::min({own[0], own[1], own[2], common_exponent({d.first, d.second})});
    const integer_ring ring(axis_units{unit, unit, unit});
    const weighted_paths<K, integer_ring> exact(points, ring);
    const integer distance = ring.in_unit(d.first, unit) + ring.in_unit(d.second, unit);
    const time_polynomial squared =
        exact.times_squared_weights(time_polynomial({distance * distance}));
    exact_conditions conditions;
    std::size_t visited = 0;
    visit_distance_conditions<K>(exact.q, squared, [&](const auto& make) {
        const std::size_t i = visited++;
        if (possible.empty() || possible[i]) conditions.push_back(make());
    });
    return first_time_of(conditions, t_max);
}

}  // namespace

bool is_distance(separation d) {
    return std::isfinite(d.first) && std::isfinite(d.second) && d.first >= 0 && d.second >= 0;
}

template <kind K, class Motion>
first_time first_within_of(std::span<const Motion> points, separation d, double t_max,
                           arithmetic by) {
    if (!is_distance(d) || !std::isfinite(t_max) ||
        !std::all_of(points.begin(), points.end(), [](const Motion& p) { return is_valid(p); }))
        return {};
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

template first_time first_within_of<kind::vertex_face>(std::span<const rational_curve>, separation,
                                                       double, arithmetic);
template first_time first_within_of<kind::edge_edge>(std::span<const rational_curve>, separation,
                                                     double, arithmetic);
template first_time first_within_of<kind::vertex_edge>(std::span<const rational_curve>, separation,
                                                       double, arithmetic);
template first_time first_within_of<kind::vertex_vertex>(std::span<const rational_curve>,
                                                         separation, double, arithmetic);

template first_time first_within_of<kind::vertex_face>(std::span<const body_point>, separation,
                                                       double, arithmetic);
template first_time first_within_of<kind::edge_edge>(std::span<const body_point>, separation,
                                                     double, arithmetic);
template first_time first_within_of<kind::vertex_edge>(std::span<const body_point>, separation,
                                                       double, arithmetic);
template first_time first_within_of<kind::vertex_vertex>(std::span<const body_point>, separation,
                                                         double, arithmetic);

}  // namespace ccd::detail
