// Positions of bodies' points in rationals.
#pragma once

#include <array>
#include <boost/multiprecision/gmp.hpp>
#include <ccd/bodies/motion.hpp>
#include <cstddef>
#include <variant>

#include "ccd/contact/rotation.hpp"

namespace support {

using rational = boost::multiprecision::number<boost::multiprecision::gmp_rational,
                                               boost::multiprecision::et_off>;

/// The exact position of a point of a body at a time.
inline std::array<rational, 3> position_at(const ccd::body_motion& motion,
                                           const ccd::point<double>& rest, const rational& t) {
    const std::array<rational, 3> x{rest.x, rest.y, rest.z};
    const auto at = [&](double a, double b) { return (1 - t) * rational(a) + t * rational(b); };
    const auto moved = [&](const auto& row, const ccd::point<double>& c, double p0, double p1,
                           const rational& w) {
        return (row[0] * (x[0] - rational(c.x)) + row[1] * (x[1] - rational(c.y)) +
                row[2] * (x[2] - rational(c.z))) /
                   w +
               at(p0, p1);
    };
    const auto all = [&](const auto& matrix, const auto& m, const ccd::point<double>& c,
                         const rational& w) {
        return std::array{moved(matrix[0], c, m.p0.x, m.p1.x, w),
                          moved(matrix[1], c, m.p0.y, m.p1.y, w),
                          moved(matrix[2], c, m.p0.z, m.p1.z, w)};
    };
    if (const auto* m = std::get_if<ccd::rigid_motion>(&motion)) {
        const auto r =
            ccd::detail::rotation_of<rational>({at(m->q0.w, m->q1.w), at(m->q0.x, m->q1.x),
                                                at(m->q0.y, m->q1.y), at(m->q0.z, m->q1.z)});
        return all(r.matrix, *m, m->centre, r.weight);
    }
    const auto* m = std::get_if<ccd::affine_motion>(&motion);
    if (m == nullptr) return x;
    std::array<std::array<rational, 3>, 3> a;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) a[i][j] = at(m->a0[i][j], m->a1[i][j]);
    return all(a, *m, {}, 1);
}

}  // namespace support
