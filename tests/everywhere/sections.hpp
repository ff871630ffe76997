// What is asked on every machine, in sections. Input is made by integer arithmetic and exact or
// once rounded operations alone: no library's distributions or functions.
#pragma once

#include <ccd/batch.hpp>
#include <ccd/kind.hpp>
#include <cstdint>
#include <string>

#include "tests/everywhere/recorder.hpp"
#include "tests/support/query_families.hpp"

namespace everywhere {

/// `exact`, what touches at the start, and every method.
void record_decisions(recorder& to);
/// First times, contact data and distances, one by one; motion along curves.
void record_times(recorder& to);
/// The same of many queries at once.
void record_batches(recorder& to, ccd::instruction_set set);
/// Steps and advances of meshes, with all that can be asked of them.
void record_steps(recorder& to, ccd::instruction_set set);
/// Every predicate, one by one and many at once; the first two of floats, too.
void record_predicates(recorder& to);
/// Real roots of polynomials: how many, of which multiplicity, and between which doubles.
void record_roots(recorder& to);
/// Values and bounds of all rules, in doubles and floats.
void record_bounds(recorder& to);

/// visit(query, name) for so many queries of each family and kind.
template <class Visit>
void for_each_query(std::uint64_t per_family, std::uint64_t seed, const Visit& visit) {
    for (const ccd::kind which : {ccd::kind::vertex_face, ccd::kind::edge_edge,
                                  ccd::kind::vertex_edge, ccd::kind::vertex_vertex})
        for (const auto& f : query_families::families)
            for (std::uint64_t i = 0; i * f.thinning < per_family; ++i)
                ccd::lab::visit_query(which, query_families::make(f, which, seed, i),
                                      [&](const auto& query) {
                                          visit(query, std::string(f.name) + ' ' +
                                                           std::string(ccd::short_name(which)) +
                                                           ' ' + std::to_string(i));
                                      });
}

}  // namespace everywhere
