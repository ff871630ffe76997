// Families of badly scaled queries.
#include <array>
#include <cmath>
#include <cstddef>

#include "ccd/stress/family_groups.hpp"
#include "ccd/stress/family_parts.hpp"
#include "ccd/stress/generators/contacts.hpp"

namespace ccd::stress {
namespace {

using namespace generators;

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

/// Half in contact, as near as rounding allows; half of small whole numbers, with exact ties.
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

}  // namespace

std::vector<family> families_of_scale() {
    return {
        {"scale", "The largest coordinate is just below 2^knob, down into subnormals.",
         "log2 of the largest coordinate",
         joined(range(-1070, -1000, 10), joined(range(-900, 900, 100), {1000, 1020, 1024})),
         of_scale},
        {"scale-axis", "One axis is scaled: contacts stay as they are.", "log2 of the axis' scale",
         joined(range(-1000, -100, 100), joined(range(-80, 80, 20), range(100, 1000, 100))),
         of_axis_scale},
        {"scale-point",
         "One point is that much farther from the origin, or nearer, than the others.",
         "log2 of the point's scale",
         joined(range(-1000, -200, 200), joined(range(-100, 100, 20), range(200, 1000, 200))),
         of_point_scale, scale_thinning},
        {"offset", "Features of size 1, all that far from the origin.",
         "log2 of offset over feature size", range(0, 50, 2), of_offset},
        {"displacement", "Points move that many edge lengths in the step.",
         "log2 of displacement over edge length", joined(range(-52, 24, 4), {27}), of_displacement},
    };
}

}  // namespace ccd::stress
