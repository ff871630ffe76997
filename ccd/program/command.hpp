#pragma once

#include <memory>

#include "errbound/support/command.hpp"

namespace ccd::program {

using errbound::support::add, errbound::support::add_flag, errbound::support::add_output;
using errbound::support::command, errbound::support::command_maker;
using errbound::support::exit_status, errbound::support::make_command;
using enum errbound::support::exit_status;

extern const command_maker query_command, step_command, check_command, audit_command,
    stress_command, report_command, validate_command, convert_command, methods_command;
std::unique_ptr<command> bodies_command(CLI::App& program);
extern const command_maker distributed_step_command;  ///< `ccd_mpi step`

}  // namespace ccd::program
