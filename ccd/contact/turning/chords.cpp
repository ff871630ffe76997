#include <algorithm>
#include <array>
#include <ccd/bodies/motion.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <variant>

#include "ccd/contact/moving_points.hpp"
#include "ccd/contact/rotation.hpp"

namespace ccd::detail {
namespace {

using numbers = std::array<double, 4>;

constexpr double infinity = std::numeric_limits<double>::infinity();

double largest_of(const numbers& q) {
    return std::max({std::abs(q[0]), std::abs(q[1]), std::abs(q[2]), std::abs(q[3])});
}
double dot(const numbers& p, const numbers& q) {
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3];
}

/// Exact at t = 0 and 1.
double at(double t, double start, double end) {
    return (1 - t) * start + t * end;
}

/// True if one length is at most 8 times the other and the cosine of the angle is above 1/4: then
/// all q(t) are at least 1/11 as long as the longer one.
bool is_even(const numbers& q0, const numbers& q1) {
    const double w0 = dot(q0, q0), w1 = dot(q0, q1), w2 = dot(q1, q1);
    return w0 < 64 * w2 && w2 < 64 * w0 && w1 > 0 && w0 * w2 < 15 * w1 * w1;
}

/// Bounds the translation; infinite or undefined if one of the coordinates is.
double size_of(const std::array<double, 6>& shift) {
    double sum = 0;
    for (const double x : shift) sum += std::abs(x);
    return sum;
}

}  // namespace

/// Rounding: let u = 2^-53 and let E bound the entries. Between 0 and 1, q(t) has an error of at
/// most 3.01u times the larger |q|, and is at least 1/11 as long: the rotation is off by at most
/// 2·33.2u. Entries of a rotation have further errors of at most 4.01u for the numerator, 4.01u for
/// the weight and 2u for the quotient; interpolated entries and translations have 3.01u. y has 1u,
/// products and sums 4u. So an end is off by at most (66.4 + √3·16)uE|y|₁ + √3·7u|p| in length, and
/// motion between ends as well. The factor 2^-46 = 128u also covers comparisons of coordinates
/// minus a bound, and the rounding of error_of. 2^-500 covers underflow: products lose at most
/// 2^-1074, and weights are at least 2^-1002.
motion_chords::motion_chords(const body_motion& motion_of_body, double from, double to)
    : from_(from), to_(to) {
    if (const auto* rigid = std::get_if<rigid_motion>(&motion_of_body)) {
        set(*rigid);
    } else if (const auto* affine = std::get_if<affine_motion>(&motion_of_body)) {
        set(*affine);
    } else {
        set_identity();
    }
    error_per_length += 0x1p-46 * largest_entry;
    error = 0x1p-46 * size_of(shift) + 0x1p-500;
}

void motion_chords::set_identity() {
    for (std::size_t i = 0; i < 3; ++i) column[i][i] = column[i][3 + i] = 1;
}

void motion_chords::set_shift(const point<double>& p0, const point<double>& p1) {
    const std::array start{p0.x, p0.y, p0.z}, end{p1.x, p1.y, p1.z};
    for (std::size_t i = 0; i < 3; ++i) {
        shift[i] = at(from_, start[i], end[i]);
        shift[3 + i] = at(to_, start[i], end[i]);
    }
}

void motion_chords::set(const affine_motion& m) {
    motion = motion_kind::keeps_direction;
    is_affine = m.a0 != identity3 || m.a1 != identity3;
    set_shift(m.p0, m.p1);
    double sum = largest_entry = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            column[j][i] = at(from_, m.a0[i][j], m.a1[i][j]);
            column[j][3 + i] = at(to_, m.a0[i][j], m.a1[i][j]);
            for (const double x : {std::abs(m.a0[i][j]), std::abs(m.a1[i][j])}) {
                largest_entry = std::max(largest_entry, x);
                sum += x;
            }
        }
    if (!(sum < infinity)) error_per_length = infinity;
}

/// Let R(t) turn by q(t), between two times at which q is q0 and q1. It is near L(t) =
/// (1 − t)R(0) + tR(1). Both leave the axis of rotation fixed. In the plane across it, let complex
/// numbers stand for quaternions: a = |q0| for q0, b e^(iψ) with b = |q1| for q1, and z =
/// (1 − t)a + t b e^(iψ) for q(t). Then R(t)R(0)^-1 multiplies by z²/|z|², R(1)R(0)^-1 by e^(2iψ):
///     z² − |z|²(1 − t + t e^(2iψ)) = 2i sin ψ t(1 − t)(b − a e^(iψ)) z.
/// So |R(t) − L(t)| = 2 sin ψ t(1 − t)|q1 − q0|/|z|. Here t(1 − t) <= 1/4 and, as q0·q1 > 0,
/// |z| >= min(a, b) cos(ψ/2). Since max(a, b) sin ψ <= |q1 − q0| and ab cos ψ = q0·q1,
///     |R(t) − L(t)| <= |q1 − q0|²/(2ab cos(ψ/2)) <= |q1 − q0|²/(2 q0·q1).
/// It is also at most 2. The product q0·q1 has an error of at most 4.01u·ab, and one of 67u·ab from
/// the interpolation: a relative error of at most 300u if ab < 4 q0·q1.
void motion_chords::set(const rigid_motion& m) {
    centre = m.centre;
    set_shift(m.p0, m.p1);
    if (point_evaluator<tracked_ring>::never_turns(m)) {
        motion = motion_kind::keeps_direction;
        set_identity();
        // Finite numbers of one sign are valid.
        const double product = m.q0.w * m.q1.w;
        if (!(product > 0 && product < infinity) && !is_valid(body_motion(m)))
            error_per_length = infinity;
        return;
    }
    motion = motion_kind::turns;
    numbers q0{m.q0.w, m.q0.x, m.q0.y, m.q0.z}, q1{m.q1.w, m.q1.x, m.q1.y, m.q1.z};
    const double largest = std::max(largest_of(q0), largest_of(q1));
    if (!(largest >= 0.5 && largest <= 1)) {
        if (!(largest > 0 && largest < infinity)) {
            error_per_length = infinity;
            return;
        }
        const int exponent = std::ilogb(largest) + 1;
        for (numbers* one : {&q0, &q1})
            for (double& x : *one) x = std::scalbn(x, -exponent);
    }
    double change = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const double way = (to_ - from_) * (q1[i] - q0[i]);
        change += way * way;
        q[0][i] = at(from_, q0[i], q1[i]);
        q[1][i] = at(to_, q0[i], q1[i]);
    }
    const double w0 = dot(q[0], q[0]), w1 = dot(q[0], q[1]), w2 = dot(q[1], q[1]);
    const bool is_whole = from_ == 0 && to_ == 1;
    if (w1 > 0 && w0 * w2 < 15 * w1 * w1 && (is_whole || is_even(q0, q1))) {
        error_per_length = std::min(2.0, (1 + 0x1p-40) * change / (2 * w1));
    } else {
        error_per_length = is_whole && is_valid(body_motion(m)) ? 2 : infinity;
    }
    if (!(w0 >= 0x1p-1000 && w2 >= 0x1p-1000)) error_per_length = infinity;
    for (std::size_t end = 0; end < 2; ++end) {
        const auto r = rotation_of(q[end]);
        const double scale = 1 / r.weight;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) column[j][3 * end + i] = scale * r.matrix[i][j];
    }
}

}  // namespace ccd::detail
