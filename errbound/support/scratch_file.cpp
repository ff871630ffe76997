#include "errbound/support/scratch_file.hpp"

#include <cerrno>
#include <cstring>
#include <errbound/support/error.hpp>
#include <system_error>

#include "errbound/support/output_file.hpp"
#include "errbound/support/system/system.hpp"

namespace errbound::support {

scratch_file::scratch_file() {
    std::error_code error;
    const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
    if (error)
        throw file_error("TMPDIR is not usable (" + error.message() +
                         "); expected a folder for temporary files");
    const std::string pattern = "errbound-XXXXXX";
    name_ = system::native_name(folder / pattern);
    descriptor_ = system::create_named(name_);
    if (descriptor_ < 0)
        throw file_error(name_ + ": cannot be made (" + std::strerror(errno) + ")");
    path_ = folder / name_.substr(name_.size() - pattern.size());
}

scratch_file::~scratch_file() {
    system::close(descriptor_);
    system::remove(name_);
}

void scratch_file::append(std::string_view bytes) {
    write_all(descriptor_, bytes, path_);
}

void scratch_file::read(std::uint64_t offset, std::size_t size, void* to) const {
    auto* next = static_cast<char*>(to);
    while (size > 0) {
        const std::ptrdiff_t got = system::read_at(descriptor_, offset, next, size);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0)
            throw file_error(path_.string() + ": cannot be read (" +
                             (got < 0 ? std::strerror(errno) : "it was cut off") + ")");
        next += got;
        offset += static_cast<std::uint64_t>(got);
        size -= static_cast<std::size_t>(got);
    }
}

}  // namespace errbound::support
