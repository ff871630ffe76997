// The machine and the build of the program, on which measurements depend.
#pragma once

#include <string>

#include "ccd/lab/tables.hpp"

namespace ccd::lab {

/// Processor, cores, load (mean of the last minute), memory_gib, instruction_sets, compiler and
/// flags. "unknown" where the system does not provide the name.
row this_machine();

/// The fingerprint of the program's file, "0" if it cannot be read.
std::string program_fingerprint();

/// The source's commit when the build was configured; "unknown" if there was none.
std::string configured_commit();

}  // namespace ccd::lab
