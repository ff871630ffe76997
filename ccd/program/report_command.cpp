// `ccd report`: error against run time, into a folder.
#include <algorithm>
#include <iostream>
#include <system_error>

#include "ccd/program/commands.hpp"
#include "ccd/report/report.hpp"
#include "errbound/support/error.hpp"
#include "errbound/support/progress_line.hpp"
#include "errbound/support/table.hpp"

namespace ccd::program {
namespace {

namespace fs = std::filesystem;

/// Where the bundled scenes are: beside an installed program, else in the source tree.
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

}  // namespace

bool run_report(const report_arguments& arguments) {
    report::options settings;
    settings.data = arguments.data;
    settings.out = arguments.out;
    settings.sections = arguments.sections;
    settings.quick = arguments.quick;
    settings.threads = arguments.threads;
    settings.commit = arguments.commit.value_or(report::configured_commit());
    if (settings.data.empty()) {
        settings.data.push_back(bundled_scenes());
        settings.made = true;
    }
    for (const ccd::method method : arguments.methods) {
        if (std::ranges::find(settings.methods, info(method).name) != settings.methods.end())
            continue;
        settings.methods.emplace_back(info(method).name);
        if (method == method::exact) settings.methods.emplace_back(report::batch_name);
    }

    progress_line progress;
    const report::summary result = report::make(
        settings, [&](double share, const std::string& what) { progress.show(share, what); },
        [&](const std::string& line) {
            progress.clear();
            std::cout << line << std::endl;
        });
    progress.clear();

    table lines = {{"method", "queries", "FP", "FN", "uncertain", "ns/query"}};
    for (const report::method_total& m :
         report::totals(result.methods, [](const report::row&) { return true; })) {
        lines.push_back({m.method, std::to_string(m.queries), std::to_string(m.false_positives),
                         std::to_string(m.false_negatives), std::to_string(m.uncertain),
                         fixed(m.ns)});
    }
    std::cout << text_of(lines, 1) << "report: " << (arguments.out / "report.md").string() << '\n';
    for (const std::string& failure : result.failures) std::cout << "FAILED: " << failure << '\n';
    return result.failures.empty();
}

}  // namespace ccd::program
