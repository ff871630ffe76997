// Queries in double precision, decided in single precision if that suffices.
//
// Coordinates are relative to one of the query's points and rounded to float, with the rounding
// error as each number's bound. A float method therefore keeps its promise for double input, at any
// distance from the origin.
#pragma once

#include <algorithm>
#include <ccd/methods/bsc.hpp>
#include <ccd/methods/safeccd.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/verdict.hpp>
#include <errbound/number_traits.hpp>
#include <errbound/tracked.hpp>
#include <utility>

namespace ccd {

/// Returns the query over tracked floats, translated so that its first point starts at the origin.
/// If its largest coordinate is far from 1, a power of two brings it near 1. `second` is false if a
/// coordinate is not finite.
///
/// Bounds: d = fl(x − c) has an error of at most 2^-53·|d|. The nearest float f adds 2^-24·|d|, or
/// half of η if it underflows. Together that is less than |f|(2^-24 + 2^-44) + η, even rounded
/// downwards. If d overflows, f and its bound are infinite.
template <class Rule, template <class> class Query>
constexpr std::pair<Query<errbound::tracked<float, Rule>>, bool> single_precision_query(
    const Query<double>& query) {
    using traits = errbound::number_traits<double>;
    using scalar = errbound::tracked<float, Rule>;
    const point<double> origin = points_of(query)[0].t0;
    const Query<double> moved = transformed_points(query, [&](const point<double>& p) {
        return point<double>{p.x - origin.x, p.y - origin.y, p.z - origin.z};
    });
    bool finite = true;
    double largest = 0;
    for_each_coordinate(query, [&](double x) { finite = finite && traits::is_finite(x); });
    for_each_coordinate(moved, [&](double d) { largest = (traits::max)(largest, traits::abs(d)); });

    // The room is that of tracked_query for floats. Beyond 2^±1000 differences overflow or vanish.
    constexpr int room = errbound::number_traits<float>::max_exponent / 32, most = 1000;
    const int e = largest > 0 && traits::is_finite(largest) ? traits::exponent(largest) : 0;
    const int bounded = std::clamp(e, -most, most);
    const bool moderate = bounded >= -room && bounded <= room;
    const double factor = moderate ? 1.0 : traits::scale(1.0, -bounded);
    const auto converted = [factor](double d) {
        using single = errbound::number_traits<float>;
        if (d == 0) return scalar(0.0f);
        const float f = static_cast<float>(d * factor);
        constexpr float relative = 0x1p-24f + 0x1p-44f;
        return scalar::within(f, single::abs(f) * relative + 2 * single::underflow_unit());
    };
    return {transformed(moved, converted), finite};
}

/// The methods in floats for queries in doubles; `uncertain` if floats do not decide.
template <class Rule, template <class> class Query>
constexpr verdict decide_bsc_in_single_precision(const Query<double>& query) {
    const auto [converted, finite] = single_precision_query<Rule>(query);
    if (!finite) return {outcome::uncertain, cause::range};
    return decide_bsc_of(converted);
}

template <class Rule, template <class> class Query>
constexpr verdict decide_safeccd_in_single_precision(const Query<double>& query) {
    const auto [converted, finite] = single_precision_query<Rule>(query);
    if (!finite) return {outcome::uncertain, cause::range};
    return decide_safeccd_of<Rule>(converted);
}

}  // namespace ccd
