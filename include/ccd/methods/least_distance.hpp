// Bounds the least distance of a moving point from the origin during the step.
#pragma once

#include <ccd/methods/forms.hpp>
#include <cmath>
#include <errbound/number_traits.hpp>

namespace ccd::safeccd {

template <class T>
struct distance_bounds {
    T low, high;
};

/// |w(t)|₂ is least where w·w' = 0; rounding that time adds an error of a few ε times w's size. `w`
/// is in power form.
template <class Scalar>
constexpr auto least_distance(const vector_form<Scalar, 1>& w) {
    using T = typename Scalar::value_type;
    using traits = errbound::number_traits<T>;
    T along = 0, speed = 0, size = 0, error = 0;
    for (const auto* x : {&w.x, &w.y, &w.z}) {
        const T at0 = (*x)[0].value(), change = (*x)[1].value();
        along -= at0 * change;
        speed += change * change;
        size += traits::abs(at0) + traits::abs(change);
        error += (*x)[0].error() + (*x)[1].error();
    }
    T t = along / speed;
    if (!(t > 0)) t = 0;  // also if t is NaN, since w does not move then
    if (t > 1) t = 1;
    T square = 0;
    for (const auto* x : {&w.x, &w.y, &w.z}) {
        const T at_t = (*x)[0].value() + t * (*x)[1].value();
        square += at_t * at_t;
    }
    const T distance = std::sqrt(square);
    // The last term exceeds all losses of squares to underflow.
    const T doubt =
        error + 32 * traits::epsilon() * size + std::sqrt(traits::smallest_normal()) * 256;
    return distance_bounds<T>{distance - doubt, distance + doubt};
}

}  // namespace ccd::safeccd
