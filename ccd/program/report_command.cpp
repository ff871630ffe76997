// `ccd report`: writes error against run time into a folder.
#include <algorithm>
#include <iostream>
#include <system_error>

#include "ccd/program/command.hpp"
#include "ccd/program/options.hpp"
#include "ccd/report/report.hpp"
#include "errbound/support/progress_line.hpp"
#include "errbound/support/table.hpp"

namespace ccd::program {
namespace {

using errbound::support::progress_line;
using errbound::support::table;
using errbound::support::text_of;

namespace fs = std::filesystem;

/// Returns the folder of bundled scenes: next to an installed program, or in the source tree.
fs::path bundled_scenes() {
    std::error_code error;
    const fs::path installed =
        fs::read_symlink("/proc/self/exe", error).parent_path() / ERRBOUND_RELATIVE_SCENES;
    if (!error && fs::is_directory(installed)) return installed.lexically_normal();
    return ERRBOUND_SCENES;
}

std::string fixed(double x) {
    char text[48];
    std::snprintf(text, sizeof text, "%.1f", x);
    return text;
}

std::string text_of_totals(const report::summary& result) {
    table lines = {{"method", "queries", "FP", "FN", "uncertain", "ns/query"}};
    for (const report::method_total& m :
         report::totals(result.methods, [](const report::row&) { return true; }))
        lines.push_back({m.method, std::to_string(m.queries), std::to_string(m.false_positives),
                         std::to_string(m.false_negatives), std::to_string(m.uncertain),
                         fixed(m.ns)});
    return text_of(lines, 1);
}

class report_run final : public command {
  public:
    explicit report_run(CLI::App& program)
        : command(program, "report",
                  "Measure error against run time: tables and pictures of all methods and bound\n"
                  "rules. A report that was stopped continues") {
        settings_.out = "out/report";
        settings_.commit = report::configured_commit();
        line_.add_option(
            "DATA", settings_.data,
            "Folders that are searched for stored queries (CSV; kind from the path) and scenes\n"
            "(folders of two meshes); by default the bundled scene and generated queries");
        line_.add_option("--out", settings_.out, "The report's folder; out/report by default")
            ->type_name("DIR");
        line_.add_flag("--quick", settings_.quick, "Time fewer queries");
        line_
            .add_option(
                "--sections", settings_.sections,
                "Only these sections: methods, times, contacts, bounds, tightness (needs a\n"
                "build with MPFR), stress")
            ->type_name("S[,S...]")
            ->delimiter(',')
            ->check(CLI::IsMember(std::vector<std::string>(std::begin(report::section_names),
                                                           std::end(report::section_names))));
        add_threads_option(line_, settings_.threads,
                           "Threads that count errors; 0: one per core (one thread takes times)");
        line_
            .add_option("--commit", settings_.commit,
                        "Commit for the report; by default that of the configured build")
            ->type_name("TEXT");
    }

    exit_status run() override {
        if (settings_.data.empty()) {
            settings_.data.push_back(bundled_scenes());
            settings_.made = true;
        }
        for (const ccd::method method : methods_.methods()) {
            if (std::ranges::find(settings_.methods, info(method).name) != settings_.methods.end())
                continue;
            settings_.methods.emplace_back(info(method).name);
            if (method == method::exact) settings_.methods.emplace_back(report::batch_name);
        }

        progress_line progress;
        const report::summary result = report::make(
            settings_, [&](double share, const std::string& what) { progress.show(share, what); },
            [&](const std::string& line) {
                progress.clear();
                std::cout << line << std::endl;
            });
        progress.clear();

        std::cout << text_of_totals(result) << "report: " << (settings_.out / "report.md").string()
                  << '\n';
        for (const std::string& failure : result.failures)
            std::cout << "FAILED: " << failure << '\n';
        return result.failures.empty() ? done : broken_promise;
    }

  private:
    report::options settings_;
    methods_option methods_{line_};
};

}  // namespace

std::unique_ptr<command> report_command(CLI::App& program) {
    return std::make_unique<report_run>(program);
}

}  // namespace ccd::program
