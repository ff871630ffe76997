// A report: error against run time, measured part by part into a folder.
#pragma once

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "ccd/report/measuring/data_set.hpp"
#include "ccd/report/measuring/machine.hpp"
#include "ccd/report/parts.hpp"

namespace ccd::report {

/// `exact` in batches, as a method of its own.
inline constexpr std::string_view batch_name = "exact, batch";

/// What can be asked for, by the name of its CSV file.
inline constexpr std::string_view section_names[] = {"methods", "times",     "contacts",
                                                     "bounds",  "tightness", "stress"};

struct options {
    std::vector<std::filesystem::path> data;  ///< folders
    bool made = false;                        ///< with queries that the program makes itself
    std::vector<std::string> sections = {};   ///< of section_names; empty: all
    std::filesystem::path out;
    bool quick = false;
    std::vector<std::string> methods;  ///< names of ccd::methods(), and batch_name
    int threads = 0;                   ///< that count errors; 0: one per core
    std::string commit;

    bool wants(std::string_view section) const {
        return sections.empty() || std::ranges::find(sections, section) != sections.end();
    }
};

/// What a data set held, for a person.
struct data_summary {
    std::string name;
    report::origin origin = origin::stored;
    struct counts {
        ccd::kind kind{};
        std::size_t queries = 0, colliding = 0, stored_truths = 0, contradictions = 0;
    };
    std::vector<counts> kinds;

    std::size_t queries() const {
        std::size_t all = 0;
        for (const counts& of : kinds) all += of.queries;
        return all;
    }
};

struct picture {
    std::string file;     ///< of the PNG, in the report's folder
    std::string caption;  ///< what it shows, and how to read it
};

/// All that report.md reports.
struct summary {
    options settings;
    machine here;  ///< at the start
    double load_at_end = 0;
    std::string date;
    std::vector<data_summary> data;
    std::vector<omission> left_out;
    std::size_t parts = 0, resumed = 0;  ///< of the parts, those found from an earlier run
    /// Of the CSV files of these names.
    rows methods, times, contacts, bounds, tightness, stress;
    std::vector<picture> pictures;
    std::vector<std::string> failures;  ///< broken promises and contradictions, a sentence each
};

/// A method over all data sets.
struct method_total {
    std::string method;
    std::size_t queries = 0, colliding = 0, false_positives = 0, false_negatives = 0, uncertain = 0;
    double ns = 0;  ///< per query, mean over all queries: of the least of several timings
};
/// One for each method of the rows of methods.csv that `counts` picks, in order of appearance.
std::vector<method_total> totals(const rows& methods,
                                 const std::function<bool(const row&)>& counts);

/// Measures what the folder does not hold yet and writes the CSV files, plot.py and what it draws,
/// and report.md. `show` gets the share that is done and what comes next; `say` gets lines for a
/// person. Throws errbound::support::file_error: no data, a folder that cannot be read or written.
summary make(const options& settings, const std::function<void(double, const std::string&)>& show,
             const std::function<void(const std::string&)>& say);

/// The text of report.md.
std::string markdown_of(const summary& report);

}  // namespace ccd::report
