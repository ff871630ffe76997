// What a measurement depends on beside the data: the machine and how the program was compiled.
#pragma once

#include <string>

namespace ccd::report {

struct machine {
    std::string processor;  ///< "unknown" where the system does not say
    unsigned cores = 0;
    double load = 0;               ///< processes that wanted to run, mean of the last minute
    double memory_gib = 0;         ///< of the whole machine
    std::string instruction_sets;  ///< that the batch kernels can choose from here
    std::string compiler, flags;
};
machine this_machine();

/// A number that changes with the program: of the running program's file, 0 where it cannot be
/// read.
std::string program_fingerprint();

/// The commit that the source tree was at when the build was configured, "unknown" if it was none.
std::string configured_commit();

/// 64-bit FNV-1a, as 16 hexadecimal digits: shows accidental changes, not malicious ones.
std::string fingerprint_of(std::string_view bytes);

}  // namespace ccd::report
