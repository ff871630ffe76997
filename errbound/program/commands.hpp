// The program's commands.
#pragma once

#include "errbound/support/command.hpp"

namespace errbound {

extern const support::command_maker validate_command, explain_command, ranges_command,
    conformance_command;

}  // namespace errbound
