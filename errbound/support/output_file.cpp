// Whole files in and out.
#include "errbound/support/output_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <errbound/support/error.hpp>
#include <fstream>
#include <iostream>
#include <memory>
#include <system_error>
#include <utility>

#include "errbound/support/descriptor.hpp"

namespace errbound::support {
namespace fs = std::filesystem;
namespace {

/// Why the last system call failed, as an end to a message.
std::string reason() {
    return errno != 0 ? std::string(" (") + std::strerror(errno) + ")" : std::string();
}

/// Block by block, not by the file's size: a pipe has none.
template <class Take>
void for_each_block(const fs::path& path, const Take& take) {
    errno = 0;
    std::ifstream in(path, std::ios::binary);
    if (!in) throw file_error(path.string() + ": cannot be read" + reason());
    std::array<char, 1 << 16> block;
    while (in.read(block.data(), block.size()), in.gcount() > 0)
        take(std::string_view(block.data(), static_cast<std::size_t>(in.gcount())));
    if (in.bad()) throw file_error(path.string() + ": reading failed" + reason());
}

/// While one of these lives, signals that would end the program are only taken down; the destructor
/// lets them. Beyond a limit on a file's size writing fails.
class deferred_signals {
  public:
    deferred_signals() {
        arrived = 0;
        for (std::size_t i = 0; i < signals.size(); ++i) {
            sigaction(signals[i], nullptr, &before_[i]);
            if (!is_default(before_[i])) continue;
            struct sigaction action {};
            action.sa_handler = signals[i] == SIGXFSZ ? SIG_IGN : take_down;  // no SA_RESTART
            sigaction(signals[i], &action, nullptr);
        }
    }
    deferred_signals(const deferred_signals&) = delete;
    deferred_signals& operator=(const deferred_signals&) = delete;
    ~deferred_signals() {
        for (std::size_t i = 0; i < signals.size(); ++i)
            if (is_default(before_[i])) sigaction(signals[i], &before_[i], nullptr);
        if (arrived != 0) std::raise(arrived);
    }

    static bool any() { return arrived != 0; }

  private:
    static constexpr std::array<int, 6> signals{SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGXFSZ};
    static inline volatile std::sig_atomic_t arrived = 0;

    static void take_down(int signal) { arrived = signal; }
    static bool is_default(const struct sigaction& action) {
        return (action.sa_flags & SA_SIGINFO) == 0 && action.sa_handler == SIG_DFL;
    }

    std::array<struct sigaction, signals.size()> before_;
};

/// Writes all to an open descriptor.
void write_to(int descriptor, const output& out) {
    const auto write = [&](std::string_view text) {
        write_all(descriptor, text, out.path, deferred_signals::any);
    };
    if (out.from.empty())
        write(out.text);
    else
        for_each_block(out.from, write);
}

/// The same, and closes it.
void write_and_close(int descriptor, const output& out) {
    const fs::path& shown = out.path;
    if (descriptor < 0) throw file_error(shown.string() + ": cannot be written" + reason());
    try {
        write_to(descriptor, out);
    } catch (...) {
        ::close(descriptor);
        throw;
    }
    // Where the disk is elsewhere it may be full only now.
    if (::close(descriptor) != 0) throw file_error(shown.string() + ": writing failed" + reason());
}

/// An output file that is written but not yet in its place.
class temporary_file {
  public:
    temporary_file(std::string target, const output& out) : target_(std::move(target)) {
        struct stat replaced {};
        const bool replaces = stat(target_.c_str(), &replaced) == 0;
        if (replaces && access(target_.c_str(), W_OK) != 0)
            throw file_error(out.path.string() + ": cannot be written" + reason());
        const int descriptor = create();
        try {
            constexpr mode_t permissions = 07777;
            if (replaces) ::fchmod(descriptor, replaced.st_mode & permissions);
            write_and_close(descriptor, out);
        } catch (...) {
            if (descriptor >= 0) ::unlink(path_.c_str());
            throw;
        }
    }
    temporary_file(temporary_file&& other) noexcept
        : target_(std::move(other.target_)), path_(std::exchange(other.path_, std::string())) {}
    temporary_file& operator=(temporary_file&&) = delete;
    ~temporary_file() {
        if (!path_.empty()) ::unlink(path_.c_str());
    }

