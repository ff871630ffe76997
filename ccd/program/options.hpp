#pragma once

#include <ccd/contact.hpp>
#include <ccd/method.hpp>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "ccd/program/device_run.hpp"
#include "errbound/support/command.hpp"

namespace ccd::program {

ccd::method method_named(const std::string& name);

class methods_option {
  public:
    explicit methods_option(CLI::App& line);
    bool was_given() const { return option_.was_given(); }
    std::vector<ccd::method> methods() const;

  private:
    std::string list_;
    errbound::support::option option_;
};

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

/// A number: a decimal is rounded to nearest; a hexadecimal float must equal a double.
class number_option {
  public:
    number_option(CLI::App& line, const std::string& name, const std::string& description);
    bool was_given() const { return option_.was_given(); }
    /// `max` is 1 or the largest double. Throws usage_error unless the value is in [0, max].
    double value(double otherwise, double max) const;

  private:
    std::string name_, text_;
    errbound::support::option option_;
};

class unused_vertices_option {
  public:
    explicit unused_vertices_option(CLI::App& line);
    /// True if unused vertices are skipped. The default keeps them as points if the file has no
    /// other element.
    bool skips(std::size_t unused, std::size_t vertices) const;

  private:
    std::string choice_;
};

std::string text_of_unused(std::size_t unused, std::size_t vertices, bool skipped);

/// Returns `low,high` as hexadecimal floats, or `-` if there is no contact.
std::string text_of_time(const first_time& time);

struct query_files {
    std::vector<std::filesystem::path> paths;
    std::string kind;
    bool round = false;

    void add_options(CLI::App& line);
};

/// The scenes are next to an installed program, else in the source tree.
std::filesystem::path bundled_scenes();

/// --first and --count.
void add_range_options(CLI::App& line, std::uint64_t& first, std::uint64_t& count,
                       const std::string& of_first, const std::string& of_count);
void add_kind_option(CLI::App& line, std::string& kind);
void add_round_option(CLI::App& line, bool& round);
void add_threads_option(CLI::App& line, int& threads,
                        const std::string& description = "Threads; 0: one per core");
void add_triangulate_option(CLI::App& line, bool& triangulate);

}  // namespace ccd::program
