// First times along polynomials in t of any degree and their quotients, in unbounded integers.
// Allocates. The degrees and the spread of the coordinates' exponents bound time and memory.
// Internal.
#pragma once

#include <array>
#include <ccd/curves.hpp>
#include <ccd/execution.hpp>
#include <ccd/kind.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>

#include "ccd/contact/time_polynomial.hpp"

namespace ccd::detail {

/// True if both doubles of d are finite and not negative.
inline bool is_distance(separation d) {
    return std::isfinite(d.first) && std::isfinite(d.second) && d.first >= 0 && d.second >= 0;
}

/// `floating_point_first` first runs the filters of ccd/contact/curve_filter.hpp; results are the
/// same.
enum class arithmetic { integers, floating_point_first };

/// Same as time_within, or as time_of_impact if d = 0 (ccd/contact.hpp). `points` are in the order
/// of points_of. Motion: curve, rational_curve or body_point.
template <kind K, class Motion>
first_time first_within_of(std::span<const Motion> points, separation d, double t_max,
                           arithmetic by);

/// Computes a polynomial with the roots of Y in [0, 1] and their multiplicities.
using polynomial_source = std::function<time_polynomial()>;

/// Same, for valid points and distances. Calls y(), if not empty, if Y is needed. Polls `stop`
/// during exact computations.
template <kind K, class Motion>
first_time first_of_valid(std::span<const Motion> points, separation d, double t_max, arithmetic by,
                          const polynomial_source& y, const stop_query& stop);

/// The sum of two distances, not rounded down.
inline double rounded_up_sum(separation d) {
    return std::nextafter(d.first + d.second, std::numeric_limits<double>::infinity());
}

template <class Query>
struct query_curves {
    static constexpr kind query_kind = kind_constant<Query>::value;
    static constexpr std::size_t count =
        kind_traits<query_kind>::first_vertices + kind_traits<query_kind>::second_vertices;
    std::array<std::array<point<double>, 2>, count> ends;
    std::array<curve, count> all;

    explicit query_curves(const Query& query) {
        const auto points = points_of(query);
        for (std::size_t i = 0; i < count; ++i) {
            ends[i] = {points[i].t0, points[i].t1};
            all[i] = ends[i];
        }
    }
    query_curves(const query_curves&) = delete;
    query_curves& operator=(const query_curves&) = delete;
};

template <class Query>
first_time first_within_of(const Query& query, separation d, double t_max, arithmetic by) {
    const query_curves<Query> points(query);
    return first_within_of<points.query_kind, curve>(points.all, d, t_max, by);
}

}  // namespace ccd::detail
