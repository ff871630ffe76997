// POSIX.
#include <fcntl.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <memory>
#include <new>
#include <system_error>

#include "errbound/support/system/system.hpp"

namespace errbound::support::system {
namespace {

/// Read-only, so that writing to a closed stream still fails and is reported.
void open_standard_descriptors() {
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(descriptor, F_GETFD) == -1 && errno == EBADF) ::open("/dev/null", O_RDONLY);
}

constexpr std::size_t stack_size = 1 << 20;

[[gnu::noinline]] void touch_stack() {
    constexpr std::size_t page = 4096;
    [[maybe_unused]] volatile std::byte stack[stack_size];
    for (std::size_t end = stack_size; end > 0; end -= page) stack[end - 1] = std::byte{};
}

/// The main thread's stack grows on use and ends the program by a signal if address space is
/// missing. Growing it now makes that an error.
void grow_stack() {
    rlimit limit{};
    if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur < 2 * stack_size) return;
    void* const trial = mmap(nullptr, stack_size, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (trial == MAP_FAILED) throw std::bad_alloc();
    munmap(trial, stack_size);
    touch_stack();
}

}  // namespace

void start_program() {
    open_standard_descriptors();
    std::signal(SIGXFSZ, SIG_IGN);
    grow_stack();
}

bool is_terminal(int descriptor) {
    return isatty(descriptor) != 0;
}

std::size_t peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
    return static_cast<std::size_t>(usage.ru_maxrss);
#else
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // Linux and the BSDs count KiB
#endif
}
double memory_bytes() {
    return static_cast<double>(sysconf(_SC_PHYS_PAGES)) *
           static_cast<double>(sysconf(_SC_PAGESIZE));
}
double load() {
    double load = 0;
    getloadavg(&load, 1);
    return load;
}
std::filesystem::path program_file() {
    return "/proc/self/exe";
}
int process_number() {
    return getpid();
}
int run(const char* program, const std::string& argument) {
    const pid_t child = fork();
    if (child == 0) {
        execlp(program, program, argument.c_str(), static_cast<char*>(nullptr));
        _exit(127);
    }
    int status = 0;
    const bool ended = child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status);
    return ended ? WEXITSTATUS(status) : 127;
}

const std::string_view separators = "/";
const bool has_device_files = true;
std::string native_name(const std::filesystem::path& path) {
    return path.native();
}
std::string real_name(const std::string& name) {
    const std::unique_ptr<char, decltype(&std::free)> real(realpath(name.c_str(), nullptr),
                                                           &std::free);
    return real ? real.get() : "";
}
bool are_one_name(const std::string& a, const std::string& b) {
    return a == b;
}
bool exists(const std::string& name) {
    return access(name.c_str(), F_OK) == 0;
}
bool may_write(const std::string& file) {
    return access(file.c_str(), W_OK) == 0;
}
bool may_write_in(const std::string& folder) {
    return access(folder.c_str(), W_OK | X_OK) == 0;
}
bool replace(const std::string& from, const std::string& to) {
    return std::rename(from.c_str(), to.c_str()) == 0;
}
bool remove(const std::string& file) {
    return ::unlink(file.c_str()) == 0;
}

int create(const std::string& file) {
    constexpr mode_t all = 0666;  // minus the umask
    return ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, all);
}
int open_to_write(const std::string& file) {
    return ::open(file.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
}
int create_named(std::string& pattern) {
    return mkstemp(pattern.data());
}
int close(int descriptor) {
    return ::close(descriptor);
}
std::ptrdiff_t write(int descriptor, const char* from, std::size_t size) {
    return ::write(descriptor, from, size);
}
std::ptrdiff_t read_at(int descriptor, std::uint64_t offset, char* to, std::size_t size) {
    return ::pread(descriptor, to, size, static_cast<off_t>(offset));
}
void copy_rights(int descriptor, const std::string& other) {
    struct stat of {};
    constexpr mode_t permissions = 07777;
    if (stat(other.c_str(), &of) == 0) ::fchmod(descriptor, of.st_mode & permissions);
}

int lock(const std::string& folder) {
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0 || ::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
    const int reason = errno;
    ::close(descriptor);
    errno = reason;
    return -1;
}

failing_pipes::failing_pipes() : before_(std::signal(SIGPIPE, SIG_IGN)) {}
failing_pipes::~failing_pipes() {
    std::signal(SIGPIPE, before_);
}

}  // namespace errbound::support::system
