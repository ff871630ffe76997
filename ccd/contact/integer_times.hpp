// First contact times in integers of fixed width.
#pragma once

#include <ccd/kind.hpp>

#include "ccd/contact/vertex_edge_time.hpp"
#include "ccd/exact/static_filter/subdivision.hpp"

namespace ccd::detail {

/// Returns `uncertain` for queries that ccd/exact/integers.hpp leaves undecided, for roots that it
/// need not distinguish from others, and for times below 2^-70. Precondition: coordinates are
/// finite. No allocation, no exceptions.
template <any_query Query>
found_time first_contact_in_integers(const Query& query);

template <cubic_query Query>
found_time root_in_integers(const Query& query, const static_filter::contact_interval& part);

}  // namespace ccd::detail
