// The oracle: a second exact decision of every query. It shares only the types of queries, and
// access to their points, with the library. Tests compare the library with it.
#pragma once

#include <array>
#include <ccd/bodies/motion.hpp>
#include <ccd/curves.hpp>
#include <ccd/kind.hpp>
#include <ccd/query.hpp>
#include <concepts>
#include <cstddef>
#include <tuple>

namespace oracle {

/// There are two shortcuts, which their tests turn off. Features with disjoint swept boxes are
/// apart. `within` examines only the instants at which the distance can equal d1 + d2.
enum class shortcuts { on, off };

/// Times t with low <= t <= high, without an end that is marked as excluded. Precondition: 0 <= low
/// <= high <= 1.
struct interval {
    double low = 0, high = 1;
    bool with_low = true, with_high = true;

    static interval instant(double t) { return {t, t}; }
};

/// True if the two closed features share a point at some t in the interval. Precondition:
/// coordinates are finite, and each curve has at least one control point.
template <template <class> class Query>
bool collides(const Query<ccd::curve>&, shortcuts = shortcuts::on, const interval& = {});

/// True if the Euclidean distance of the two closed features is at most d1 + d2 at some t in the
/// interval. The sum is exact. Precondition: d1 and d2 are finite and >= 0.
template <template <class> class Query>
bool within(const Query<ccd::curve>&, double d1, double d2, shortcuts = shortcuts::on,
            const interval& = {});

/// Returns f(query), with the linear motion of the query's points as curves.
template <class Query, class F>
auto along_lines(const Query& query, const F& f) {
    using curves = std::tuple<ccd::vertex_face_curves, ccd::edge_edge_curves,
                              ccd::vertex_edge_curves, ccd::vertex_vertex_curves>;
    constexpr auto kind = static_cast<std::size_t>(ccd::kind_of<Query>);
    return ccd::detail::with_members(query, [&](const auto&... p) {
        const std::array ends{std::array{p.t0, p.t1}...};
        return std::apply(
            [&](const auto&... c) { return f(std::tuple_element_t<kind, curves>{c...}); }, ends);
    });
}

/// The same functions for queries with linear motion.
template <ccd::any_query Query>
bool collides(const Query& query, shortcuts use = shortcuts::on, const interval& when = {}) {
    return along_lines(query, [&](const auto& curves) { return collides(curves, use, when); });
}
template <ccd::any_query Query>
bool within(const Query& query, double d1, double d2, shortcuts use = shortcuts::on,
            const interval& when = {}) {
    return along_lines(query,
                       [&](const auto& curves) { return within(curves, d1, d2, use, when); });
}

/// The same functions for rational motion, defined in tests/support/oracle_rational.hpp.
template <class Motion>
concept rational_motion =
    std::same_as<Motion, ccd::rational_curve> || std::same_as<Motion, ccd::body_point>;
template <template <class> class Query, rational_motion Motion>
bool collides(const Query<Motion>& query, shortcuts use = shortcuts::on, const interval& when = {});
template <template <class> class Query, rational_motion Motion>
bool within(const Query<Motion>& query, double d1, double d2, shortcuts use = shortcuts::on,
            const interval& when = {});

}  // namespace oracle
