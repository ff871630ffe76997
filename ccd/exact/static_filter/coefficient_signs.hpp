// Certain signs of a form's computed control values, given a bound on their errors.
#pragma once

#include <algorithm>
#include <cmath>
#include <errbound/roots/control_values.hpp>

#include "ccd/exact/static_filter/difference_extents.hpp"

namespace ccd::static_filter {

/// True if all control values are certainly positive (`above`) or negative (`below`).
template <class S, int N>
constexpr mask<S> above(const errbound::roots::control_values<S, N>& c, const S& error) {
    using std::min;
    S least = c[0];
    for (int i = 1; i <= N; ++i) least = min(least, c[i]);
    return least > error;
}
template <class S, int N>
constexpr mask<S> below(const errbound::roots::control_values<S, N>& c, const S& error) {
    using std::max;
    S greatest = c[0];
    for (int i = 1; i <= N; ++i) greatest = max(greatest, c[i]);
    return greatest < -error;
}

template <class S, int N>
constexpr S size_of(const errbound::roots::control_values<S, N>& c) {
    using std::abs, std::max;
    S size = abs(c[0]);
    for (int i = 1; i <= N; ++i) size = max(size, abs(c[i]));
    return size;
}

/// True if the end values certainly differ in sign: there is a root.
template <class S, int N>
constexpr mask<S> changes_sign(const errbound::roots::control_values<S, N>& c, const S& error) {
    const S& start = c[0];
    const S& end = c[N];
    const mask<S> starts_above = start > error, starts_below = start < -error;
    const mask<S> ends_above = end > error, ends_below = end < -error;
    return (starts_above & ends_below) | (starts_below & ends_above);
}

/// True if changes_sign, and one inner value certainly has the sign of the end value next to it.
/// Then signs change once, so there is one root. Proof: proofs/times/ContactPart.v,
/// changes_sign_once_right.
template <class S>
constexpr mask<S> changes_sign_once(const errbound::roots::control_values<S, 3>& c,
                                    const S& error) {
    const mask<S> falls = (c[0] > error) & (c[3] < -error) & ((c[1] > error) | (c[2] < -error));
    const mask<S> rises = (c[0] < -error) & (c[3] > error) & ((c[1] < -error) | (c[2] > error));
    return falls | rises;
}

/// True if no control value has a certain sign, which also holds for every subinterval.
template <class S, int N>
constexpr mask<S> within_error(const errbound::roots::control_values<S, N>& c, const S& error) {
    return size_of(c) <= error;
}

}  // namespace ccd::static_filter
