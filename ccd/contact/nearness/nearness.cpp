#include "ccd/contact/nearness/nearness.hpp"

#include <array>
#include <ccd/kind.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/nearness.hpp>
#include <cstddef>
#include <cstdint>
#include <errbound/integers/dyadic.hpp>
#include <optional>
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

namespace filter = baseline::nearness_filter;

template <class Query>
filter::resting_points<double, points_in<Query>> points_at(const Query& query,
                                                           point<double> motion::*end) {
    return with_members(query, [end](const auto&... p) {
        return filter::resting_points<double, points_in<Query>>{
            {filter::vector<double>{(p.*end).x, (p.*end).y, (p.*end).z}...}};
    });
}

/// The data, if they are certain in floating point.
template <kind K, class Points>
std::optional<nearness> filtered(const Points& points) {
    const auto v = filter::values_of<K, double>(points);
    if (v.region < 0) return std::nullopt;
    return nearness_of_row<K>({v.region, v.first, v.second, v.weight_error, v.square,
                               v.square_error, v.distance, v.distance_error, v.normal.x, v.normal.y,
                               v.normal.z, v.normal_error});
}

/// Features by the numbers of nearness_filter::values.
template <kind K>
constexpr auto numbered_features() {
    constexpr std::uint8_t first = kind_traits<K>::first_vertices,
                           second = kind_traits<K>::second_vertices;
    constexpr std::size_t edges = is_cubic(K) ? smaller_pairs<K>().size() : 0;
    constexpr bool whole = K != kind::vertex_vertex;
    std::array<meeting_features, first * second + edges + whole> all;
    std::size_t n = 0;
    for (std::uint8_t i = 0; i < first; ++i)
        for (std::uint8_t j = first; j < first + second; ++j)
            all[n++] = {kind::vertex_vertex, {i, j}};
    if constexpr (is_cubic(K))
        for (const auto& pair : smaller_pairs<K>()) all[n++] = {kind::vertex_edge, pair.points};
    if (whole) all[n] = whole_query<K>();
    return all;
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

template <kind K>
nearness nearness_of_row(const nearness_row& row) {
    static constexpr auto numbered = numbered_features<K>();
    nearness r;
    r.features = numbered[static_cast<std::size_t>(row[0])];
    const auto& i = r.features.points;
    if (r.features.kind == kind::vertex_vertex)
        r.weights[i[0]] = r.weights[i[1]] = 1;
    else if (r.features.kind == kind::vertex_edge)
        set_weights<kind::vertex_edge>(
            i, [&](std::size_t) { return row[1]; }, r);
    else
        set_weights<K>(
            i, [&](std::size_t k) { return k == 3 ? row[2] : row[1]; }, r);
    r.weight_error = row[3];
    r.squared_distance = row[4];
    r.squared_distance_error = row[5];
    r.distance = row[6];
    r.distance_error = row[7];
    r.normal = {row[8], row[9], row[10]};
    r.normal_error = row[11];
    return r;
}

template nearness nearness_of_row<kind::vertex_face>(const nearness_row&);
template nearness nearness_of_row<kind::edge_edge>(const nearness_row&);
template nearness nearness_of_row<kind::vertex_edge>(const nearness_row&);
template nearness nearness_of_row<kind::vertex_vertex>(const nearness_row&);

}  // namespace detail

template <any_query Query>
nearness nearness_of(const Query& query, double t) {
    using namespace detail;
    constexpr kind K = kind_of<Query>;
    if (!(t >= 0 && t <= 1)) return {};
    if (t == 0 || t == 1) {
        const auto end = t == 0 ? &motion::t0 : &motion::t1;
        if (const auto found = filtered<K>(points_at(query, end))) return *found;
        const Query resting = transformed_motions(query, [end](const motion& p) {
            return motion{p.*end, p.*end};
        });
        return is_finite(resting) ? exactly_at_start(resting) : nearness();
    }
    const filter::moving_points<points_in<Query>> points{points_at(query, &motion::t0),
                                                         points_at(query, &motion::t1), t};
    if (const auto found = filtered<K>(points)) return *found;
    return is_finite(query) ? exactly_between(query, t) : nearness();
}

template nearness nearness_of(const vertex_face<double>&, double);
template nearness nearness_of(const edge_edge<double>&, double);
template nearness nearness_of(const vertex_edge<double>&, double);
template nearness nearness_of(const vertex_vertex<double>&, double);

}  // namespace ccd
