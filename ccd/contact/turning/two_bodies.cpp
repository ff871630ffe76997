#include "ccd/contact/turning/two_bodies.hpp"

#include <ccd/methods/transform.hpp>
#include <cmath>
#include <errbound/predicates.hpp>
#include <errbound/tracked.hpp>
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
                                           answer wanted, const stop_query& stop) {
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
            return up_to(t_max, first_root_time(y_of_bodies<K>(points), part.low, part.high, stop));
        default:
            return {};
    }
}

/// Same as first_within_of_bodies, for two bodies with these chords.
template <kind K>
first_time first_within_of_two(std::span<const body_point> points, const motion_chords& a,
                               const motion_chords& b, separation d, double t_max, answer wanted,
                               const stop_query& stop) {
    const bool contact = d.first == 0 && d.second == 0;
    const body_filter<K> bodies(points, a, b);
    if (bodies.separated(contact ? 0 : rounded_up_sum(d))) return never;
    if (!are_valid(points)) return {};
    polynomial_source y;
    if constexpr (is_cubic(K)) {
        if (contact && t_max >= 0)
            if (const auto decided = decided_by_signs<K>(points, bodies, t_max, wanted, stop))
                return *decided;
        y = [points] { return y_of_bodies<K>(points); };
    }
    return first_of_valid<K>(points, d, t_max, arithmetic::floating_point_first, y, stop);
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
                                  answer wanted, const stop_query& stop) {
    if (!is_distance(d) || !std::isfinite(t_max)) return {};
    for (const body_point& p : points)
        if (p.motion == nullptr) return {};
    if (!has_two_bodies<K>(points))
        return are_valid(points)
                   ? first_of_valid<K>(points, d, t_max, arithmetic::floating_point_first, {}, stop)
                   : first_time{};
    return with_chords(points.front(), [&](const motion_chords& a) {
        return with_chords(points.back(), [&](const motion_chords& b) {
            return first_within_of_two<K>(points, a, b, d, t_max, wanted, stop);
        });
    });
}

namespace {

namespace forms = errbound::forms;
using bounded_position = triple<errbound::tracked<double>>;

/// The position at t = 0. Precondition: the point is prepared.
bounded_position start_of(const body_point& p) {
    const motion_chords& chords = p.prepared->chords();
    const point<double>&x = p.rest, &c = chords.centre, y{x.x - c.x, x.y - c.y, x.z - c.z};
    const point<double> start = chords.ends_of(y).t0;
    const double error = chords.error_of(std::abs(y.x) + std::abs(y.y) + std::abs(y.z));
    const auto near = [&](double coordinate) {
        return errbound::tracked<double>::within(coordinate, error);
    };
    return {near(start.x), near(start.y), near(start.z)};
}

/// True if a line certainly separates the projections of an edge and a face along an axis. This
/// decides most pairs in one plane.
bool is_beside(const std::array<bounded_position, 2>& e, const std::array<bounded_position, 3>& f) {
    using enum errbound::sign_type;
    for (int axis = 0; axis < 3; ++axis) {
        const int x = (axis + 1) % 3, y = (axis + 2) % 3;
        const auto side = [&](const auto&... p) { return sign_of(forms::area(p..., x, y)); };
        const auto of_edge = side(e[0], e[1], f[0]);
        if ((of_edge == positive || of_edge == negative) && side(e[0], e[1], f[1]) == of_edge &&
            side(e[0], e[1], f[2]) == of_edge)
            return true;
        const auto of_face = side(f[0], f[1], f[2]);
        if (of_face != positive && of_face != negative) continue;
        for (std::size_t i = 0; i < 3; ++i)
            if (side(f[i], f[(i + 1) % 3], e[0]) == -of_face &&
                side(f[i], f[(i + 1) % 3], e[1]) == -of_face)
                return true;
    }
    return false;
}

}  // namespace

bool crosses_at_start(const std::array<body_point, 2>& edge,
                      const std::array<body_point, 3>& face) {
    const auto [e0, e1] = edge;
    const auto [f0, f1, f2] = face;
    const std::array<std::array<body_point, 4>, 2> ends{{{e0, f0, f1, f2}, {e1, f0, f1, f2}}};
    const std::array<std::array<body_point, 4>, 3> borders{
        {{e0, e1, f0, f1}, {e0, e1, f1, f2}, {e0, e1, f2, f0}}};
    const auto p0 = start_of(e0), p1 = start_of(e1), q0 = start_of(f0), q1 = start_of(f1),
               q2 = start_of(f2);
    constexpr kind vf = kind::vertex_face, ee = kind::edge_edge;
    // Y at t = 0 is this volume.
    const auto sign = [](const auto&... p) { return sign_of(forms::volume(p...)); };
    std::array side{sign(q1, q2, p0, q0), sign(q1, q2, p1, q0)};
    std::array turn{sign(p1, q1, q0, p0), sign(p1, q2, q1, p0), sign(p1, q0, q2, p0)};
    // The ends are on different sides, and the edge passes all borders on one side.
    const auto may_cross = [&] {
        return possibly_negative(side[0] * side[1]) && possibly_positive(turn[0] * turn[1]) &&
               possibly_positive(turn[1] * turn[2]) && possibly_positive(turn[0] * turn[2]);
    };
    if (!may_cross() || is_beside({p0, p1}, {q0, q1, q2})) return false;
    for (std::size_t i = 0; i < 2 && may_cross(); ++i)
        if (!certain(side[i])) side[i] = exact_sign_at_start<vf>(ends[i]);
    for (std::size_t i = 0; i < 3 && may_cross(); ++i)
        if (!certain(turn[i])) turn[i] = exact_sign_at_start<ee>(borders[i]);
    return may_cross();
}

template <curve_query Query>
first_time first_within(const Query& query, separation d, double t_max, answer wanted) {
    // The members lie one after the other.
    const auto* points = reinterpret_cast<const body_point*>(&query);
    constexpr std::size_t count = sizeof(query) / sizeof(body_point);
    static_assert(count * sizeof(body_point) == sizeof(query));
    return first_within_of_bodies<kind_of<Query>>({points, count}, d, t_max, wanted, {});
}

template first_time first_within(const vertex_face_of<body_point>&, separation, double, answer);
template first_time first_within(const edge_edge_of<body_point>&, separation, double, answer);
template first_time first_within(const vertex_edge_of<body_point>&, separation, double, answer);
template first_time first_within(const vertex_vertex_of<body_point>&, separation, double, answer);

template first_time first_within_of_bodies<kind::vertex_face>(std::span<const body_point>,
                                                              separation, double, answer,
                                                              const stop_query&);
template first_time first_within_of_bodies<kind::edge_edge>(std::span<const body_point>, separation,
                                                            double, answer, const stop_query&);
template first_time first_within_of_bodies<kind::vertex_edge>(std::span<const body_point>,
                                                              separation, double, answer,
                                                              const stop_query&);
template first_time first_within_of_bodies<kind::vertex_vertex>(std::span<const body_point>,
                                                                separation, double, answer,
                                                                const stop_query&);

}  // namespace ccd::detail
