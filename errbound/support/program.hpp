// What every main does.
#pragma once

#include <functional>
#include <string>

namespace errbound::support {

/// The status that `body` returns; or, with a message that begins with the program's `name` on
/// standard error, 2 if it throws usage_error, 1 if it throws anything else or if standard output
/// cannot be written. Standard descriptors that are closed are opened first, so that no file takes
/// their numbers and gets what is printed.
int run_program(const std::string& name, const std::function<int()>& body);

}  // namespace errbound::support
