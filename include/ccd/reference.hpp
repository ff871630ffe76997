// The reference: decisions and first times in unbounded integers.
//
// Slow and simple: the oracle of all faster calls, and the last stage of `exact`. Nothing is
// rounded: each axis has a power of two as its unit (one unit for all axes if a distance is given).
// Time and memory grow with the spread of the coordinates' exponents (about 100 bits in ordinary
// scenes, at most 2,100). Allocates; throws only std::bad_alloc. Results and requirements are those
// of ccd/exact.hpp.
#pragma once

#include <ccd/kind.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>

namespace ccd {

/// Same as decide_exact of ccd/exact.hpp.
template <any_query Query>
verdict decide_reference(const Query& query);

/// Same as time_of_impact, decide_within and time_within of ccd/contact.hpp.
template <any_query Query>
first_time time_of_impact_reference(const Query& query, double t_max = 1);
template <any_query Query>
verdict decide_within_reference(const Query& query, separation d);
template <any_query Query>
first_time time_within_reference(const Query& query, separation d, double t_max = 1);

}  // namespace ccd
