#include "ccd/report/measuring/machine.hpp"

#include <ccd/batch.hpp>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <errbound/support/error.hpp>
#include <fstream>
#include <thread>

#include "errbound/support/output_file.hpp"
#include "errbound/support/system/system.hpp"

namespace ccd::report {
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

machine this_machine() {
    machine here;
    here.processor = processor();
    here.cores = std::thread::hardware_concurrency();
    here.compiler = ERRBOUND_COMPILER;
    here.flags = ERRBOUND_FLAGS;
    here.load = errbound::support::system::load();
    here.memory_gib = errbound::support::system::memory_bytes() / (1 << 30);
    for (const instruction_set set : instruction_sets()) {
        here.instruction_sets.append(here.instruction_sets.empty() ? "" : ", ").append(name(set));
    }
    return here;
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

std::string fingerprint_of(std::string_view bytes) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char byte : bytes) {
        hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
    }
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

}  // namespace ccd::report
