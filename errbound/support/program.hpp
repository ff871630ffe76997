#pragma once

#include <functional>
#include <string>

namespace errbound::support {

/// Returns the status of `body`; 2 if it throws usage_error, 1 if it throws anything else or
/// standard output fails. Messages begin with `name`. Opens closed standard descriptors first, so
/// that no file gets their numbers.
int run_program(const std::string& name, const std::function<int()>& body);

}  // namespace errbound::support
