// The sections that run on every machine. Input is made by integer arithmetic and operations that
// are exact or rounded once, without distributions or functions of libraries.
#pragma once

#include <ccd/batch.hpp>
#include <ccd/kind.hpp>
#include <cstdint>
#include <string>

#include "tests/everywhere/recorder.hpp"
#include "tests/support/query_families.hpp"

namespace everywhere {

/// `exact`, contact at the start, and every method.
void record_decisions(recorder& to);
/// First times, contact data and distances, one by one; motion along curves.
void record_times(recorder& to);
/// The same in batches.
void record_batches(recorder& to, ccd::instruction_set set);
/// Steps and advances of meshes, with all options.
void record_steps(recorder& to, ccd::instruction_set set);
/// Every predicate, one by one and in batches; the first two also for floats.
void record_predicates(recorder& to);
/// Real roots of polynomials: number, multiplicities and adjacent doubles.
void record_roots(recorder& to);
/// Values and bounds of all rules, in doubles and floats.
void record_bounds(recorder& to);

/// Calls visit(query, name) for `count` queries of each family and kind.
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
