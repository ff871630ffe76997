// Queries as elements of a mesh.
#pragma once

#include "ccd/lab/queries.hpp"
#include "tests/ccd/step/brute_force.hpp"

namespace brute_force {

/// Adds four vertices, and the face or the edges of a query of this kind; unused vertices are
/// points.
inline void add_query(two_frames& at, ccd::kind which, const ccd::lab::points& points) {
    ccd::mesh &before = at.first, &after = at.second;
    const auto v = static_cast<vertex_index>(before.vertices.size());
    for (const auto& p : points) {
        before.vertices.push_back(p.t0);
        after.vertices.push_back(p.t1);
    }
    const auto add_edge = [&](vertex_index a, vertex_index b) {
        before.edges.push_back({a, b});
        after.edges.push_back({a, b});
    };
    if (which == ccd::kind::vertex_face) {
        before.faces.push_back({v + 1, v + 2, v + 3});
        after.faces.push_back({v + 1, v + 2, v + 3});
    }
    if (which == ccd::kind::vertex_edge) add_edge(v + 1, v + 2);
    if (which == ccd::kind::edge_edge) {
        add_edge(v, v + 1);
        add_edge(v + 2, v + 3);
    }
}

}  // namespace brute_force
