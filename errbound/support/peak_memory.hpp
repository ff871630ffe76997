// The most memory that this process has held at once.
#pragma once

#include <sys/resource.h>

#include <cstddef>

namespace errbound::support {

inline std::size_t peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
    return static_cast<std::size_t>(usage.ru_maxrss);
#else
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // Linux and the BSDs count KiB
#endif
}

}  // namespace errbound::support
