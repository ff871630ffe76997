#include "ccd/contact/nearness/nearness.hpp"

#include <array>
#include <ccd/kind.hpp>
#include <ccd/mesh.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/nearness.hpp>
#include <cstddef>
#include <errbound/integers/dyadic.hpp>
#include <tuple>
#include <type_traits>

#include "ccd/contact/nearness/in_doubles.hpp"
#include "ccd/contact/nearness/in_integers.hpp"
#include "ccd/exact/axis_units.hpp"
#include "ccd/exact/finite.hpp"
#include "ccd/exact/integer_decision.hpp"

namespace ccd {
namespace detail {
namespace {

template <class Query>
constexpr std::size_t points_in = sizeof(Query) / sizeof(moving_point<double>);

using motion = moving_point<double>;

nearness_filter::vector position(const double* row) {
    return {row[0], row[1], row[2]};
}
nearness_filter::vector position(const point<double>& p) {
    return {p.x, p.y, p.z};
}
template <class Query>
nearness_filter::resting_points<points_in<Query>> points_at(const Query& query,
                                                            point<double> motion::*end) {
    return with_members(query, [end](const auto&... p) {
        return nearness_filter::resting_points<points_in<Query>>{{position(p.*end)...}};
    });
}

/// `position_of` maps an integer motion to a position in units of 2^unit.
template <class Query, class PositionOf>
nearness nearness_of_integers(const Query& query, int unit, const PositionOf& position_of) {
    const auto points = std::apply([&](const auto&... p) { return std::array{position_of(p)...}; },
                                   points_of(query));
    using scalar = std::remove_cvref_t<decltype(points[0].x[0])>;
    return nearness_in_integers<kind_of<Query>, scalar>(points, unit).data();
}

constexpr auto start_of = [](const auto& p) {
    return vector_form<std::remove_cvref_t<decltype(p.t0.x)>, 0>{
        {{p.t0.x}}, {{p.t0.y}}, {{p.t0.z}}};
};

/// Precondition: coordinates are finite.
template <class Query>
nearness exactly_at_start(const Query& query) {
    const auto units = integer_units(query).with_common_unit();
    const auto converted = [&](const auto& q) {
        return nearness_of_integers(q, units.x.unit, start_of);
    };
    if (units.bits() <= extent_limit(1)) return converted(units.converted<1>(query));
    if (units.bits() <= extent_limit(2)) return converted(units.converted<2>(query));
    return converted(to_integers(query, units));
}

/// The positions s·t0 + n·t1 in units of 2^(unit + e), if t = n·2^e and s = 2^-e − n.
template <class Query>
nearness exactly_between(const Query& query, double t) {
    const auto units = integer_units(query).with_common_unit();
    const auto time = errbound::dyadic<integer>::from(t);
    const integer &n = time.numerator(), s = (integer(1) << -time.exponent()) - n;
    return nearness_of_integers(to_integers(query, units), units.x.unit + time.exponent(),
                                [&](const auto& p) {
                                    const auto at = [&](const integer& x0, const integer& x1) {
                                        return errbound::bernstein<integer, 0>{{s * x0 + n * x1}};
                                    };
                                    return vector_form<integer, 0>{
                                        at(p.t0.x, p.t1.x), at(p.t0.y, p.t1.y), at(p.t0.z, p.t1.z)};
                                });
}

}  // namespace

template <any_pair Pair>
nearness nearness_at_start(const double* positions, const Pair& pair) {
    const auto points = with_members(pair, [positions](auto... v) {
        return nearness_filter::resting_points<sizeof...(v)>{
            {position(positions + 3 * std::size_t(v))...}};
    });
    nearness found;
    if (nearness_filter::find<kind_of<Pair>>(points, found)) return found;
    return nearness_of(query_of(vertex_rows(positions, positions, 0), pair));
}

template nearness nearness_at_start(const double*, const vertex_face_pair&);
template nearness nearness_at_start(const double*, const edge_edge_pair&);
template nearness nearness_at_start(const double*, const vertex_edge_pair&);
template nearness nearness_at_start(const double*, const vertex_vertex_pair&);

}  // namespace detail

template <any_query Query>
nearness nearness_of(const Query& query, double t) {
    using namespace detail;
    constexpr kind K = kind_of<Query>;
    if (!(t >= 0 && t <= 1)) return {};
    nearness found;
    if (t == 0 || t == 1) {
        const auto end = t == 0 ? &motion::t0 : &motion::t1;
        if (nearness_filter::find<K>(points_at(query, end), found)) return found;
        const Query resting = transformed_motions(query, [end](const motion& p) {
            return motion{p.*end, p.*end};
        });
        return is_finite(resting) ? exactly_at_start(resting) : nearness();
    }
    const nearness_filter::moving_points<points_in<Query>> points{points_at(query, &motion::t0),
                                                                  points_at(query, &motion::t1), t};
    if (nearness_filter::find<K>(points, found)) return found;
    return is_finite(query) ? exactly_between(query, t) : nearness();
}

template nearness nearness_of(const vertex_face<double>&, double);
template nearness nearness_of(const edge_edge<double>&, double);
template nearness nearness_of(const vertex_edge<double>&, double);
template nearness nearness_of(const vertex_vertex<double>&, double);

}  // namespace ccd
