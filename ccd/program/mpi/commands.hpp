// The commands of ccd_mpi.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>

#include "ccd/program/command.hpp"

namespace ccd::program {

std::unique_ptr<command> distributed_step_command(CLI::App& program);
std::unique_ptr<command> distributed_query_command(CLI::App& program);
std::unique_ptr<command> distributed_stress_command(CLI::App& program);

}  // namespace ccd::program
