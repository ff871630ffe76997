// Families of queries of flat, short and parallel features.
#include <array>
#include <cmath>
#include <cstddef>

#include "ccd/stress/family_groups.hpp"
#include "ccd/stress/family_parts.hpp"
#include "ccd/stress/generators/contacts.hpp"

namespace ccd::stress {
namespace {

using namespace generators;

/// A weight that is inside, on a border, or beside it by 2^-3 to 2^-40.
double border_weight(source& random) {
    const int pick = random.between(0, 5);
    if (pick < 2) return random.between(1, 7) / 8.0;
    if (pick == 2) return random.between(0, 1);
    const int exponent = -random.between(3, 40);
    return std::ldexp(random.one_in(2) ? 1 : -1, exponent);
}

/// A vertex that passes a triangle of the given heights over its base, or an edge that passes one
/// of the given lengths, at a place of constant weights w (of the height) and u. Heights are on an
/// axis of their own, so that even the tiniest are exact.
points passing_thin(source& random, kind which, const std::array<double, 2>& height) {
    const double l = random.between(4, 8) / 8.0, c = random.between(0, 8) / 8.0;
    // One of the weights at most is beside a border, so that their product is exact.
    double w = border_weight(random), u = random.between(1, 7) / 8.0;
    if (random.one_in(4)) std::swap(w, u);
    // Through the plane, to it, or back before it.
    const double start = random.between(0, 8) / 8.0;
    const double finish = -random.between(-1, 8) / 8.0;
    local_points p{};
    for (std::size_t end = 0; end < 2; ++end) {
        const double z = end == 0 ? start : finish;
        if (which == kind::vertex_face) {
            p[0][end] = {c * w + l * (1 - w) * u, height[end] * w, z};
            p[2][end] = {l, 0, 0};
            p[3][end] = {c, height[end], 0};
        } else {
            p[1][end] = {l, 0, 0};
            p[2][end] = {l * u, -height[end] * w, z};
            p[3][end] = {l * u, height[end] * (1 - w), z};
        }
    }
    return relabelled(random, which, placed(random, p, 1));
}

/// Half exactly as said, half in general position: then as near to it as rounding allows.
points of_sliver(source& random, kind which, double knob) {
    const double height = power_of_two(knob);
    if (random.one_in(2)) return passing_thin(random, which, {height, height});
    return which == kind::vertex_face ? sliver(random, which, exponent_of(knob))
                                      : needle(random, which, exponent_of(knob));
}

points of_collapse(source& random, kind which, double knob) {
    const points p = passing_thin(random, which, {1, power_of_two(knob)});
    return random.one_in(2) ? p : reversed_in_time(p);
}

/// EE: two edges whose directions differ by the angle, one passing the other. VF: a vertex whose
/// motion makes the angle with the triangle's plane, through it or past it.
points of_angle(source& random, kind which, double knob) {
    const double angle = power_of_two(knob);
    const auto eighths = [&random](int low, int high) { return random.between(low, high) / 8.0; };
    local_points p{};
    if (which == kind::vertex_face) {
        const double l = length(random), h = length(random);
        set_triangle(p, l, 0, h);
        const double x0 = eighths(-2, 10), y0 = eighths(-2, 10);
        const double x1 = eighths(-2, 10), y1 = eighths(-2, 10);
        const double z0 = angle * eighths(0, 8);
        const double z1 = angle * eighths(-8, 2);
        p[0] = {{{x0, y0, z0}, {x1, y1, z1}}};
        return relabelled(random, which, placed(random, p, 2));
    }
    const double w = border_weight(random);
    const double turned = random.one_in(2) ? 1 : -1;
    const double m = turned * eighths(2, 8);
    const double u = border_weight(random);  // where on the first edge
    const double z0 = eighths(0, 8), z1 = eighths(-8, 1);
    const double l = eighths(4, 8);
    for (std::size_t end = 0; end < 2; ++end) {
        const double z = end == 0 ? z0 : z1;
        p[1][end] = {l, 0, 0};
        p[2][end] = {l * u - m * w, -angle * w, z};
        p[3][end] = {l * u + m * (1 - w), angle * (1 - w), z};
    }
    return relabelled(random, which, placed(random, p, 1));
}

/// Half about a plane through the origin, where even the smallest noise is kept.
points of_coplanar(source& random, kind which, double knob) {
    const points p = random.one_in(3) ? uniform(random) : near_decision(random, which);
    const auto flat = static_cast<std::size_t>(random.between(0, 2));
    const double level = random.one_in(2) ? 0 : random.symmetric();
    return map(p, [&](double x, std::size_t, std::size_t, std::size_t axis) {
        return axis == flat ? level + std::ldexp(random.symmetric(), exponent_of(knob)) : x;
    });
}

}  // namespace

std::vector<family> families_of_thin_features() {
    return {
        {"sliver", "VF: a flat triangle; EE: a short edge; down to exactly collapsed ones.",
         "log2 of height over length (-inf: 0)", with_zero(range(-60, 0, 4)), of_sliver},
        {"collapsing", "The triangle or edge shrinks to that at one end of the step.",
         "log2 of height over length (-inf: 0)", with_zero(range(-60, 0, 4)), of_collapse},
        {"parallel", "EE: the angle between the edges; VF: that between motion and triangle.",
         "log2 of the angle's tangent (-inf: 0)", with_zero(range(-60, 0, 4)), of_angle},
        {"coplanar", "Motion in a plane but for noise across it.",
         "log2 of noise over feature size (-inf: 0)", with_zero(range(-60, 0, 4)), of_coplanar},
    };
}

}  // namespace ccd::stress
