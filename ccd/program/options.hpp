// Options that several commands take.
#pragma once

#include <CLI/CLI.hpp>
#include <ccd/method.hpp>
#include <string>
#include <vector>

#include "ccd/program/device_run.hpp"

namespace ccd::program {

/// The method of that name. Throws usage_error.
ccd::method method_named(const std::string& name);

/// --method M[,M...], else all.
class methods_option {
  public:
    explicit methods_option(CLI::App& line);
    bool was_given() const { return option_->count() > 0; }
    /// Throws usage_error.
    std::vector<ccd::method> methods() const;

  private:
    std::string list_;
    CLI::Option* option_;
};

/// --device and --precision.
class device_options {
  public:
    explicit device_options(CLI::App& line);
    /// Throws usage_error, device_error.
    device_choice chosen() const;

  private:
    std::string device_ = "cpu", precision_;
};

/// Throws usage_error unless the method runs on devices.
void require_on_device(ccd::method m);

/// --threads, from 0, which is one per core.
void add_threads_option(CLI::App& line, int& threads, const std::string& description);

}  // namespace ccd::program
