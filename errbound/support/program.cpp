#include "errbound/support/program.hpp"

#include <exception>
#include <iostream>
#include <new>

#include "errbound/support/command_line.hpp"
#include "errbound/support/system/system.hpp"
#include "errbound/support/table.hpp"

namespace errbound::support {

int run_program(const std::string& name, const std::function<int()>& body) {
    const auto failed = [&name](int status, const char* what) {
        std::cerr << name << ": " << printable(what, "\n") << '\n';
        return status;
    };
    int status = 0;
    try {
        system::start_program();
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
