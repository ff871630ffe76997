// Options that several commands take.
#pragma once

#include <CLI/CLI.hpp>
#include <ccd/contact.hpp>
#include <ccd/method.hpp>
#include <cstddef>
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

/// An option whose value is a number, which is taken exactly: the double nearest to a decimal
/// number, or equal to a hexadecimal float.
class number_option {
  public:
    number_option(CLI::App& line, const std::string& name, const std::string& description);
    bool was_given() const { return option_->count() > 0; }
    /// `otherwise` where it was not given. Throws usage_error unless it is from 0 to `most`, which
    /// is 1 or the largest double.
    double value(double otherwise, double most) const;

  private:
    std::string name_, text_;
    CLI::Option* option_;
};

/// --unused-vertices: how the vertices of a file that no face and no edge has are taken.
class unused_vertices_option {
  public:
    explicit unused_vertices_option(CLI::App& line);
    /// True if they are skipped. By default they are points if the file has no other element.
    bool skips(std::size_t unused, std::size_t vertices) const;

  private:
    std::string choice_;
};

/// One line on them; none if there are none.
std::string text_of_unused(std::size_t unused, std::size_t vertices, bool skipped);

/// A first time as two fields of a line, `low,high`, hexadecimal floats; `-` where there is none.
std::string text_of_time(const first_time& time);

/// --threads, from 0, which is one per core.
void add_threads_option(CLI::App& line, int& threads, const std::string& description);

}  // namespace ccd::program
