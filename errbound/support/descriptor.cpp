// Continues after partial and interrupted writes.
#include "errbound/support/descriptor.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <errbound/support/error.hpp>
#include <string>

#include "errbound/support/system/system.hpp"

namespace errbound::support {

void write_all(int descriptor, std::string_view bytes, const std::filesystem::path& shown) {
    constexpr std::size_t block = 1 << 20;
    while (!bytes.empty()) {
        const std::ptrdiff_t written =
            system::write(descriptor, bytes.data(), std::min(bytes.size(), block));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0)
            throw file_error(shown.string() + ": writing failed (" + std::strerror(errno) + ")");
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

}  // namespace errbound::support
