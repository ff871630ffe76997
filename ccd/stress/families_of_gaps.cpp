// Families of queries at a distance from contact.
#include <array>
#include <cmath>
#include <cstddef>

#include "ccd/stress/family_groups.hpp"
#include "ccd/stress/family_parts.hpp"
#include "ccd/stress/generators/contacts.hpp"

namespace ccd::stress {
namespace {

using namespace generators;

/// At rest but for a common motion: above the middle of the other feature by the gap, or in its
/// plane and outside or inside its border by the gap.
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

/// From the gap to nothing, to one unit less or more than that, or half way (a single unit stays):
/// from above, or within the plane of the other feature.
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

}  // namespace

std::vector<family> families_of_gaps() {
    const std::vector<double> gaps = with_zero(joined(range(-50, -47, 1), range(-45, 0, 5)));
    return {
        {"gap-resting", "At rest relative to each other, that far apart, or that far inside.",
         "log2 of gap over edge length (-inf: 0)", gaps, of_resting_gap},
        {"gap-approaching",
         "From that far apart to a touch at t = 1, or to one ulp before or beyond it.",
         "log2 of gap over edge length (-inf: 0)", gaps, of_approached_gap},
    };
}

}  // namespace ccd::stress