    void put_in_place() {
        if (std::rename(path_.c_str(), target_.c_str()) != 0)
            throw file_error(target_ + ": cannot be replaced" + reason());
        path_.clear();
    }

  private:
    /// Opens a file of a new name beside the target. What a killed process left stays as it is.
    int create() {
        static unsigned count = 0;
        const std::string beside = target_.substr(0, target_.rfind('/') + 1) + ".errbound-" +
                                   std::to_string(getpid()) + "-";
        int descriptor = -1;
        do {
            path_ = beside + std::to_string(++count) + ".tmp";
            constexpr mode_t all = 0666;  // less what the umask takes
            descriptor = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, all);
        } while (descriptor < 0 && errno == EEXIST);
        return descriptor;
    }

    // Strings: a std::filesystem::path of libstdc++ 12 that finds no memory never returns.
    std::string target_, path_;
};

/// Where the file itself is, or is to be; nothing for a pipe or a device. Throws file_error.
std::optional<std::string> file_behind(const fs::path& path) {
    const auto refuse = [&path](const char* found) {
        throw file_error("'" + path.string() + "': found " + found + ", expected a file to write");
    };
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (fs::is_directory(status)) refuse("a directory");
    if (fs::exists(status)) {
        if (!fs::is_regular_file(status)) return std::nullopt;
        const std::unique_ptr<char, decltype(&std::free)> real(realpath(path.c_str(), nullptr),
                                                               &std::free);
        if (!real) throw file_error(path.string() + ": cannot be written" + reason());
        return real.get();
    }
    if (fs::is_symlink(fs::symlink_status(path, error))) refuse("a symbolic link to nothing");
    if (path.native().empty() || path.native().ends_with('/')) refuse("no file name");
    return path.native();
}

}  // namespace

std::optional<int> descriptor_of(const fs::path& path) {
    const std::string& name = path.native();
    if (name == "-" || name == "/dev/stdout") return STDOUT_FILENO;
    if (name == "/dev/stderr") return STDERR_FILENO;
    for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
        if (!name.starts_with(folder)) continue;
        int descriptor = 0;
        const char* const end = name.data() + name.size();
        const auto read = std::from_chars(name.data() + folder.size(), end, descriptor);
        if (read.ec == std::errc{} && read.ptr == end) return descriptor;
    }
    return std::nullopt;
}

void require_writable(const fs::path& path) {
    if (descriptor_of(path)) return;
    const auto require = [&path](const std::string& place, int rights) {
        if (access(place.c_str(), rights) != 0)
            throw file_error(path.string() + ": cannot be written" + reason());
    };
    const std::optional<std::string> file = file_behind(path);
    std::error_code error;
    const bool exists = !file || fs::exists(*file, error);
    if (error) throw file_error(path.string() + ": cannot be written (" + error.message() + ")");
    if (exists) require(file.value_or(path.native()), W_OK);
    if (!file) return;
    const std::string folder = file->substr(0, file->rfind('/') + 1);
    require(folder.empty() ? "." : folder, W_OK | X_OK);
}

void write_whole(const std::vector<output>& outputs) {
    const deferred_signals deferred;
    std::vector<temporary_file> files;
    std::vector<const output*> streams;
    files.reserve(outputs.size());
    for (const output& out : outputs) {
        const auto file = descriptor_of(out.path) ? std::nullopt : file_behind(out.path);
        if (file)
            files.emplace_back(*file, out);
        else
            streams.push_back(&out);
    }
    for (const output* out : streams) {
        if (const auto descriptor = descriptor_of(out->path)) {
            std::cout.flush();
            write_to(*descriptor, *out);
        } else {
            write_and_close(::open(out->path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY), *out);
        }
    }
    for (temporary_file& file : files) file.put_in_place();
}

void write_whole(const fs::path& path, std::string_view text) {
    write_whole({{path, std::string(text)}});
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
    std::string text;
    for_each_block(path, [&text](std::string_view block) { text += block; });
    return text;
}

}  // namespace errbound::support
