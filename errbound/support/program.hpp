#pragma once

#include <functional>
#include <string>

namespace errbound::support {

/// Returns the status of `body`. Returns 2 if it throws usage_error, and 1 if it throws anything
/// else or standard output fails, after a message that begins with `name`. Opens closed standard
/// descriptors first, so that no file gets their numbers.
int run_program(const std::string& name, const std::function<int()>& body);

}  // namespace errbound::support
