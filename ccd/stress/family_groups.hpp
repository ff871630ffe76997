// The families, in groups: a file each.
#pragma once

#include <vector>

#include "ccd/stress/families.hpp"

namespace ccd::stress {

std::vector<family> families_of_scale();
std::vector<family> families_of_gaps();
std::vector<family> families_of_thin_features();
std::vector<family> families_of_touches();
std::vector<family> families_of_roots();

}  // namespace ccd::stress
