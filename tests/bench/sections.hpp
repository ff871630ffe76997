// The benchmark's tables. Each function prints its own.
#pragma once

#include "tests/bench/harness.hpp"
#include "tests/bench/scenes.hpp"

namespace bench {

/// ns per query of every method one by one, and of batches with every instruction set and with all
/// threads. Throws std::runtime_error if batches and single calls disagree.
void methods(const scene& s, const options& o, report& out);

/// The decisions and cost of each stage of `exact`, its slowest single queries, and those that
/// reach the integers.
void stages(const scene& s, const options& o, report& out);

/// First times of colliding queries and the data of their contacts: ns, and certified errors.
void contacts(const scene& s, const options& o, report& out);

/// Whole steps: time by phase, and memory.
void steps(const scene& s, const options& o, report& out);

/// Whole steps of copies of a scene side by side, up to ten million faces: time and memory. Also
/// compares repeated steps of one mesh with first steps.
void growth(const scene& s, const options& o, report& out);

/// Predicates compared with their expressions in plain double, one by one and in batches. Throws
/// std::runtime_error if single calls and batches disagree.
void predicates(const options& o, report& out);

/// First times of contact and of a distance along random curves, by degree.
void curves(const options& o, report& out);

}  // namespace bench
