#pragma once

#include <memory>

#include "errbound/support/command.hpp"

namespace ccd::program {

using errbound::support::add, errbound::support::add_flag, errbound::support::add_output;
using errbound::support::command, errbound::support::exit_status;
using enum errbound::support::exit_status;

std::unique_ptr<command> query_command(CLI::App& program);
std::unique_ptr<command> step_command(CLI::App& program);
std::unique_ptr<command> check_command(CLI::App& program);
std::unique_ptr<command> audit_command(CLI::App& program);
std::unique_ptr<command> bodies_command(CLI::App& program);
std::unique_ptr<command> stress_command(CLI::App& program);
std::unique_ptr<command> report_command(CLI::App& program);
std::unique_ptr<command> validate_command(CLI::App& program);
std::unique_ptr<command> convert_command(CLI::App& program);
std::unique_ptr<command> methods_command(CLI::App& program);
/// `ccd_mpi step`.
std::unique_ptr<command> distributed_step_command(CLI::App& program);

}  // namespace ccd::program
