// Proof that a first time exists if there is a contact: proofs/times/Curves.v, face_curves_first,
// edges_curves_first, smooth_continuous.
#include "ccd/contact/first_times.hpp"

#include <algorithm>
#include <array>
#include <ccd/bodies/motion.hpp>
#include <cmath>
#include <cstddef>
#include <errbound/tracked.hpp>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
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
first_time first_contact(std::span<const Motion> points, double t_max, arithmetic by,
                         const polynomial_source& y_source, const stop_query& stop) {
    const bool filtered = by == arithmetic::floating_point_first;
    filter<K, Motion> bounds(points);
    if (filtered && (bounds.boxes_are_separate(0) ||
                     (bounds.has_paths() && certainly_separate<K>(bounds.paths().q))))
        return never;
    std::optional<weighted_paths<K, integer_ring>> exact;
    const auto paths = [&]() -> const auto& {
        if (!exact) exact.emplace(points, integer_ring(common_units(points)));
        return exact->q;
    };
    if constexpr (is_cubic(K)) {
        const time_polynomial y = y_source ? y_source() : forms_of(paths()).y()[0];
        if (!y.is_zero()) {
            root_test test{{}, [&] { return contact_conditions<K>(paths()); }};
            if (filtered) test.holds_at = [&](const auto& t) { return bounds.touches_at_root(t); };
            return first_time_at_roots(y, test, t_max, stop);
        }
    }
    return first_time_of(contact_conditions<K>(paths()), t_max, stop);
}

/// Uses one unit for all axes and d.
template <kind K, class Motion>
first_time first_at_distance(std::span<const Motion> points, separation d, double t_max,
                             arithmetic by, const stop_query& stop) {
    std::vector<bool> possible;
    if (by == arithmetic::floating_point_first) {
        filter<K, Motion> bounds(points);
        if (bounds.boxes_are_separate(rounded_up_sum(d))) return never;
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
        if (!possible.empty() && !possible[i]) return;
        stop_if_requested(stop);
        conditions.push_back(make());
        time_polynomial& z = conditions.back().vanishing[0];
        z = exact.without_weights(std::move(z));
    });
    return first_time_of(conditions, t_max, stop);
}

}  // namespace

template <kind K, class Motion>
first_time first_of_valid(std::span<const Motion> points, separation d, double t_max, arithmetic by,
                          const polynomial_source& y, const stop_query& stop) {
    if (t_max < 0) return never;
    return d.first == 0 && d.second == 0 ? first_contact<K>(points, t_max, by, y, stop)
                                         : first_at_distance<K>(points, d, t_max, by, stop);
}

template <kind K, class Motion>
first_time first_within_of(std::span<const Motion> points, separation d, double t_max,
                           arithmetic by) {
    if (!is_distance(d) || !std::isfinite(t_max) || !are_valid(points)) return {};
    return first_of_valid<K>(points, d, t_max, by, {}, {});
}

// For linear queries in integers, and for bodies.
template first_time first_within_of<kind::vertex_face>(std::span<const curve>, separation, double,
                                                       arithmetic);
template first_time first_within_of<kind::edge_edge>(std::span<const curve>, separation, double,
                                                     arithmetic);
template first_time first_within_of<kind::vertex_edge>(std::span<const curve>, separation, double,
                                                       arithmetic);
template first_time first_within_of<kind::vertex_vertex>(std::span<const curve>, separation, double,
                                                         arithmetic);
template first_time first_of_valid<kind::vertex_face>(std::span<const body_point>, separation,
                                                      double, arithmetic, const polynomial_source&,
                                                      const stop_query&);
template first_time first_of_valid<kind::edge_edge>(std::span<const body_point>, separation, double,
                                                    arithmetic, const polynomial_source&,
                                                    const stop_query&);
template first_time first_of_valid<kind::vertex_edge>(std::span<const body_point>, separation,
                                                      double, arithmetic, const polynomial_source&,
                                                      const stop_query&);
template first_time first_of_valid<kind::vertex_vertex>(std::span<const body_point>, separation,
                                                        double, arithmetic,
                                                        const polynomial_source&,
                                                        const stop_query&);

template <curve_query Query>
first_time first_within(const Query& query, separation d, double t_max, answer) {
    const auto points = points_of(query);
    return first_within_of<kind_of<Query>, typename motion_of_query<Query>::type>(
        points, d, t_max, arithmetic::floating_point_first);
}

template first_time first_within(const vertex_face_of<curve>&, separation, double, answer);
template first_time first_within(const edge_edge_of<curve>&, separation, double, answer);
template first_time first_within(const vertex_edge_of<curve>&, separation, double, answer);
template first_time first_within(const vertex_vertex_of<curve>&, separation, double, answer);

template first_time first_within(const vertex_face_of<rational_curve>&, separation, double, answer);
template first_time first_within(const edge_edge_of<rational_curve>&, separation, double, answer);
template first_time first_within(const vertex_edge_of<rational_curve>&, separation, double, answer);
template first_time first_within(const vertex_vertex_of<rational_curve>&, separation, double,
                                 answer);

std::pair<double, double> time_between(double from, double to, double t) {
    if (t == 0) return {from, from};
    if (t == 1) return {to, to};
    using number = errbound::tracked<double, errbound::interval>;
    // If the difference overflows, both knots are large, and their halves exact.
    const double unit = std::isfinite(to - from) ? 1 : 2;
    const number low(from / unit), high(to / unit);
    const auto [lower, upper] = (number(unit) * (low + number(t) * (high - low))).bound();
    return {std::max(from, lower), std::min(to, upper)};
}

}  // namespace ccd::detail

namespace ccd {

std::string fault_of(const rational_curve& motion) {
    const auto& w = motion.weights;
    if (!w.empty() && w.size() != motion.points.size())
        return "number of weights is " + std::to_string(w.size()) + "; expected " +
               std::to_string(motion.points.size()) + ", one for each control point";
    for (std::size_t i = 0; i < w.size(); ++i)
        if (!(w[i] > 0 && std::isfinite(w[i])))
            return "weight " + std::to_string(i) + " is " + std::to_string(w[i]) +
                   "; expected a finite number > 0";
    return {};
}

}  // namespace ccd
