#include "ccd/contact/turning/control_maps.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "ccd/contact/moving_points.hpp"

namespace ccd::detail {
namespace {

using numbers = std::array<double, 4>;

double largest_of(const numbers& q) {
    return std::max({std::abs(q[0]), std::abs(q[1]), std::abs(q[2]), std::abs(q[3])});
}

double dot(const numbers& p, const numbers& q) {
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3];
}

/// The bilinear form whose values at (q, q) are the matrix of rotation_of, times `factor`.
matrix3 polar_rotation(const numbers& p, const numbers& q, double factor) {
    const double ww = p[0] * q[0], xx = p[1] * q[1], yy = p[2] * q[2], zz = p[3] * q[3];
    const auto both = [&](std::size_t i, std::size_t j) { return p[i] * q[j] + p[j] * q[i]; };
    const double xy = both(1, 2), wz = both(0, 3), xz = both(1, 3), wy = both(0, 2),
                 yz = both(2, 3), wx = both(0, 1);
    return {{{factor * (ww + xx - yy - zz), factor * (xy - wz), factor * (xz + wy)},
             {factor * (xy + wz), factor * (ww - xx + yy - zz), factor * (yz - wx)},
             {factor * (xz - wy), factor * (yz + wx), factor * (ww - xx - yy + zz)}}};
}

/// part·a + (1 − part)·b.
matrix3 between(const matrix3& a, const matrix3& b, double part) {
    matrix3 r;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) r[i][j] = b[i][j] + part * (a[i][j] - b[i][j]);
    return r;
}

}  // namespace

std::optional<rigid_motion> as_rigid(const body_motion& motion) {
    if (const auto* rigid = std::get_if<rigid_motion>(&motion)) return *rigid;
    const auto* affine = std::get_if<affine_motion>(&motion);
    if (affine == nullptr) return rigid_motion{};
    if (affine->a0 != identity3 || affine->a1 != identity3) return {};
    return rigid_motion{{}, {}, affine->p0, affine->p1, {}};
}

control_maps::control_maps(const body_motion& motion_of_body) {
    if (std::holds_alternative<resting>(motion_of_body)) {
        linear[0] = identity3;
    } else if (const auto rigid = as_rigid(motion_of_body)) {
        set(*rigid);
    } else {
        set(std::get<affine_motion>(motion_of_body));
    }
}

void control_maps::set(const affine_motion& m) {
    motion = motion_kind::keeps_direction;
    is_affine = true;
    count = 2;
    linear[0] = m.a0;
    linear[1] = m.a1;
    along = {0, 1};
    p0 = m.p0;
    p1 = m.p1;
    largest_entry = 0;
    for (const matrix3& a : {m.a0, m.a1})
        for (const auto& row : a)
            for (const double x : row) largest_entry = std::max(largest_entry, std::abs(x));
}

void control_maps::set(const rigid_motion& m) {
    p0 = m.p0;
    p1 = m.p1;
    centre = m.centre;
    if (point_evaluator<tracked_ring>::never_turns(m)) {
        motion = motion_kind::keeps_direction;
        count = 2;
        linear[0] = linear[1] = identity3;
        along = {0, 1};
        return;
    }
    motion = motion_kind::turns;
    q = {{{m.q0.w, m.q0.x, m.q0.y, m.q0.z}, {m.q1.w, m.q1.x, m.q1.y, m.q1.z}}};
    const double largest = std::max(largest_of(q[0]), largest_of(q[1]));
    if (!(largest >= 0.5 && largest <= 1)) {
        const int exponent = std::ilogb(largest) + 1;
        for (numbers& one : q)
            for (double& x : one) x = std::scalbn(x, -exponent);
    }
    set_rotation(m);
}

/// R(t) has the control matrices M_0, M_1, M_2 and weights w_0, w_1, w_2: values of bilinear forms
/// of q0 and q1, divided by the weight's. Multiplied by 1 − t and t, they give the four control
/// points of R(t)x + p(t). The second is w_0/(w_0 + 2w_1) of M_0 x + p1, and the rest of
/// M_1 x + p0; the third is similar.
///
/// Errors: a form has four products with a sum of magnitudes of at most |q0||q1|, hence an error of
/// at most 4.01u|q0||q1|. So w_1 has a relative error of at most 8.1u if |q0||q1| <= 2.01w_1; then
/// entries of M_1 are at most 2.01. Their errors are at most 2.01(4.01 + 8.1 + 2.1)u = 29u. Shares
/// lie in [0, 1] and have errors of at most 5u. So mixed entries have errors of at most
/// (29 + 3·5 + 3·2.01)u < 25u·2.01. Products underflow by 2^-1074, and |q|² >= 2^-44.
void control_maps::set_rotation(const rigid_motion& m) {
    const double w0 = dot(q[0], q[0]), w1 = dot(q[0], q[1]), w2 = dot(q[1], q[1]);
    const double least = std::min(largest_of(q[0]), largest_of(q[1]));
    usable = least >= 0x1p-20 && w0 * w2 <= 4.03 * w1 * w1 && w1 > 0;
    if (!usable) return;
    const std::array<matrix3, 3> control{polar_rotation(q[0], q[0], 1 / w0),
                                         polar_rotation(q[0], q[1], 1 / w1),
                                         polar_rotation(q[1], q[1], 1 / w2)};
    largest_entry = 2.01;
    if (m.p0 == m.p1) {
        count = 3;
        std::copy(control.begin(), control.end(), linear.begin());
        weight = {w0, 2 * w1, w2};
        return;
    }
    count = 4;
    weight = {w0, w0 + 2 * w1, w2 + 2 * w1, w2};
    along = {0, w0 / weight[1], 2 * w1 / weight[2], 1};
    linear[0] = control[0];
    linear[1] = between(control[0], control[1], along[1]);
    linear[2] = between(control[1], control[2], along[2]);
    linear[3] = control[2];
}

}  // namespace ccd::detail
