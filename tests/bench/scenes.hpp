// Scenes of two frames with all candidates of their step, and sets of queries.
#pragma once

#include <string>
#include <vector>

#include "ccd/lab/data_set.hpp"

namespace bench {

using ccd::lab::query_set;
using scene = ccd::lab::data_set;

inline bool is_step(const scene& s) {
    return s.origin == "scene";
}

/// All names, in the order of tables.
std::vector<std::string> scene_names();

/// The scene of that name; null if its data is missing. Throws errbound::support::file_error.
ccd::lab::loaded_data load(const std::string& name);

}  // namespace bench
