// Families of contacts exactly at an end of the step or of a feature.
#include <array>
#include <cmath>
#include <cstddef>

#include "ccd/stress/family_groups.hpp"
#include "ccd/stress/family_parts.hpp"
#include "ccd/stress/generators/contacts.hpp"

namespace ccd::stress {
namespace {

using namespace generators;

/// Knob 0, ±1, ±2, ±3, ...: 0, ±1, ±2, ±4, ... units.
double units_of(double knob) {
    return knob == 0 ? 0
                     : std::copysign(std::ldexp(unit, static_cast<int>(std::abs(knob)) - 1), knob);
}

/// At the start as many units beyond the other feature's plane, and moving away from it: contact
/// exactly if that is 0 or more.
points of_touch_at_start(source& random, kind which, double knob) {
    const double start = -units_of(knob);
    const double l = length(random), h = length(random), rise = length(random);
    const double slide = lattice(random) / 4;
    local_points p{};
    if (which == kind::vertex_face) {
        const double c = lattice(random);
        set_triangle(p, l, c, h);
        const double x = l / 4 + c / 2;
        p[0] = {{{x, h / 2, start}, {x + slide, h / 2, rise}}};
    } else {
        p[1] = {{{l, 0, 0}, {l, 0, 0}}};
        p[2] = {{{l / 2, -h / 4, start}, {l / 2 + slide, -h / 4, rise}}};
        p[3] = {{{l / 2, h / 2, start}, {l / 2 + slide, h / 2, rise}}};
    }
    return relabelled(random, which, placed(random, p));
}

points of_touch_at_end(source& random, kind which, double knob) {
    return reversed_in_time(of_touch_at_start(random, which, knob));
}

/// Positions of a coordinate at both ends that is x at t = eighth/8: there from x + eighth·slope.
std::array<double, 2> through(double x, int eighth, double slope) {
    return {x + eighth * slope, x - (8 - eighth) * slope};
}

/// A feature passes the other's plane at t = 1/8 to 7/8, as many units inside the border; at a
/// corner (VF), or at an end of both edges (EE), if `at_vertex`.
points of_touch_at_border(source& random, kind which, double inside, bool at_vertex) {
    const int eighth = random.between(1, 7);
    const double l = length(random), h = length(random);
    const double fall = 0x1p-4 + coarse(random) / 16;
    const double slide_x = (2 * coarse(random) - 1) / 32, slide_y = (2 * coarse(random) - 1) / 32;
    const std::array<double, 2> z = through(0, eighth, fall);
    const std::array<double, 2> x = through(0, eighth, slide_x);
    const std::array<double, 2> y = through(0, eighth, slide_y);
    const bool face = which == kind::vertex_face;
    local_points p{};
    if (face) set_triangle(p, l, at_vertex ? 0 : lattice(random), h);
    for (std::size_t end = 0; end < 2; ++end) {
        if (face) {
            p[0][end] = {(at_vertex ? inside : l / 2) + x[end], inside + y[end], z[end]};
        } else {
            p[0][end] = {-inside, 0, 0};
            p[1][end] = {l, 0, 0};
            p[2][end] = {x[end], y[end] - (at_vertex ? inside : h / 4), z[end]};
            p[3][end] = {x[end], y[end] + h / 2, z[end]};
        }
    }
    return relabelled(random, which, placed(random, p));
}

points of_touch_on_edge(source& random, kind which, double knob) {
    return of_touch_at_border(random, which, units_of(knob), false);
}
points of_touch_on_vertex(source& random, kind which, double knob) {
    return of_touch_at_border(random, which, units_of(knob), true);
}

}  // namespace

std::vector<family> families_of_touches() {
    const std::vector<double> ulps{-21, -17, -13, -9, -5, -3, -2, -1, 0, 1, 2, 3, 5, 9, 13, 17, 21};
    return {
        {"touch-start", "A last contact exactly at t = 0, or so many ulps from that.",
         "ulps inside: sign(k) 2^(abs(k)-1)", ulps, of_touch_at_start},
        {"touch-end", "A first contact exactly at t = 1, or so many ulps from that.",
         "ulps inside: sign(k) 2^(abs(k)-1)", ulps, of_touch_at_end},
        {"touch-edge", "Contact exactly on an edge (EE: at an end), or so many ulps inside.",
         "ulps inside: sign(k) 2^(abs(k)-1)", ulps, of_touch_on_edge},
        {"touch-vertex", "Contact exactly on a vertex (EE: of both), or so many ulps inside.",
         "ulps inside: sign(k) 2^(abs(k)-1)", ulps, of_touch_on_vertex},
    };
}

}  // namespace ccd::stress
