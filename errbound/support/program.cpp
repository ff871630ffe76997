#include "errbound/support/program.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <exception>
#include <iostream>
#include <new>

#include "errbound/support/command_line.hpp"

namespace errbound::support {
namespace {

/// Opened to read only: writing to what was closed still fails, and is told.
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

/// The first thread's stack grows as it is used, and where no address space is left, that ends the
/// program by a signal: so it grows now, where what is missing can still be told.
void grow_stack() {
    rlimit limit{};
    if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur < 2 * stack_size) return;
    void* const trial = mmap(nullptr, stack_size, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (trial == MAP_FAILED) throw std::bad_alloc();
    munmap(trial, stack_size);
    touch_stack();
}

}  // namespace

int run_program(const std::string& name, const std::function<int()>& body) {
    open_standard_descriptors();
    std::signal(SIGXFSZ, SIG_IGN);  // writing beyond a limit on a file's size fails instead
    const auto failed = [&name](int status, const char* what) {
        std::cerr << name << ": " << what << '\n';
        return status;
    };
    int status = 0;
    try {
        grow_stack();
        status = body();
    } catch (const usage_error& error) {
        return failed(2, error.what());
    } catch (const std::bad_alloc&) {
        return failed(1, "out of memory");
    } catch (const std::exception& error) {
        return failed(1, error.what());
    }
    return std::cout.flush() ? status : failed(1, "standard output cannot be written");
}

}  // namespace errbound::support
