// Predicates that geometry uses, as a user of errbound/predicate.hpp would write them.
#pragma once

#include <errbound/predicate.hpp>

namespace errbound {

/// Positive if a, b, c turn left (counterclockwise), negative if right, zero if they are collinear.
inline constexpr auto orient2d =
    predicate<points<2, 2, 2>>([](const auto& a, const auto& b, const auto& c) {
        return (a[0] - c[0]) * (b[1] - c[1]) - (a[1] - c[1]) * (b[0] - c[0]);
    });

inline constexpr auto orient3d =
    predicate<points<3, 3, 3, 3>>([](const auto& a, const auto& b, const auto& c, const auto& d) {
        const auto ax = a[0] - d[0], ay = a[1] - d[1], az = a[2] - d[2];
        const auto bx = b[0] - d[0], by = b[1] - d[1], bz = b[2] - d[2];
        const auto cx = c[0] - d[0], cy = c[1] - d[1], cz = c[2] - d[2];
        return az * (bx * cy - cx * by) + bz * (cx * ay - ax * cy) + cz * (ax * by - bx * ay);
    });

inline constexpr auto incircle =
    predicate<points<2, 2, 2, 2>>([](const auto& a, const auto& b, const auto& c, const auto& d) {
        const auto ax = a[0] - d[0], ay = a[1] - d[1];
        const auto bx = b[0] - d[0], by = b[1] - d[1];
        const auto cx = c[0] - d[0], cy = c[1] - d[1];
        return (ax * ax + ay * ay) * (bx * cy - cx * by) +
               (bx * bx + by * by) * (cx * ay - ax * cy) +
               (cx * cx + cy * cy) * (ax * by - bx * ay);
    });

inline constexpr auto insphere = predicate<points<3, 3, 3, 3, 3>>(
    [](const auto& a, const auto& b, const auto& c, const auto& d, const auto& e) {
        const auto ax = a[0] - e[0], ay = a[1] - e[1], az = a[2] - e[2];
        const auto bx = b[0] - e[0], by = b[1] - e[1], bz = b[2] - e[2];
        const auto cx = c[0] - e[0], cy = c[1] - e[1], cz = c[2] - e[2];
        const auto dx = d[0] - e[0], dy = d[1] - e[1], dz = d[2] - e[2];
        const auto ab = ax * by - bx * ay, bc = bx * cy - cx * by, cd = cx * dy - dx * cy,
                   da = dx * ay - ax * dy, ac = ax * cy - cx * ay, bd = bx * dy - dx * by;
        const auto abc = az * bc - bz * ac + cz * ab, bcd = bz * cd - cz * bd + dz * bc,
                   cda = cz * da + dz * ac + az * cd, dab = dz * ab + az * bd + bz * da;
        const auto lift_a = ax * ax + ay * ay + az * az, lift_b = bx * bx + by * by + bz * bz,
                   lift_c = cx * cx + cy * cy + cz * cz, lift_d = dx * dx + dy * dy + dz * dz;
        return (lift_d * abc - lift_c * dab) + (lift_b * cda - lift_a * bcd);
    });

}  // namespace errbound
