// The reference: decisions and first times in unbounded integers.
//
// Slow and simple, so that everything faster can be compared with it; it is the last stage of
// `exact`. Decided in integers, one unit an axis (one for all where a distance is asked for), so
// nothing is rounded. Time and memory grow with
// the spread of the coordinates' exponents (about 100 bits in ordinary scenes, 2,100 at most) and
// are bounded. Allocates; throws only std::bad_alloc. (Where the library was built with GMP,
// integers that find no memory end the program instead: GMP aborts.) Coordinates must be finite:
// otherwise the answer is `uncertain` with cause `range`, the only case in which it is not certain.
// Promised in a sound environment (errbound/environment.hpp): no flush-to-zero.
#pragma once

#include <ccd/contact.hpp>
#include <ccd/query.hpp>
#include <ccd/separation.hpp>
#include <ccd/verdict.hpp>

namespace ccd {

verdict decide_reference(const vertex_face<double>& query);
verdict decide_reference(const edge_edge<double>& query);
verdict decide_reference(const vertex_edge<double>& query);
verdict decide_reference(const vertex_vertex<double>& query);

/// What time_of_impact promises (ccd/contact.hpp).
first_time time_of_impact_reference(const vertex_face<double>& query, double t_max = 1);
first_time time_of_impact_reference(const edge_edge<double>& query, double t_max = 1);
first_time time_of_impact_reference(const vertex_edge<double>& query, double t_max = 1);
first_time time_of_impact_reference(const vertex_vertex<double>& query, double t_max = 1);

/// What decide_within promises (ccd/separation.hpp).
verdict decide_within_reference(const vertex_face<double>& query, separation d);
verdict decide_within_reference(const edge_edge<double>& query, separation d);
verdict decide_within_reference(const vertex_edge<double>& query, separation d);
verdict decide_within_reference(const vertex_vertex<double>& query, separation d);

/// What time_within promises (ccd/separation.hpp).
first_time time_within_reference(const vertex_face<double>& query, separation d, double t_max = 1);
first_time time_within_reference(const edge_edge<double>& query, separation d, double t_max = 1);
first_time time_within_reference(const vertex_edge<double>& query, separation d, double t_max = 1);
first_time time_within_reference(const vertex_vertex<double>& query, separation d,
                                 double t_max = 1);

}  // namespace ccd
