// Shared by the benchmarks: their command lines, and tables for people and machines.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <string_view>

#include "ccd/lab/tables.hpp"
#include "ccd/lab/timing.hpp"

namespace bench {

using ccd::lab::clock;
using ccd::lab::keep;
using ccd::lab::race;
using ccd::lab::row;
using ccd::lab::rows;
using ccd::lab::seconds_since;
using ccd::lab::timing;

/// Prints a line of text, without the delay of a buffer.
void say(const std::string& line);

/// Prints tables immediately and collects them.
class report {
  public:
    /// Prints the rows under a title and keeps them with `about`, which they have in common
    /// ("scene": "cloth-ball").
    void table(std::string_view section, const row& about, const std::string& title,
               const rows& all);
    const row& tables() const { return tables_; }

  private:
    row tables_ = row::array();
};

/// A benchmark's command line, with --quick, --json and --commit.
class program {
  public:
    program(const std::string& name, const std::string& description);

    CLI::App line;
    bool quick = false;  ///< fewer repeats and inputs: shows that all works
    int status = 0;      ///< returned by run

    int repeats() const { return quick ? 3 : 7; }
    /// Parses the line, prints the machine with the columns of `more`, calls the body and writes
    /// the tables. Returns the exit status.
    int run(int argc, char** argv, const std::function<void(report&)>& body,
            const std::function<row()>& more = {});

  private:
    std::string name_, json_, commit_ = "unknown";
};

}  // namespace bench
