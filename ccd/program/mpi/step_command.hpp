#pragma once

#include <CLI/CLI.hpp>
#include <memory>

#include "ccd/program/command.hpp"

namespace ccd::program {

std::unique_ptr<command> distributed_step_command(CLI::App& program);

}  // namespace ccd::program
