#pragma once

#include <functional>
#include <string>

namespace errbound::support {

/// Returns the status of `body`; 2 if it throws usage_error; 1 if it throws another exception or
/// standard output cannot be written. Errors are printed to standard error after `name`. Closed
/// standard descriptors are opened first, so that no file gets their numbers and the output.
int run_program(const std::string& name, const std::function<int()>& body);

}  // namespace errbound::support
