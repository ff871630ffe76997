// The distance of two places on a sphere by two formulas, with the correct digits of each.
#include <errbound/decimal.hpp>
#include <errbound/elementary.hpp>
#include <errbound/printing.hpp>
#include <iostream>

/// The assumed error of the C library's functions (docs/bound-rules.md).
template <>
inline constexpr double errbound::function_error<errbound::elementary_function::cos, double> = 2;

using number = errbound::tracked<double>;
using namespace errbound::literals;

/// In degrees.
struct place {
    number latitude, longitude;
};

number radians(const number& degrees) {
    return degrees * (3.14159265358979323846_tracked / 180);
}

/// The spherical law of cosines.
number by_cosine(const place& a, const place& b) {
    const number p = radians(a.latitude), q = radians(b.latitude);
    return acos(sin(p) * sin(q) + cos(p) * cos(q) * cos(radians(b.longitude - a.longitude)));
}

/// The haversine formula, with (1 − cos)/2.
number by_haversine(const place& a, const place& b) {
    const number up = sin(radians(b.latitude - a.latitude) / 2);
    const number across = sin(radians(b.longitude - a.longitude) / 2);
    return 2 * asin(sqrt(up * up +
                         cos(radians(a.latitude)) * cos(radians(b.latitude)) * across * across));
}

int main() {
    const number metres = 6371008.8_tracked;  // the Earth's mean radius
    const place tower{48.85837_tracked, 2.29448_tracked};
    const place places[] = {{40.6892_tracked, -74.0445_tracked},   // in New York
                            {48.85297_tracked, 2.34993_tracked},   // across the town
                            {48.85838_tracked, 2.29449_tracked}};  // 1.3 m away
    for (const place& other : places)
        std::cout << "by cosine " << metres * by_cosine(tower, other) << " m, by haversine "
                  << metres * by_haversine(tower, other) << " m\n";
    const place same = tower;
    std::cout << "to itself: by cosine " << metres * by_cosine(tower, same) << " m\n";
}
