// Whole files in and out.
#include "errbound/support/output_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <errbound/support/error.hpp>
#include <fstream>
#include <system_error>

namespace errbound::support {
namespace fs = std::filesystem;
namespace {

/// Why the last system call failed, as an end to a message.
std::string reason() {
    return errno != 0 ? std::string(" (") + std::strerror(errno) + ")" : std::string();
}

void write_directly(const fs::path& path, std::string_view text, const fs::path& shown) {
    errno = 0;
    std::ofstream out(path, std::ios::binary | std::ios::trunc);
    if (!out) throw file_error(shown.string() + ": cannot be written" + reason());
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.close();
    if (!out) throw file_error(shown.string() + ": writing failed" + reason());
}

}  // namespace

void write_whole(const fs::path& path, std::string_view text) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (fs::is_directory(status)) {
        throw file_error(path.string() + ": found a directory, expected a file to write");
    }
    // A pipe or device must never be replaced by a file, and cannot be half-written either.
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        write_directly(path, text, path);
        return;
    }
    if (!fs::exists(status) && fs::is_symlink(fs::symlink_status(path, error))) {
        throw file_error(path.string() +
                         ": found a symbolic link to nothing, expected a file to write");
    }
    // A symbolic link to a file stays one; the file is replaced.
    const fs::path target = fs::exists(status) ? fs::canonical(path, error) : path;
    if (!target.has_filename()) {
        throw file_error("'" + path.string() + "'" +
                         ": found no file name, expected a file to write");
    }
    fs::path temporary = target;
    std::string hidden = ".";
    hidden.append(target.filename().string()).append(".").append(std::to_string(getpid()));
    temporary.replace_filename(hidden.append(".tmp"));
    try {
        write_directly(temporary, text, path);
        if (fs::exists(status)) fs::permissions(temporary, status.permissions(), error);
        fs::rename(temporary, target, error);
        if (error) {
            throw file_error(path.string() + ": cannot be replaced (" + error.message() + ")");
        }
    } catch (...) {
        fs::remove(temporary, error);
        throw;
    }
}

std::string read_whole(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (status.type() == fs::file_type::not_found) {
        throw file_error(path.string() + ": found no such file, expected a readable file");
    }
    if (fs::is_directory(status)) {
        throw file_error(path.string() + ": found a directory, expected a file");
    }
    errno = 0;
    std::ifstream in(path, std::ios::binary);
    if (!in) throw file_error(path.string() + ": cannot be read" + reason());
    std::string text;
    // Block by block, not by the file's size: a pipe has none.
    char block[1 << 16];
    while (in.read(block, sizeof block), in.gcount() > 0) {
        text.append(block, static_cast<std::size_t>(in.gcount()));
    }
    if (in.bad()) throw file_error(path.string() + ": reading failed" + reason());
    return text;
}

}  // namespace errbound::support
