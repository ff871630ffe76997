// The program's commands.
#pragma once

#include <memory>

#include "errbound/support/command.hpp"

namespace errbound {

std::unique_ptr<support::command> validate_command(CLI::App& program);
std::unique_ptr<support::command> explain_command(CLI::App& program);
std::unique_ptr<support::command> ranges_command(CLI::App& program);
std::unique_ptr<support::command> conformance_command(CLI::App& program);

}  // namespace errbound
