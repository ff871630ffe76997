#pragma once

#include <ccd/methods/transform.hpp>
#include <errbound/number_traits.hpp>
#include <errbound/tracked.hpp>
#include <utility>

namespace ccd {

/// Returns the query over tracked numbers, times the power of two that brings its largest
/// coordinate near 1. If a coordinate underflows when scaled, its bound contains the loss. `second`
/// is false if a coordinate is not finite. Scalar is a type with errbound::is_tracked.
template <class Rule, class T, template <class> class Query,
          class Scalar = errbound::tracked<T, Rule>>
constexpr std::pair<Query<Scalar>, bool> tracked_query(const Query<T>& query) {
    using traits = errbound::number_traits<T>;
    T largest = 0;
    bool finite = true;
    for_each_coordinate(query, [&](const T& x) {
        finite = finite && traits::is_finite(x);
        largest = (traits::max)(largest, traits::abs(x));
    });
    // Moderate sizes are not scaled. The room is that of errbound::normalized.
    constexpr int room = traits::max_exponent / 32;
    const int e = finite && largest > 0 ? traits::exponent(largest) : 0;
    if (e >= -room && e <= room)
        return {transformed(query, [](const T& x) { return Scalar(x); }), finite};
    return {transformed(query, [e](const T& x) { return scale(Scalar(x), -e); }), finite};
}

}  // namespace ccd
