#include <algorithm>
#include <array>
#include <ccd/bodies/motion.hpp>
#include <cmath>
#include <cstddef>
#include <errbound/sign.hpp>
#include <errbound/tracked.hpp>
#include <limits>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include "ccd/batch/checks.hpp"
#include "ccd/bodies/scaled_direction.hpp"
#include "ccd/contact/moving_points.hpp"

namespace ccd {
namespace {

bool all_finite(const point<double>& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}
bool all_finite(const matrix3& a) {
    for (const auto& row : a)
        for (const double x : row)
            if (!std::isfinite(x)) return false;
    return true;
}

std::string not_finite(const char* what) {
    return std::string(what) + " is not finite; expected finite numbers";
}

/// Returns the largest coordinate's size, or infinity if one is infinite or NaN.
double size_of(const quaternion& q) {
    double size = 0;
    for (const double x : {q.w, q.x, q.y, q.z}) {
        if (!std::isfinite(x)) return std::numeric_limits<double>::infinity();
        size = std::max(size, std::abs(x));
    }
    return size;
}
std::string fault(const char* name, const quaternion& q) {
    const double size = size_of(q);
    if (size > 0 && std::isfinite(size)) return {};
    std::string text = name;
    for (const char* separator = " is ("; const double x : {q.w, q.x, q.y, q.z}) {
        text += separator + detail::text_of(x);
        separator = ", ";
    }
    return text + "); expected finite numbers, not all 0";
}

/// q times a power of two. A coordinate that underflows gets an error bound.
std::array<errbound::tracked<double>, 4> scaled(const quaternion& q) {
    using number = errbound::tracked<double>;
    const int exponent = -std::ilogb(size_of(q));
    return {scale(number(q.w), exponent), scale(number(q.x), exponent),
            scale(number(q.y), exponent), scale(number(q.z), exponent)};
}
/// q0·q1 times a power of two: products of quaternions of any length neither overflow nor
/// underflow. Precondition: finite and not 0.
errbound::tracked<double> scaled_product(const quaternion& q0, const quaternion& q1) {
    const auto a = scaled(q0), b = scaled(q1);
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}
bool is_less_than_half_a_turn(const quaternion& q0, const quaternion& q1) {
    const double product = detail::dot_of<double>(q0, q1);
    const double size = 4 * size_of(q0) * size_of(q1);
    // The sum of four products has an error of at most 4.01u of the sum of their sizes.
    if (product > 0x1p-48 * size && size > 0x1p-900 && size < 0x1p900) return true;
    return sign_of(scaled_product(q0, q1)) == errbound::sign_type::positive;
}

std::string fault(const resting&) {
    return {};
}
std::string fault(const affine_motion& m) {
    if (!all_finite(m.a0)) return not_finite("a0");
    if (!all_finite(m.a1)) return not_finite("a1");
    if (!all_finite(m.p0)) return not_finite("p0");
    if (!all_finite(m.p1)) return not_finite("p1");
    return {};
}
std::string fault(const rigid_motion& m) {
    if (!all_finite(m.p0)) return not_finite("p0");
    if (!all_finite(m.p1)) return not_finite("p1");
    if (!all_finite(m.centre)) return not_finite("centre");
    if (std::string text = fault("q0", m.q0); !text.empty()) return text;
    if (std::string text = fault("q1", m.q1); !text.empty()) return text;
    if (!is_less_than_half_a_turn(m.q0, m.q1))
        return "q0·q1 is " + detail::text_of(detail::dot_of<double>(m.q0, m.q1)) +
               "; expected a number certainly > 0, so that the piece turns by less than half a "
               "turn";
    return {};
}

quaternion product(const quaternion& a, const quaternion& b) {
    return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
            a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

}  // namespace

std::string fault_of(const body_motion& motion) {
    return std::visit([](const auto& m) { return fault(m); }, motion);
}

bool detail::is_valid(const body_motion& motion) {
    if (std::holds_alternative<resting>(motion)) return true;
    const auto* rigid = std::get_if<rigid_motion>(&motion);
    if (rigid == nullptr) return fault_of(motion).empty();
    const double q0 = size_of(rigid->q0), q1 = size_of(rigid->q1);
    return all_finite(rigid->p0) && all_finite(rigid->p1) && all_finite(rigid->centre) && q0 > 0 &&
           q1 > 0 && std::isfinite(q0) && std::isfinite(q1) &&
           is_less_than_half_a_turn(rigid->q0, rigid->q1);
}

bool moves(const body_motion& motion) {
    if (const auto* affine = std::get_if<affine_motion>(&motion))
        return affine->a0 != affine->a1 || affine->p0 != affine->p1;
    if (const auto* rigid = std::get_if<rigid_motion>(&motion))
        return rigid->q0 != rigid->q1 || rigid->p0 != rigid->p1;
    return false;
}

rigid_motion shorter_arc(const pose& from, const pose& to) {
    quaternion q = to.q;
    const bool valid = fault("q0", from.q).empty() && fault("q1", q).empty();
    if (valid && scaled_product(from.q, q).value() < 0) q = {-q.w, -q.x, -q.y, -q.z};
    return {from.q, q, from.p, to.p, {}};
}

rigid_motion screw(const point<double>& d, const point<double>& centre, const point<double>& end) {
    return {{}, {1, d.x, d.y, d.z}, centre, end, centre};
}

std::vector<spline_piece<rigid_motion>> turn(const pose& from, const point<double>& direction,
                                             double angle, const point<double>& end,
                                             const point<double>& centre) {
    const point<double> axis = detail::scaled_direction(direction);
    const double length = std::hypot(axis.x, axis.y, axis.z);
    if (axis.x == 0 && axis.y == 0 && axis.z == 0) angle = 0;  // not if one is NaN
    const double quarters = std::abs(angle) / (std::numbers::pi / 2);
    const double pieces = std::isfinite(quarters) ? std::max(1.0, std::ceil(quarters)) : 1;
    const auto pose_at = [&](double k) -> pose {
        if (k == 0) return from;
        const double half = angle / 2 * (k / pieces), t = k / pieces;
        const double s = length == 0 ? 0 : std::sin(half) / length;
        const quaternion r{std::cos(half), s * axis.x, s * axis.y, s * axis.z};
        if (k == pieces) return {product(r, from.q), end};
        const auto between = [&](double a, double b) { return (1 - t) * a + t * b; };
        return {product(r, from.q),
                {between(from.p.x, end.x), between(from.p.y, end.y), between(from.p.z, end.z)}};
    };
    std::vector<spline_piece<rigid_motion>> all;
    all.reserve(static_cast<std::size_t>(std::min(pieces, 0x1p63)));  // throws for too many
    pose last = from;
    for (double k = 1; k <= pieces; ++k) {
        const pose next = angle == 0 ? pose{from.q, end} : pose_at(k);
        all.push_back({(k - 1) / pieces, k / pieces, {last.q, next.q, last.p, next.p, centre}});
        last = next;
    }
    return all;
}

moving_point<double> rounded_ends(const affine_motion& motion, const point<double>& rest) {
    const auto at = [&](const matrix3& a, const point<double>& p) -> point<double> {
        const auto row = [&](std::size_t i, double shift) {
            return ((a[i][0] * rest.x + a[i][1] * rest.y) + a[i][2] * rest.z) + shift;
        };
        return {row(0, p.x), row(1, p.y), row(2, p.z)};
    };
    return {at(motion.a0, motion.p0), at(motion.a1, motion.p1)};
}

}  // namespace ccd
