// The commands of the program, once their arguments are read. They print to standard output and
// throw io::file_error on bad input.
#pragma once

#include <ccd/batch.hpp>
#include <ccd/method.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ccd/io/query_file.hpp"
#include "ccd/program/on_device.hpp"
#include "ccd/stress/stress.hpp"

namespace ccd::program {

struct query_arguments {
    std::vector<std::filesystem::path> files;
    std::vector<ccd::method> methods;
    device_choice device;
    std::optional<ccd::kind> kind;  ///< none: from each path
    bool round = false;
    std::optional<std::filesystem::path> verdicts;  ///< with one file and one method only
    std::optional<std::filesystem::path> json;
};

/// Decides stored queries. Nothing is printed or written unless all files are good.
void run_query(const query_arguments& arguments);

struct step_arguments {
    std::filesystem::path before, after;
    ccd::method method = ccd::method::exact;
    device_choice device;
    int threads = 0;  ///< 0: as many as the machine has cores
    std::optional<instruction_set> set;
    bool explain = false;
    std::optional<std::filesystem::path> pairs;
    std::optional<std::filesystem::path> json;
};

/// One step of a mesh, from two frames to the colliding pairs.
void run_step(const step_arguments& arguments);

struct stress_arguments {
    stress::plan plan;
    std::optional<std::filesystem::path> out;  ///< folder for stress.csv and stress.md
    std::optional<std::filesystem::path> json;
};

/// Every method on stiff and extreme queries. Returns whether all promises were kept; else it says
/// which not and writes a query for each, to `out` or the current folder.
bool run_stress(const stress_arguments& arguments);

struct report_arguments {
    std::vector<std::filesystem::path>
        data;  ///< folders; none: the bundled scenes and made queries
    std::filesystem::path out = "out/report";
    std::vector<ccd::method> methods;
    std::vector<std::string> sections;  ///< of report::section_names; none: all
    bool quick = false;
    int threads = 0;  ///< that count errors; 0: as many as the machine has cores
    std::optional<std::string> commit;
};

/// Measures methods and bound rules on data sets and writes a report.
/// False if a method broke its promise.
bool run_report(const report_arguments& arguments);

/// Prints what methods there are.
void run_methods();

}  // namespace ccd::program
