#include "errbound/support/program.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
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
