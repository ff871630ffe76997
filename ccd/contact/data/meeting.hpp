// The features of a query that meet at its first contact. Internal.
#pragma once

#include <array>
#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/query.hpp>
#include <cstddef>
#include <cstdint>
#include <errbound/sign.hpp>
#include <optional>

#include "ccd/contact/data/moment.hpp"
#include "ccd/exact/features.hpp"

namespace ccd::detail {

template <kind K>
constexpr meeting_features whole_query() {
    meeting_features all{K, {}};
    for (std::uint8_t i = 0; i < kind_traits<K>::first_vertices + kind_traits<K>::second_vertices;
         ++i)
        all.points[i] = i;
    return all;
}

/// The points of a smaller pair of features, and the point whose weight is 0 if the pair meets.
struct smaller_pair {
    point_numbers points;
    std::uint8_t without;
};

template <kind K>
constexpr auto smaller_pairs() {
    if constexpr (K == kind::vertex_face)
        return std::array<smaller_pair, 3>{{{{0, 1, 2}, 3}, {{0, 2, 3}, 1}, {{0, 3, 1}, 2}}};
    else if constexpr (K == kind::edge_edge)
        return std::array<smaller_pair, 4>{
            {{{0, 2, 3}, 1}, {{1, 2, 3}, 0}, {{2, 0, 1}, 3}, {{3, 0, 1}, 2}}};
    else if constexpr (K == kind::vertex_edge)
        return std::array<smaller_pair, 2>{{{{0, 1}, 2}, {{0, 2}, 1}}};
    else
        return std::array<smaller_pair, 0>{};
}

template <class Points>
bool meet_at(const Points& points, const first_time& time, std::uint8_t v, std::uint8_t w) {
    return time_of_impact(vertex_vertex<double>{points[v], points[w]}, time.high) == time;
}
template <class Points>
bool meet_at(const Points& points, const first_time& time, const point_numbers& i) {
    const vertex_edge<double> query{points[i[0]], points[i[1]], points[i[2]]};
    return !separated_by_coordinates(query) && time_of_impact(query, time.high) == time;
}

/// Returns the features that meet. `weights` enclose the weights of a contact inside both features.
/// If the features meet inside, weights are unique, and a smaller pair that meets has a weight of
/// 0. Otherwise (N = 0, or an edge without length) no enclosure has a certain sign. A smaller
/// pair's first contact is not before the query's, so it is later if it has another bracket.
template <class Query>
meeting_features features_at(const Query& query, const first_time& time,
                             const std::array<enclosure, 4>& weights) {
    constexpr kind whole = kind_of<Query>;
    const auto points = points_of(query);
    std::optional<meeting_features> edge;
    for (const smaller_pair& pair : smaller_pairs<whole>()) {
        if (sign_of(weights[pair.without]) == errbound::sign_type::positive) continue;
        const std::uint8_t v = pair.points[0], first_end = pair.points[1];
        if constexpr (whole == kind::vertex_edge) {
            if (meet_at(points, time, v, first_end)) return {kind::vertex_vertex, {v, first_end}};
        } else {
            if (!meet_at(points, time, pair.points)) continue;
            for (const std::uint8_t end : {first_end, pair.points[2]})
                if (meet_at(points, time, v, end)) return {kind::vertex_vertex, {v, end}};
            if (!edge) edge = {kind::vertex_edge, pair.points};
        }
    }
    return edge ? *edge : whole_query<whole>();
}

}  // namespace ccd::detail
