// Separation: whether, and when first, the features of a query come within a distance, exactly.
//
// The distance is the Euclidean one of the two closed features, and the question is closed: at some
// t it is at most d. d = 0 asks for contact.
#pragma once

#include <ccd/contact.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>

namespace ccd {

/// A distance d: the exact sum of two numbers, each finite and not negative, in the unit of the
/// coordinates; say the thicknesses of the two features.
struct separation {
    double first = 0, second = 0;
};

/// Whether the features come within d at some t in [0, 1]: `collides` if they do. `uncertain`, with
/// cause `range`, only if a coordinate or a part of d is not finite, or one of d is negative.
verdict decide_within(const vertex_face<double>& query, separation d);
verdict decide_within(const edge_edge<double>& query, separation d);
verdict decide_within(const vertex_edge<double>& query, separation d);
verdict decide_within(const vertex_vertex<double>& query, separation d);

/// When they first do, for t in [0, t_max]: as time_of_impact says.
first_time time_within(const vertex_face<double>& query, separation d, double t_max = 1);
first_time time_within(const edge_edge<double>& query, separation d, double t_max = 1);
first_time time_within(const vertex_edge<double>& query, separation d, double t_max = 1);
first_time time_within(const vertex_vertex<double>& query, separation d, double t_max = 1);

}  // namespace ccd
