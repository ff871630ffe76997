// What every main over the ranks of MPI does.
#pragma once

#include <functional>
#include <string>

namespace errbound::study {

/// support::run_program between MPI_Init and MPI_Finalize. What `body` throws on all ranks is told
/// once; where one throws alone and the others wait for it, all are ended after some seconds.
int run_over_ranks(const std::string& name, int argc, char** argv,
                   const std::function<int(int argc, char** argv)>& body);

}  // namespace errbound::study
