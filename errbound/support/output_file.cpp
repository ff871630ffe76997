#include "errbound/support/output_file.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <errbound/support/error.hpp>
#include <fstream>
#include <iostream>
#include <system_error>

#include "errbound/support/system/system.hpp"

namespace errbound::support {
namespace fs = std::filesystem;
namespace {

/// The end of a message: the last failure's reason, if known.
std::string reason() {
    return errno != 0 ? std::string(" (") + std::strerror(errno) + ")" : std::string();
}

std::string folder_of(const std::string& name) {
    return name.substr(0, name.find_last_of(system::separators) + 1);
}

bool is_standard_input(const fs::path& path) {
    return !system::has_device_files && path == "/dev/stdin";
}

/// Reads block by block, because a pipe has no size.
template <class Take>
void for_each_block(const fs::path& path, const Take& take) {
    errno = 0;
    std::ifstream file;
    if (!is_standard_input(path)) file.open(path, std::ios::binary);
    std::istream& in = is_standard_input(path) ? std::cin : file;
    if (!in) throw file_error(path.string() + ": cannot be read" + reason());
    std::array<char, 1 << 16> block;
    while (in.read(block.data(), block.size()), in.gcount() > 0)
        take(std::string_view(block.data(), static_cast<std::size_t>(in.gcount())));
    if (in.bad()) throw file_error(path.string() + ": reading failed" + reason());
}

void write_to(int descriptor, const output& out) {
    const auto write = [&](std::string_view text) { write_all(descriptor, text, out.path); };
    if (out.from.empty())
        write(out.text);
    else
        for_each_block(out.from, write);
}

void write_and_close(int descriptor, const output& out) {
    const fs::path& shown = out.path;
    if (descriptor < 0) throw file_error(shown.string() + ": cannot be written" + reason());
    try {
        write_to(descriptor, out);
    } catch (...) {
        system::close(descriptor);
        throw;
    }
    // A remote disk may report that it is full only now.
    if (system::close(descriptor) != 0)
        throw file_error(shown.string() + ": writing failed" + reason());
}

int create_beside(const std::string& target, std::string& name) {
    static std::atomic<unsigned> count = 0;
    const std::string beside =
        folder_of(target) + ".errbound-" + std::to_string(system::process_number()) + "-";
    int descriptor = -1;
    do {
        name = beside + std::to_string(++count) + ".tmp";
        descriptor = system::create(name);
    } while (descriptor < 0 && errno == EEXIST);
    return descriptor;
}

void replace_file(const std::string& target, const output& out) {
    const bool replaces = system::exists(target);
    if (replaces && !system::may_write(target))
        throw file_error(out.path.string() + ": cannot be written" + reason());
    std::string name;
    const int descriptor = create_beside(target, name);
    try {
        if (replaces) system::copy_rights(descriptor, target);
        write_and_close(descriptor, out);
        if (!system::replace(name, target))
            throw file_error(out.path.string() + ": cannot be replaced" + reason());
    } catch (...) {
        if (descriptor >= 0) system::remove(name);
        throw;
    }
}

/// The file's real name, also of a new file; nothing for a pipe or a device. Throws file_error.
std::optional<std::string> file_behind(const fs::path& path) {
    const auto refuse = [&path](const char* fault) {
        throw file_error("'" + path.string() + "' " + fault + "; expected a file to write");
    };
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (fs::is_directory(status)) refuse("is a directory");
    if (fs::exists(status)) {
        if (!fs::is_regular_file(status)) return std::nullopt;
        std::string real = system::real_name(system::native_name(path));
        if (real.empty()) throw file_error(path.string() + ": cannot be written" + reason());
        return real;
    }
    if (fs::is_symlink(fs::symlink_status(path, error))) refuse("is a symbolic link to nothing");
    std::string name = system::native_name(path);
    if (name.empty() || folder_of(name) == name) refuse("has no file name");
    return name;
}

void write_one(const output& out) {
    if (const auto descriptor = descriptor_of(out.path)) {
        std::cout.flush();
        write_to(*descriptor, out);
    } else if (const auto file = file_behind(out.path)) {
        replace_file(*file, out);
    } else {
        write_and_close(system::open_to_write(system::native_name(out.path)), out);
    }
}

}  // namespace

std::optional<int> descriptor_of(const fs::path& path) {
    const std::string name = system::native_name(path);
    if (name == "-" || name == "/dev/stdout") return 1;
    if (name == "/dev/stderr") return 2;
    for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
        if (!name.starts_with(folder)) continue;
        int descriptor = 0;
        const char* const end = name.data() + name.size();
        const auto read = std::from_chars(name.data() + folder.size(), end, descriptor);
        if (read.ec == std::errc{} && read.ptr == end) return descriptor;
    }
    return std::nullopt;
}

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

void require_writable(const fs::path& path) {
    if (descriptor_of(path)) return;
    const auto require = [&path](bool allowed) {
        if (!allowed) throw file_error(path.string() + ": cannot be written" + reason());
    };
    const std::optional<std::string> file = file_behind(path);
    std::error_code error;
    const bool exists = !file || fs::exists(path, error);
    if (error) throw file_error(path.string() + ": cannot be written (" + error.message() + ")");
    if (exists) require(system::may_write(file.value_or(system::native_name(path))));
    if (!file) return;
    const std::string folder = folder_of(*file);
    require(system::may_write_in(folder.empty() ? "." : folder));
}

void write_whole(const std::vector<output>& outputs) {
    for (const output& out : outputs) write_one(out);
}

void write_whole(const fs::path& path, std::string_view text) {
    write_one({path, std::string(text)});
}

std::string read_whole(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (status.type() == fs::file_type::not_found && !is_standard_input(path)) {
        throw file_error(path.string() + ": file does not exist; expected a readable file");
    }
    if (fs::is_directory(status)) {
        throw file_error(path.string() + ": path is a directory; expected a file");
    }
    std::string text;
    for_each_block(path, [&text](std::string_view block) { text += block; });
    return text;
}

}  // namespace errbound::support
