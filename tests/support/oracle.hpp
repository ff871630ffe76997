// The oracle: a second exact decision of every query, made to share nothing with the library's own
// but the query types. Tests hold the library against it.
#pragma once

#include <ccd/query.hpp>

namespace oracle {

/// Whether disjoint swept boxes may answer at once; off only to test that shortcut itself.
enum class shortcuts { on, off };

/// Do the two closed features share a point at some t in [0, 1]? Coordinates must be finite.
bool collides(const ccd::vertex_face<double>& query, shortcuts use = shortcuts::on);
bool collides(const ccd::edge_edge<double>& query, shortcuts use = shortcuts::on);
bool collides(const ccd::vertex_edge<double>& query, shortcuts use = shortcuts::on);
bool collides(const ccd::vertex_vertex<double>& query, shortcuts use = shortcuts::on);

}  // namespace oracle
