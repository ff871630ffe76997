// First contacts in integers of fixed width: ccd/exact/integers.hpp, with the time.
#pragma once

#include <ccd/query.hpp>

#include "ccd/contact/vertex_edge_time.hpp"
#include "ccd/exact/static_filter/subdivision.hpp"

namespace ccd::detail {

/// `uncertain` for queries of the kinds that ccd/exact/integers.hpp leaves open, for roots that it
/// need not tell from others, and for times below 2^-70: all that is left to the reference.
/// Coordinates are finite. No allocation, no exceptions.
found_time first_contact_in_integers(const vertex_face<double>& query);
found_time first_contact_in_integers(const edge_edge<double>& query);
found_time first_contact_in_integers(const vertex_edge<double>& query);
found_time first_contact_in_integers(const vertex_vertex<double>& query);

/// The same where floating point has found the part of the first contact.
found_time root_in_integers(const vertex_face<double>& query,
                            const static_filter::contact_part& part);
found_time root_in_integers(const edge_edge<double>& query,
                            const static_filter::contact_part& part);

}  // namespace ccd::detail
