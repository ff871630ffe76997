// Whether an advance keeps what include/ccd/advance.hpp promises, by the oracle on every pair.
#pragma once

#include <ccd/advance.hpp>
#include <cstddef>
#include <string>

#include "tests/soak/steps/advance_scenes.hpp"

namespace soak {

struct advance_check {
    std::string faults = {};  ///< what is wrong, or nothing
    std::size_t pairs = 0;
    /// Whether some vertex goes less than 0.99 of the way to the first contact that could hold it.
    bool is_short = false;
};

/// Of the whole scene: that lists of pairs at the start are complete, that the earliest contact is
/// right, that no other pair is in contact, or within its distance, on the way to the positions,
/// and that these are where fractions say. A vertex that does not go all the way has a contact to
/// be held by: of its group, or of groups near enough to be joined with it. That this is not
/// farther off than promised is for the caller to ask of `is_short`, since gaps of a few last
/// places excuse it.
advance_check check(const advance_scene& scene, const ccd::advance_result& result);

}  // namespace soak
