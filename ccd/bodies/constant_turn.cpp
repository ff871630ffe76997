#include <algorithm>
#include <array>
#include <ccd/bodies/constant_turn.hpp>
#include <ccd/kind.hpp>
#include <ccd/methods/transform.hpp>
#include <cmath>
#include <cstddef>
#include <errbound/elementary.hpp>
#include <errbound/functions.hpp>
#include <errbound/sign.hpp>
#include <errbound/tracked.hpp>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ccd/bodies/scaled_direction.hpp"
#include "ccd/contact/moving_points.hpp"

namespace ccd {
namespace {

using number = errbound::tracked<double>;
using errbound::sign_type;
using vector = std::array<number, 3>;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Covers up to 16 roundings of a bound.
double enlarged(double bound) {
    return bound * (1 + 0x1p-48) + std::numeric_limits<double>::min();
}

vector vector_of(const point<double>& p) {
    return {number(p.x), number(p.y), number(p.z)};
}
vector operator+(const vector& a, const vector& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
vector operator-(const vector& a, const vector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
vector operator*(const number& s, const vector& a) {
    return {s * a[0], s * a[1], s * a[2]};
}
vector cross(const vector& a, const vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
number dot(const vector& a, const vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double largest_magnitude(const number& x) {
    return enlarged(std::abs(x.value()) + x.error());
}
double largest_length(const vector& a) {
    return enlarged(
        std::hypot(largest_magnitude(a[0]), largest_magnitude(a[1]), largest_magnitude(a[2])));
}

/// The scaled direction, with the error of coordinates that underflow.
vector scaled_axis(const point<double>& direction) {
    const point<double> scaled = detail::scaled_direction(direction);
    vector axis;
    for (std::size_t i = 0; i < 3; ++i) {
        const double x = scaled.*detail::coordinate_axes[i];
        const bool is_exact = std::abs(x) >= std::numeric_limits<double>::min() ||
                              direction.*detail::coordinate_axes[i] == 0;
        axis[i] = number::within(x, is_exact ? 0 : std::numeric_limits<double>::denorm_min());
    }
    return axis;
}

/// The true motion at a time, with bounds.
class turn_at {
  public:
    turn_at(const constant_turn& motion, double t) : motion_(motion), t_(t) {
        const number half = number(motion.angle) * number(t) / number(2);
        cos_ = cos(half);
        const vector axis = scaled_axis(motion.axis);
        sin_ = sin(half) / sqrt(dot(axis, axis)) * axis;
    }

    /// cos + sin · axis, times from.q.
    std::array<number, 4> rotation() const {
        const quaternion& q = motion_.from.q;
        const number w(q.w);
        const vector v{number(q.x), number(q.y), number(q.z)};
        if (t_ == 0 || motion_.angle == 0) return {w, v[0], v[1], v[2]};
        const vector imaginary = cos_ * v + w * sin_ + cross(sin_, v);
        return {cos_ * w - dot(sin_, v), imaginary[0], imaginary[1], imaginary[2]};
    }
    vector centre() const {
        const point<double>&from = motion_.from.p, &to = motion_.end;
        const auto at = [&](double a, double b) {
            if (t_ == 0 || a == b) return number(a);
            if (t_ == 1) return number(b);
            return number(a) + number(t_) * (number(b) - number(a));
        };
        return {at(from.x, to.x), at(from.y, to.y), at(from.z, to.z)};
    }
    /// R (X − centre) = (r² − |v|²) y + 2 (v·y) v + 2 r v × y over r² + |v|², for y = X − centre.
    vector position(const point<double>& rest) const {
        const auto [r, x, y, z] = rotation();
        const vector v{x, y, z}, from_centre = vector_of(rest) - vector_of(motion_.centre);
        const number rr = r * r, vv = dot(v, v), two(2);
        const vector turned = (rr - vv) * from_centre + two * dot(v, from_centre) * v +
                              two * r * cross(v, from_centre);
        return number(1) / (rr + vv) * turned + centre();
    }

  private:
    const constant_turn& motion_;
    double t_;
    number cos_;
    vector sin_;
};

double radius(const turning_point& p) {
    return largest_length(vector_of(p.rest) - vector_of(p.motion->centre));
}

/// The position at all times within `half` of t: the point moves by at most the arc and the shift.
vector position_near(const turning_point& p, double t, double half) {
    const constant_turn& m = *p.motion;
    const double speed = enlarged(std::abs(m.angle) * radius(p)) +
                         largest_length(vector_of(m.end) - vector_of(m.from.p));
    vector at = turn_at(m, t).position(p.rest);
    for (number& x : at)
        x = number::within(x.value(), enlarged(x.error() + enlarged(half * speed)));
    return at;
}

bool is_positive(const number& x) {
    return sign_of(x) == sign_type::positive;
}

template <kind K>
number volume(const std::array<vector, 4>& p) {
    if (K == kind::vertex_face) return dot(cross(p[2] - p[1], p[3] - p[1]), p[0] - p[1]);
    return dot(cross(p[1] - p[0], p[3] - p[2]), p[2] - p[0]);
}

/// True if the features meet in their interiors whenever the four points are coplanar.
template <kind K>
bool are_certainly_inside(const std::array<vector, 4>& p) {
    if (K == kind::vertex_face) {
        const vector normal = cross(p[2] - p[1], p[3] - p[1]);
        for (const auto& [i, j] : {std::array<std::size_t, 2>{1, 2}, {2, 3}, {3, 1}})
            if (!is_positive(dot(cross(p[j] - p[i], p[0] - p[i]), normal))) return false;
        return true;
    }
    // The lines meet at a0 + s (a1 − a0) and b0 + t (b1 − b0), with s and t in units of |normal|².
    const vector a = p[1] - p[0], b = p[3] - p[2], between = p[2] - p[0], normal = cross(a, b);
    const number s = dot(cross(between, b), normal), t = dot(cross(between, a), normal),
                 one = dot(normal, normal);
    return is_positive(s) && is_positive(t) && is_positive(one - s) && is_positive(one - t);
}

/// A contact certainly happens between two times near t if the volume changes its sign there, and
/// the features are inside at all times between. Bisection then moves the times together. Returns
/// the later time, or infinity.
template <kind K>
double certain_contact(const std::array<turning_point, 4>& points, double t) {
    if (!is_cubic(K)) return infinity;
    const auto positions = [&](const auto& position) {
        return std::array{position(points[0]), position(points[1]), position(points[2]),
                          position(points[3])};
    };
    const auto sign_at = [&](double time) {
        return sign_of(volume<K>(positions(
            [&](const turning_point& p) { return turn_at(*p.motion, time).position(p.rest); })));
    };
    for (double width = 0x1p-44; width < 0.25; width *= 8) {
        const double from = std::max(0.0, t - width), to = std::min(1.0, t + width);
        const sign_type before = sign_at(from), after = sign_at(to);
        if (!certain(before) || !certain(after) || before == sign_type::zero ||
            after == sign_type::zero || before == after)
            continue;
        const double middle = from + (to - from) / 2;
        const double half = enlarged(std::max(middle - from, to - middle));
        const bool inside = are_certainly_inside<K>(
            positions([&](const turning_point& p) { return position_near(p, middle, half); }));
        if (!inside) return infinity;  // wider is less certain
        double last = from, next = to;
        for (double at = middle; last < at && at < next; at = last + (next - last) / 2) {
            const sign_type sign = sign_at(at);
            if (sign != before && sign != after) break;
            (sign == before ? last : next) = at;
        }
        return next;
    }
    return infinity;
}

/// Finds the first contact: see enclosed_time_of_impact.
template <kind K>
class enclosed_search {
  public:
    template <class Query>
    enclosed_search(const Query& query, const enclosure_options& options) : options_(options) {
        const auto points = points_of(query);
        for (std::size_t i = 0; i < 4; ++i) points_[i] = points[std::min(i, points.size() - 1)];
    }

    enclosed_time result() {
        for (const turning_point& p : points_)
            if (!p.motion || !detail::is_finite(p.rest) || !fault_of(*p.motion).empty()) return {};
        if (touches_at_start()) return {outcome::collides, 0, 0};
        std::vector<interval> open{{0, 1, infinity}};  // the earliest is the last
        while (!open.empty() && open.back().from < certain_) {
            const interval now = open.back();
            open.pop_back();
            if (const double bound = decide(now); bound > 0) {
                const double middle = now.from + (now.to - now.from) / 2;
                open.push_back({middle, now.to, bound});
                open.push_back({now.from, middle, bound});
            }
        }
        if (certain_ < infinity)
            return {outcome::collides, std::min(undecided_, certain_), certain_};
        if (undecided_ < infinity) return {outcome::uncertain, undecided_, 1};
        return {outcome::separate, 0, 0};
    }

  private:
    /// With the bound of the interval that was halved.
    struct interval {
        double from, to, bound;
    };
    static constexpr std::size_t first_count = kind_traits<K>::first_vertices,
                                 count = first_count + kind_traits<K>::second_vertices;

    /// The query of rational motions. Points of one turn have one motion.
    template <class MotionOf>
    auto query_of(std::array<body_motion, 4>& motions, const MotionOf& motion_of) const {
        std::array<body_point, 4> at;
        for (std::size_t i = 0; i < 4; ++i) {
            std::size_t j = 0;
            while (points_[j].motion != points_[i].motion) ++j;
            if (j == i) motions[i] = motion_of(*points_[i].motion);
            at[i] = {&motions[j], points_[i].rest};
        }
        if constexpr (K == kind::vertex_face)
            return vertex_face_of<body_point>{at[0], at[1], at[2], at[3]};
        else if constexpr (K == kind::edge_edge)
            return edge_edge_of<body_point>{at[0], at[1], at[2], at[3]};
        else if constexpr (K == kind::vertex_edge)
            return vertex_edge_of<body_point>{at[0], at[1], at[2]};
        else
            return vertex_vertex_of<body_point>{at[0], at[1]};
    }

    bool touches_at_start() const {
        std::array<body_motion, 4> motions;
        const auto query = query_of(motions, [](const constant_turn& m) -> body_motion {
            return rigid_motion{m.from.q, m.from.q, m.from.p, m.from.p, m.centre};
        });
        return decide_exact(query).outcome == outcome::collides;
    }

    /// Bounds of both features' distances from the true motion.
    separation deviations(const interval& t) const {
        std::array<double, 2> most{};
        for (std::size_t i = 0; i < count; ++i) {
            const enclosing_motion near = enclose(*points_[i].motion, t.from, t.to);
            double deviation = near.shift;
            if (near.angle > 0) deviation = enlarged(near.angle * radius(points_[i]) + near.shift);
            double& feature = most[i < first_count ? 0 : 1];
            feature = std::max(feature, deviation);
        }
        return {most[0], most[1]};
    }

    /// Returns the bound if the interval is to be halved, else 0.
    double decide(const interval& t) {
        const separation deviation = deviations(t);
        const double bound = deviation.first + deviation.second;
        const bool may_halve =
            ++pieces_ < options_.max_pieces && t.to - t.from > 0x1p-40 &&
            (t.bound == infinity || bound < t.bound / 2);  // otherwise roundings dominate
        if (!(bound < infinity)) return may_halve ? bound : leave(t.from);
        if (certain_ <= t.to) {  // a contact is certain by now, so only the length matters
            if (t.to - t.from <= options_.resolution) return leave(t.from);
            if (may_halve) return bound;
        }
        std::array<body_motion, 4> motions;
        const auto query = query_of(motions, [&](const constant_turn& m) -> body_motion {
            return enclose(m, t.from, t.to).motion;
        });
        const first_time near = time_within(query, deviation);
        if (near.outcome == outcome::separate) return 0;
        if (near.outcome == outcome::uncertain) return leave(t.from);
        const double low = time_in(t, near.low).first;
        if (bound == 0) {
            certain_ = time_in(t, near.high).second;
            return leave(low);
        }
        const first_time touch = time_of_impact(query);
        if (touch.outcome == outcome::collides)
            certain_ = std::min(certain_, certain_contact<K>(points_, time_in(t, touch.low).first));
        return may_halve && !(certain_ - low <= options_.resolution) ? bound : leave(low);
    }

    /// Bounds of a piece's time, exact if it is the whole turn.
    static std::pair<double, double> time_in(const interval& t, double x) {
        if (t.from == 0 && t.to == 1) return {x, x};
        return detail::time_between(t.from, t.to, x);
    }

    double leave(double from) {
        undecided_ = std::min(undecided_, from);
        return 0;
    }

    enclosure_options options_;
    std::array<turning_point, 4> points_;  ///< a kind with fewer points repeats the last
    int pieces_ = 0;
    double undecided_ = infinity;  ///< pieces before are separate
    double certain_ = infinity;    ///< a contact is certain at or before this time
};

double sum_of_errors(std::span<const number> all) {
    double sum = 0;
    for (const number& x : all) sum += x.error();
    return sum == 0 ? 0 : enlarged(sum);
}

}  // namespace

std::string fault_of(const constant_turn& m) {
    if (!std::isfinite(m.angle)) return "angle is not finite; expected a finite number";
    const body_motion ends = rigid_motion{m.from.q, m.from.q, m.from.p, m.end, m.centre};
    if (std::string fault = fault_of(ends); !fault.empty()) return fault;
    if (!detail::is_finite(m.axis)) return "axis is not finite; expected finite numbers";
    if (m.angle != 0 && m.axis.x == 0 && m.axis.y == 0 && m.axis.z == 0)
        return "axis is 0; expected a direction, since the angle is not 0";
    return {};
}

/// Quaternions of length L at half-angles 0 and 2a (a = θ/4), interpolated linearly and normalised,
/// are at the half-angle a + atan(2s tan a) at the time s + 1/2. The true one is a + 2as. Let τ =
/// tan a. The difference f(s) = atan(2sτ) − 2as is odd, and for 0 <= s <= 1/2
///     f'(s) = 2(τ − a) − 8s²τ³/(1 + 4s²τ²) <= A − 3Bs², with A = 2(τ − a), 3B = 8τ³/(1 + τ²),
/// so f <= As − Bs³ <= (2A/3)√(A/3B). The series of tan gives τ − a <= a³/(3D), D = 1 − 4a²/π², and
/// τ³/(1 + τ²) = τ sin² a >= a³ (1 − a²/6)². Hence f <= (4a³/9)/√12 / (D√D (1 − a²/6)). f is
/// concave with f(0) = f(1/2) = 0, so it is not negative. Rotations differ by 2f.
///
/// Errors of at most e in the ends move the interpolated quaternion, whose length is at least
/// L cos a, by at most e: its direction by asin(e/(L cos a)), the rotation by twice as much.
enclosing_motion enclose(const constant_turn& m, double from, double to) {
    const turn_at start(m, from), end(m, to);
    const auto q0 = start.rotation(), q1 = end.rotation();
    const vector p0 = start.centre(), p1 = end.centre();
    const auto quaternion_of = [](const auto& q) -> quaternion {
        return {q[0].value(), q[1].value(), q[2].value(), q[3].value()};
    };
    const auto point_of = [](const vector& p) -> point<double> {
        return {p[0].value(), p[1].value(), p[2].value()};
    };
    enclosing_motion near{
        {quaternion_of(q0), quaternion_of(q1), point_of(p0), point_of(p1), m.centre},
        0,
        std::max(sum_of_errors(p0), sum_of_errors(p1))};
    if (m.angle == 0) return near;
    near.angle = infinity;
    const double a = enlarged(std::abs(m.angle) / 4 * (to - from));
    if (!(a < 0.3928)) return near;  // just above π/8
    const double d = 1 - 0.4053 * a * a;
    const double sag = 0.12830006 * a * a * a / (d * std::sqrt(d) * (1 - a * a / 6));
    const number length = sqrt(number(detail::dot_of<number>(m.from.q, m.from.q)));
    const double ends =
        std::max(sum_of_errors(q0), sum_of_errors(q1)) / (0.92 * (length.value() - length.error()));
    if (ends >= 0 && ends < 0x1p-10) near.angle = enlarged(2 * (enlarged(sag) + 1.00001 * ends));
    return near;
}

enclosed_time enclosed_time_of_impact(const vertex_face_of<turning_point>& query,
                                      const enclosure_options& options) {
    return enclosed_search<kind::vertex_face>(query, options).result();
}
enclosed_time enclosed_time_of_impact(const edge_edge_of<turning_point>& query,
                                      const enclosure_options& options) {
    return enclosed_search<kind::edge_edge>(query, options).result();
}
enclosed_time enclosed_time_of_impact(const vertex_edge_of<turning_point>& query,
                                      const enclosure_options& options) {
    return enclosed_search<kind::vertex_edge>(query, options).result();
}
enclosed_time enclosed_time_of_impact(const vertex_vertex_of<turning_point>& query,
                                      const enclosure_options& options) {
    return enclosed_search<kind::vertex_vertex>(query, options).result();
}

}  // namespace ccd
