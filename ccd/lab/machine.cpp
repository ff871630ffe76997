#include "ccd/lab/machine.hpp"

#include <ccd/batch.hpp>
#include <errbound/support/error.hpp>
#include <fstream>
#include <thread>

#include "errbound/support/output_file.hpp"
#include "errbound/support/system/system.hpp"

namespace ccd::lab {
namespace {

using errbound::support::file_error;
using errbound::support::read_whole;

std::string processor() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    }
    return "unknown";
}

}  // namespace

row this_machine() {
    std::string sets;
    for (const instruction_set set : instruction_sets())
        sets.append(sets.empty() ? "" : ", ").append(name(set));
    return {{"processor", processor()},
            {"cores", std::thread::hardware_concurrency()},
            {"load", errbound::support::system::load()},
            {"memory_gib", errbound::support::system::memory_bytes() / (1 << 30)},
            {"instruction_sets", sets},
            {"compiler", ERRBOUND_COMPILER},
            {"flags", ERRBOUND_FLAGS}};
}

std::string program_fingerprint() {
    try {
        return fingerprint_of(read_whole(errbound::support::system::program_file()));
    } catch (const file_error&) {
        return "0";
    }
}

std::string configured_commit() {
    return ERRBOUND_COMMIT;
}

}  // namespace ccd::lab
