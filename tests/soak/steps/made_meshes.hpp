// Small meshes of families of queries, for steps of them.
#pragma once

#include <cstdint>
#include <string>

#include "tests/ccd/step/brute_force.hpp"
#include "tests/support/query_families.hpp"

namespace soak {

/// Three queries of a family, of any kinds, and more elements between them.
brute_force::two_frames mesh_of(const query_families::family& family, std::uint64_t seed,
                                std::uint64_t index);

/// All that is needed to make the mesh again.
std::string text_of(const brute_force::two_frames& at);

}  // namespace soak
