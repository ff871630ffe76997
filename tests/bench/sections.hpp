// The benchmark's tables. Each function prints its own.
#pragma once

#include "tests/bench/harness.hpp"
#include "tests/bench/scenes.hpp"

namespace bench {

/// ns per query of every method one by one, and of batches on every instruction set and with all
/// threads. Throws std::runtime_error if batches and one by one disagree.
void methods(const scene& s, const options& o, report& out);

/// What each stage of `exact` decides and costs, its slowest single queries, and those that reach
/// the integers.
void stages(const scene& s, const options& o, report& out);

/// First times of colliding queries and the data of their contacts: ns, and certified errors.
void contacts(const scene& s, const options& o, report& out);

/// Whole steps: time by phase, memory. Throws std::runtime_error if a step has other candidates
/// than those found here.
void steps(const scene& s, const options& o, report& out);

/// ns per query of batches against the number of queries.
void growth_with_queries(const scene& s, const options& o, report& out);

/// Whole steps of ever more copies of a scene side by side, up to ten million faces: time and
/// memory, and repeated steps of one mesh beside fresh ones.
void growth_with_copies(const scene& s, const options& o, report& out);

/// Whole steps against the size of the mesh.
void growth_with_mesh(const options& o, report& out);

/// Predicates against their expressions in plain double, one by one and in batches. Throws
/// std::runtime_error if these disagree.
void predicates(const options& o, report& out);

/// First times of contact and of a distance along random curves, by degree.
void curves(const options& o, report& out);

}  // namespace bench
