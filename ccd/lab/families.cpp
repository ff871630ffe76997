#include "ccd/lab/families.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "ccd/lab/generators.hpp"

namespace ccd::lab {
namespace {

using namespace generators;

// ---- Knobs, and exact building ----
//
// Contacts must be exact. So local coordinates are multiples of `unit`, or tiny on a separate axis.

using local_points = std::array<ends, 4>;

/// One unit in the last place of numbers from 4 to 8.
constexpr double unit = 0x1p-50;

/// low, low + step, ... up to high, which is always the last.
std::vector<double> range(int low, int high, int step) {
    std::vector<double> values;
    for (int v = low; v < high; v += step) values.push_back(v);
    values.push_back(high);
    return values;
}

std::vector<double> with_zero(std::vector<double> values) {
    values.insert(values.begin(), exact_zero);
    return values;
}

std::vector<double> joined(std::vector<double> values, const std::vector<double>& more) {
    values.insert(values.end(), more.begin(), more.end());
    return values;
}

double power_of_two(double knob) {
    return knob == exact_zero ? 0 : std::ldexp(1, static_cast<int>(knob));
}

/// The knob as an exponent; for exact_zero, an exponent that scales every double to zero.
int exponent_of(double knob) {
    return knob == exact_zero ? -3000 : static_cast<int>(knob);
}

/// Draws a number in [0, 1), a multiple of 4 units.
double lattice(source& random) {
    return std::ldexp(static_cast<double>(random.bits() >> 16), -48);
}

/// Draws a number in [0, 1), a multiple of 64 units.
double coarse(source& random) {
    return std::ldexp(static_cast<double>(random.bits() >> 20), -44);
}

/// Draws a number in [1/2, 1), a multiple of 4 units.
double length(source& random) {
    return 0.5 + std::ldexp(static_cast<double>(random.bits() >> 17), -48);
}

/// An exact map, so contacts stay: shears axes by whole numbers, moves all points by one
/// translation per end, and permutes axes. Nothing rounds if local coordinates are multiples of
/// `unit` and a point's three sum to at most 6: with a translation of at most 2 they stay within 8.
/// Axis `fine` (3: none) may hold other numbers: it is only permuted.
points placed(source& random, const local_points& local, std::size_t fine = 3) {
    matrix shear{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < i; ++j) shear[i][j] = random.between(-1, 1);
    }
    ends shift{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        shift[0][axis] = 2 * lattice(random) - 1;
        shift[1][axis] = shift[0][axis] + 2 * lattice(random) - 1;
    }
    std::array<std::size_t, 3> from{0, 1, 2};
    std::rotate(from.begin(), from.begin() + random.between(0, 2), from.end());
    if (random.one_in(2)) std::swap(from[0], from[1]);
    return fill([&](std::size_t i, std::size_t end, std::size_t axis) {
        const std::size_t own = from[axis];
        double x = local[i][end][own];
        if (own == fine) return x;
        for (std::size_t j = 0; j < own; ++j) {
            if (j != fine) x += shear[own][j] * local[i][end][j];
        }
        return x + shift[end][own];
    });
}

/// Rotates the corners, or exchanges the edges and their ends. Contacts stay the same.
points relabelled(source& random, kind which, points p) {
    if (which == kind::vertex_face) {
        std::rotate(p.begin() + 1, p.begin() + 1 + random.between(0, 2), p.end());
    } else {
        if (random.one_in(2)) std::swap(p[0], p[1]);
        if (random.one_in(2)) std::swap(p[2], p[3]);
        if (random.one_in(2)) p = {p[2], p[3], p[0], p[1]};
    }
    return p;
}

points reversed_in_time(points p) {
    for (auto& m : p) std::swap(m.t0, m.t1);
    return p;
}

/// Sets the triangle (0, 0), (l, 0), (c, h) in the plane z = 0, the same at both ends of the step.
void set_triangle(local_points& p, double l, double c, double h) {
    p[1] = {};
    for (std::size_t end = 0; end < 2; ++end) {
        p[2][end] = {l, 0, 0};
        p[3][end] = {c, h, 0};
    }
}

points near_decision(source& random, kind which) {
    const int exponent = -random.between(36, 56);
    switch (random.between(0, 6)) {
        case 0:
            return near_contact(random, which, 1);
        case 1:
            return border_contact(random, which);
        case 2:
            return shifted(random, which, near_contact(random, which, 1), exponent);
        case 3:
            return resting(random, which);
        case 4:
            return shifted(random, which, resting(random, which), exponent);
        case 5:
            return chosen_roots(random, which, root_triple(random, 2));
        default:
            return sheets(random, which);
    }
}

position any_weights(source& random, std::size_t corners) {
    return random.one_in(2) ? border_weights(random, corners) : weights(random, corners);
}

points of_scale(source& random, kind which, double knob) {
    const points p = near_decision(random, which);
    double largest = 0;
    map(p, [&largest](double x, auto...) {
        largest = std::max(largest, std::abs(x));
        return x;
    });
    int exponent = 0;
    std::frexp(largest, &exponent);
    return map(p,
               [&](double x, auto...) { return std::ldexp(x, static_cast<int>(knob) - exponent); });
}

points of_axis_scale(source& random, kind which, double knob) {
    const auto scaled = static_cast<std::size_t>(random.between(0, 2));
    return map(near_decision(random, which),
               [&](double x, std::size_t, std::size_t, std::size_t axis) {
                   return axis == scaled ? std::ldexp(x, static_cast<int>(knob)) : x;
               });
}

/// Half of the queries are in contact, as nearly as rounding allows. Half have small whole numbers,
/// with exact ties.
points of_point_scale(source& random, kind which, double knob) {
    const auto exponent = static_cast<int>(knob);
    const auto scaled = static_cast<std::size_t>(random.between(0, 3));
    if (random.one_in(2)) {
        return map(grid(random, 2), [&](double x, std::size_t point, auto...) {
            return point == scaled ? std::ldexp(x, exponent) : x;
        });
    }
    std::array<position, 4> at = positions(random);
    for (double& x : at[scaled]) x = std::ldexp(x, exponent);
    return contact_at(random, which, 1, at, any_weights);
}

unsigned scale_thinning(double knob) {
    return std::abs(knob) > 300 ? 20 : std::abs(knob) > 100 ? 4 : 1;
}

points of_offset(source& random, kind which, double knob) {
    const position offset{random.symmetric(), random.symmetric(), random.symmetric()};
    return map(near_decision(random, which),
               [&](double x, std::size_t, std::size_t, std::size_t axis) {
                   return x + std::ldexp(offset[axis], static_cast<int>(knob));
               });
}

points of_displacement(source& random, kind which, double knob) {
    const auto exponent = static_cast<int>(knob);
    const points p =
        contact_at(random, which, std::ldexp(1, exponent), positions(random), any_weights);
    return random.one_in(2) ? p : shifted(random, which, p, exponent - random.between(0, 30));
}

/// Features at rest except for a common motion. One is above the middle of the other by the gap, or
/// in its plane and outside or inside its border by the gap.
points of_resting_gap(source& random, kind which, double knob) {
    const double gap = power_of_two(knob);
    const double l = length(random), h = length(random);
    const int where = random.between(0, 2);
    const double inwards = where == 0 ? 0 : where == 1 ? -gap : gap;
    const double above = where == 0 ? gap : 0;
    local_points p{};
    if (which == kind::vertex_face) {
        const double c = lattice(random);
        set_triangle(p, l, c, h);
        const position v =
            where == 0 ? position{l / 4 + c / 2, h / 2, above} : position{l / 2, inwards, 0};
        p[0] = {v, v};
    } else {
        const double first = where == 0 ? -lattice(random) / 2 : -inwards;
        for (std::size_t end = 0; end < 2; ++end) {
            p[1][end] = {l, 0, 0};
            p[2][end] = {l / 2, first, above};
            p[3][end] = {l / 2, h, above};
        }
    }
    return relabelled(random, which, placed(random, p));
}

/// The gap shrinks to 0, to plus or minus one unit, or to its half (a gap of one unit stays). The
/// motion is from above, or within the plane of the other feature.
points of_approached_gap(source& random, kind which, double knob) {
    const double gap = power_of_two(knob);
    const double l = length(random), h = length(random);
    const int which_end = random.between(0, 3);
    const double left = which_end == 0   ? 0
                        : which_end == 1 ? unit
                        : which_end == 2 ? -unit
                        : gap > unit     ? gap / 2
                                         : gap;
    const bool in_plane = random.one_in(3);
    const double slide = lattice(random) / 4;
    local_points p{};
    if (which == kind::vertex_face) {
        const double c = lattice(random);
        set_triangle(p, l, c, h);
        p[0] = in_plane ? ends{{{l / 2 + slide, -gap, 0}, {l / 2, -left, 0}}}
                        : ends{{{l / 4 + c / 2 + slide, h / 2, gap}, {l / 4 + c / 2, h / 2, left}}};
    } else {
        p[1] = {{{l, 0, 0}, {l, 0, 0}}};
        p[2] = in_plane ? ends{{{l / 2 + slide, gap, 0}, {l / 2, left, 0}}}
                        : ends{{{l / 2 + slide, -h / 4, gap}, {l / 2, -h / 4, left}}};
        p[3] = in_plane ? ends{{{l / 2 + slide, gap + h, 0}, {l / 2, left + h, 0}}}
                        : ends{{{l / 2 + slide, h / 2, gap}, {l / 2, h / 2, left}}};
    }
    return relabelled(random, which, placed(random, p));
}

/// A weight that is inside, on a border, or off it by 2^-3 to 2^-40.
double border_weight(source& random) {
    const int pick = random.between(0, 5);
    if (pick < 2) return random.between(1, 7) / 8.0;
    if (pick == 2) return random.between(0, 1);
    const int exponent = -random.between(3, 40);
    return std::ldexp(random.one_in(2) ? 1 : -1, exponent);
}

/// A vertex passes a triangle with the given heights over its base, at the start and the end of the
/// step; or an edge passes an edge of these lengths. The weights w (of the height) and u are
/// constant. Heights are on a separate axis, so that even the tiniest are exact.
points passing_thin(source& random, kind which, const std::array<double, 2>& height) {
    const double l = random.between(4, 8) / 8.0, c = random.between(0, 8) / 8.0;
    // At most one of the weights is off a border, so that their product is exact.
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

/// Half of the slivers are exact. Half are in general position, with a height as near to the knob's
/// as rounding allows.
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

/// Half of the queries are near a plane through the origin, where even the smallest noise is kept.
points of_coplanar(source& random, kind which, double knob) {
    const points p = random.one_in(3) ? uniform(random) : near_decision(random, which);
    const auto flat = static_cast<std::size_t>(random.between(0, 2));
    const double level = random.one_in(2) ? 0 : random.symmetric();
    return map(p, [&](double x, std::size_t, std::size_t, std::size_t axis) {
        return axis == flat ? level + std::ldexp(random.symmetric(), exponent_of(knob)) : x;
    });
}

/// Knob 0, ±1, ±2, ±3, ...: 0, ±1, ±2, ±4, ... units.
double units_of(double knob) {
    return knob == 0 ? 0
                     : std::copysign(std::ldexp(unit, static_cast<int>(std::abs(knob)) - 1), knob);
}

/// Starts units_of(knob) below the other feature's plane, and moves upwards: there is contact if
/// and only if units_of(knob) >= 0.
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

/// A coordinate at both ends that is x at t = eighth/8, and starts at x + eighth·slope.
std::array<double, 2> through(double x, int eighth, double slope) {
    return {x + eighth * slope, x - (8 - eighth) * slope};
}

/// A feature passes the other's plane at t = 1/8 to 7/8, units_of(knob) inside the border; at a
/// corner (VF), or at an end of both edges (EE), if `at_vertex`.
template <bool at_vertex>
points of_touch_at_border(source& random, kind which, double knob) {
    const double inside = units_of(knob);
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

/// The coplanarity function is exactly r² + η (two roots, η = ±(separation/2)²) or r³ − s²·r
/// (three), for r = t − eighth/8.
///
/// The features span the directions B = (1, 0, r) and C = (0, 1, 0) or, for three, (r, 1, 0), so
/// that N = B × C is (−r, 0, 1) or (−r, r², 1). The vector P between them is (−r, 0, η) or (0, r,
/// −s²·r), and N·P is that function. At r = 0, P vanishes for η = 0, and the extent of the features
/// about it determines the position of the contact. Half the queries are in general position, as
/// multiples of `unit`: separations below 2^-24 become exactly multiple roots.
template <int roots>
points of_roots(source& random, kind which, double knob) {
    const double separation = power_of_two(knob);
    const int eighth = random.between(1, 7);
    const bool general = random.one_in(2);
    const auto rounded = [general](double x) { return general ? unit * std::round(x / unit) : x; };
    // The contact is inside, on the border, or outside by 2^-40.
    const auto weight = [&random] {
        const int pick = random.between(0, 5);
        return pick == 0 ? 0 : pick == 1 ? -0x1p-40 : random.between(1, 3) / 8.0;
    };
    const double x = weight(), y = weight();
    const double squared = separation * separation;
    const double eta = random.one_in(2) ? squared / 4 : -squared / 4;
    local_points p{};
    for (std::size_t end = 0; end < 2; ++end) {
        const double r = static_cast<double>(end) - eighth / 8.0;
        const double c = roots == 2 ? 0 : r;
        const position between =
            roots == 2 ? position{-r, 0, rounded(eta)} : position{0, r, rounded(-squared * r)};
        // b·B + c·C + from
        const auto at = [&](double along_b, double along_c, const position& from) {
            return position{from[0] + along_b + along_c * c, from[1] + along_c,
                            from[2] + along_b * r};
        };
        if (which == kind::vertex_face) {
            p[0][end] = between;
            p[1][end] = at(-x, -y, {});
            p[2][end] = at(1 - x, -y, {});
            p[3][end] = at(-x, 1 - y, {});
        } else {
            p[0][end] = at(-x, 0, {});
            p[1][end] = at(1 - x, 0, {});
            p[2][end] = at(0, -y, between);
            p[3][end] = at(0, 1 - y, between);
        }
    }
    return relabelled(random, which, placed(random, p, general ? 3 : 2));
}

/// A thin layer: relative positions on one axis, and all relative motion, are 2^knob of the common
/// motion; in contact, or missing it by a fraction of the relative motion.
points of_stiffness(source& random, kind which, double knob) {
    const auto exponent = static_cast<int>(knob);
    std::array<position, 4> at = positions(random);
    for (position& p : at) p[2] = std::ldexp(p[2], exponent);
    points p = contact_at(random, which, std::ldexp(1, exponent), at, any_weights);
    if (random.one_in(2)) p = shifted(random, which, p, exponent - random.between(0, 20));
    if (random.one_in(2)) {  // the layer lies across the axes
        const int a = random.between(-2, 2), b = random.between(-2, 2);
        for (auto& m : p) {
            for (ccd::point<double>* x : {&m.t0, &m.t1}) x->z += a * x->x + b * x->y;
        }
    }
    return drifting(random, p);
}

points of_not_finite(source& random, kind which, double knob) {
    std::array<bool, 24> spoilt{};
    std::fill_n(spoilt.begin(), static_cast<std::size_t>(knob), true);
    for (std::size_t i = spoilt.size() - 1; i > 0; --i) {
        std::swap(spoilt[i],
                  spoilt[static_cast<std::size_t>(random.between(0, static_cast<int>(i)))]);
    }
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr double instead[] = {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity};
    return map(near_decision(random, which),
               [&](double x, std::size_t point, std::size_t end, std::size_t axis) {
                   return spoilt[6 * point + 3 * end + axis] ? instead[random.between(0, 2)] : x;
               });
}

constexpr std::string_view ulps_inside = "ulps inside: sign(k) 2^(abs(k)-1)";

const std::vector<double> gaps = with_zero(joined(range(-50, -47, 1), range(-45, 0, 5)));
const std::vector<double> ulps{-21, -17, -13, -9, -5, -3, -2, -1, 0, 1, 2, 3, 5, 9, 13, 17, 21};
const std::vector<double> down_to_zero = with_zero(range(-60, 0, 4));

const std::vector<family> all{
    {"scale", "The largest coordinate is just below 2^knob, down into subnormals.",
     "log2 of the largest coordinate",
     joined(range(-1070, -1000, 10), joined(range(-900, 900, 100), {1000, 1020, 1024})), of_scale},
    {"scale-axis", "One axis is scaled: contacts stay as they are.", "log2 of the axis' scale",
     joined(range(-1000, -100, 100), joined(range(-80, 80, 20), range(100, 1000, 100))),
     of_axis_scale},
    {"scale-point", "One point is that much farther from the origin, or nearer, than the others.",
     "log2 of the point's scale",
     joined(range(-1000, -200, 200), joined(range(-100, 100, 20), range(200, 1000, 200))),
     of_point_scale, scale_thinning},
    {"offset", "Features of size 1, all that far from the origin.",
     "log2 of offset over feature size", range(0, 50, 2), of_offset},
    {"displacement", "Points move that many edge lengths in the step.",
     "log2 of displacement over edge length", joined(range(-52, 24, 4), {27}), of_displacement},
    {"gap-resting", "At rest relative to each other, that far apart, or that far inside.",
     "log2 of gap over edge length (-inf: 0)", gaps, of_resting_gap},
    {"gap-approaching",
     "From that far apart to a touch at t = 1, or to one ulp before or beyond it.",
     "log2 of gap over edge length (-inf: 0)", gaps, of_approached_gap},
    {"sliver", "VF: a flat triangle; EE: a short edge; down to exactly collapsed ones.",
     "log2 of height over length (-inf: 0)", down_to_zero, of_sliver},
    {"collapsing", "The triangle or edge shrinks to that at one end of the step.",
     "log2 of height over length (-inf: 0)", down_to_zero, of_collapse},
    {"parallel", "EE: the angle between the edges; VF: that between motion and triangle.",
     "log2 of the angle's tangent (-inf: 0)", down_to_zero, of_angle},
    {"coplanar", "Motion in a plane except for noise across it.",
     "log2 of noise over feature size (-inf: 0)", down_to_zero, of_coplanar},
    {"touch-start", "A last contact exactly at t = 0, or that many ulps from that.", ulps_inside,
     ulps, of_touch_at_start},
    {"touch-end", "A first contact exactly at t = 1, or that many ulps from that.", ulps_inside,
     ulps, of_touch_at_end},
    {"touch-edge", "Contact exactly on an edge (EE: at an end), or that many ulps inside.",
     ulps_inside, ulps, of_touch_at_border<false>},
    {"touch-vertex", "Contact exactly on a vertex (EE: of both), or that many ulps inside.",
     ulps_inside, ulps, of_touch_at_border<true>},
    {"double-root", "Coplanar twice, that far apart in time, or nearly so and never.",
     "log2 of the roots' separation (-inf: 0)", down_to_zero, of_roots<2>},
    {"triple-root", "Coplanar three times, that far apart in time.",
     "log2 of the roots' separation (-inf: 0)", down_to_zero, of_roots<3>},
    {"stiff", "Thin layers: tiny relative positions and motion next to large common motion.",
     "log2 of relative over common motion", joined(range(-50, -2, 2), {-1}), of_stiffness},
    {.name = "not-finite",
     .description = "Some coordinates are NaN or infinite: there is no answer.",
     .knob_name = "coordinates that are not finite",
     .knobs = {1, 2, 4, 12, 24},
     .make = of_not_finite,
     .finite = false},
};

}  // namespace

std::span<const family> families() {
    return all;
}

points make(const family& f, double knob, kind which, std::uint64_t seed, std::uint64_t index) {
    source random = source_of(f.name, {static_cast<std::uint64_t>(which),
                                       std::bit_cast<std::uint64_t>(knob), seed, index});
    return f.make(random, which, knob);
}

}  // namespace ccd::lab
