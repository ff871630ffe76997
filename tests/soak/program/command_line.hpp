// The program of ./run soak, for one process or for the ranks of MPI.
#pragma once

#include "tests/soak/long_run.hpp"

namespace soak {

/// The exit status. Messages and progress are rank 0's.
int run_program(int argc, char** argv, const team& who);

}  // namespace soak
