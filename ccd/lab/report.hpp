// A report: error against run time, measured part by part into a folder.
#pragma once

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "ccd/lab/data_set.hpp"
#include "ccd/lab/tables.hpp"

namespace ccd::lab {

/// A table of a report, and the name of its CSV file.
struct section {
    std::string name;
    std::vector<std::string> columns;  ///< empty: all
};
/// Returns the sections methods, times, contacts, bounds, tightness and stress.
const std::vector<section>& sections();

struct report_options {
    std::vector<std::filesystem::path> data;  ///< folders
    bool made = false;                        ///< also with generated queries
    std::vector<std::string> sections = {};   ///< names; empty: all
    std::filesystem::path out;
    bool quick = false;
    std::vector<std::string> methods;  ///< names of ccd::methods(), and batch_name
    int threads = 0;                   ///< that count errors; 0: one per core
    std::string commit;

    bool wants(std::string_view section) const {
        return sections.empty() || std::ranges::find(sections, section) != sections.end();
    }
};

using progress = std::function<void(double)>;

struct picture {
    std::string file, caption;
};

struct report_summary {
    report_options settings;
    row machine;  ///< at the start
    double load_at_end = 0;
    std::string date;
    rows data;  ///< data_set, kind, origin, queries, colliding, truth
    std::vector<omission> skipped;
    std::size_t parts = 0, resumed = 0;  ///< `resumed` of the parts are from an earlier run
    std::map<std::string, rows> tables;  ///< by section
    std::vector<picture> pictures;
    std::vector<std::string> failures;  ///< broken promises and contradictions, a sentence each
};

/// A row per method over the rows of methods.csv that `counts` selects, in order of appearance:
/// method, the sums of queries, colliding, false_positives, false_negatives, uncertain, and ns, the
/// mean over all queries.
rows totals(const rows& methods, const std::function<bool(const row&)>& counts);

/// Measures the parts that the folder lacks; writes the CSV files, plot.py, its pictures, and
/// report.md. `show` gets the finished share and the next step; `print` gets lines for a person.
/// Throws errbound::support::file_error without data, or if a folder cannot be read or written.
report_summary make_report(const report_options& settings,
                           const std::function<void(double, const std::string&)>& show,
                           const std::function<void(const std::string&)>& print);

std::string text_of(const report_summary& report);

}  // namespace ccd::lab
