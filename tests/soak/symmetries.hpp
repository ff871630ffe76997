// The part of the soak that needs no reference: all images of a query have one answer.
#pragma once

#include <vector>

#include "tests/soak/deciders.hpp"
#include "tests/soak/long_run.hpp"

namespace soak {

/// Queries of every family and all four kinds; the first decider's answer to each is what all
/// deciders must say to all images (tests/soak/images.hpp), every decider to images of its own.
/// Counted are the answers of deciders that are never uncertain. Tables: "family", the queries;
/// "decided by", the stages, of deciders that tell; "decider", all answers.
part symmetry_part(std::vector<decider> deciders);
/// exact_deciders() and conservative_deciders().
std::vector<decider> symmetric_deciders();

}  // namespace soak
