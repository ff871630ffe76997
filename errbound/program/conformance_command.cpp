// `errbound conformance`.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <errbound/support/error.hpp>
#include <filesystem>
#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "errbound/program/commands.hpp"
#include "errbound/program/named_rules.hpp"
#include "errbound/program/published/sets.hpp"
#include "errbound/program/ratio_plot.hpp"
#include "errbound/support/output_file.hpp"
#include "errbound/support/progress_line.hpp"
#include "errbound/support/rows.hpp"

namespace errbound::validation {
namespace {

using support::row, support::rows;

class conformance_command final : public support::command {
  public:
    explicit conformance_command(CLI::App& program);
    support::exit_status run() override;

  private:
    void compare(const std::filesystem::path& path);
    rows table() const;
    rows skipped() const;
    std::string picture() const;

    std::string folder_, rules_ = "all";
    conformance found_;
    std::map<std::string, std::filesystem::path> results_;  ///< of polynomials, by name
    std::optional<std::filesystem::path> csv_, json_, picture_;
};

conformance_command::conformance_command(CLI::App& program)
    : command(program, "conformance",
              "Compare the library with published test vectors: one table of wrong answers and "
              "tightness.\nReads orient2d.txt, orient3d.txt, incircle.txt and insphere.txt (index, "
              "coordinates, sign),\nITF1788's .itl, CORE-MATH's .wc, MPSolve's .pol with .res, and "
              ".fpcore, in all subfolders.\nExit status: 0 if no answer was wrong, 1 bad input or "
              "wrong answers, 2 bad usage") {
    support::add(line_, "FOLDER", folder_, "Folder of published files").required().type("DIR");
    support::add(line_, "--rules", rules_, "Bound rules R[,R...]; all by default").type("R[,R...]");
    support::add(line_, "--seconds", found_.options.seconds, "Limit of each bound of a program")
        .between(0.0, 1e9)
        .shows_default();
    found_.options.measured = 1000;
    support::add(line_, "--measured", found_.options.measured,
                 "Random inputs of each program of which MPFR measures each error")
        .between(std::uint64_t{0}, std::uint64_t{1} << 50)
        .shows_default();
    support::add_output(line_, "--csv", csv_, "Write the table as CSV");
    support::add_output(line_, "--json", json_,
                        "Write the table, skipped vectors and wrong answers as JSON");
    support::add_output(line_, "--picture", picture_, "Draw the medians of the table, an SVG file");
}

void conformance_command::compare(const std::filesystem::path& path) {
    const std::string kind = path.extension().string();
    if (kind == ".res") return;  // read with its polynomial
    const auto text = [&] { return published_file{path, support::read_whole(path)}; };
    if (kind == ".txt") return compare_predicates(text(), found_);
    if (kind == ".itl") return compare_intervals(text(), found_);
    if (kind == ".wc") return compare_functions(text(), found_);
    if (kind == ".fpcore") return compare_cores(text(), found_);
    if (kind != ".pol") return found_.skip("files", "a file is of no kind that is read");
    const published_file file = text();
    const auto results = results_.find(file.stem());
    compare_polynomial(file, results == results_.end() ? "" : support::read_whole(results->second),
                       found_);
}

rows conformance_command::table() const {
    rows all;
    for (const conformance_row& r : found_.rows)
        all.push_back({{"set", r.set},
                       {"subject", r.subject},
                       {"method", r.method},
                       {"cases", r.cases},
                       {"wrong", r.promises ? row(r.wrong) : row()},
                       {"uncertain", r.uncertain},
                       {"median_ratio",
                        r.log10.ratios() > 0 ? row(std::pow(10, r.log10.quantile(0.5))) : row()}});
    return all;
}

rows conformance_command::skipped() const {
    rows all;
    for (const auto& [what, vectors] : found_.skipped)
        all.push_back(
            {{"skipped", what.first},
             {"reason", what.second + (vectors.names.empty() ? "" : ": " + vectors.names)},
             {"count", vectors.count}});
    return all;
}

std::string conformance_command::picture() const {
    std::vector<std::string> methods;
    for (const conformance_row& r : found_.rows)
        if (std::ranges::find(methods, r.method) == methods.end()) methods.push_back(r.method);
    std::vector<explaining::ratio_line> lines;
    for (const conformance_row& r : found_.rows) {
        if (r.log10.ratios() == 0) continue;
        const std::string name = r.set + ", " + r.subject;
        auto line = std::ranges::find(lines, name, &explaining::ratio_line::first);
        if (line == lines.end())
            line = lines.insert(line, {name, std::vector<double>(methods.size(), NAN)});
        const auto method = std::ranges::find(methods, r.method) - methods.begin();
        line->second[static_cast<std::size_t>(method)] = std::pow(10, r.log10.quantile(0.5));
    }
    return explaining::ratio_plot("median of bound / true error, or of the ratio of two widths",
                                  methods, lines);
}

support::exit_status conformance_command::run() {
    found_.options.rules = rules_with_errors(rules_);
    if (!std::filesystem::is_directory(folder_))
        throw support::file_error(folder_ + " is no folder; expected a folder of test vectors");
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_))
        if (entry.is_regular_file()) files.push_back(entry.path());
    support::require_good_outputs({csv_, json_, picture_}, files);
    std::ranges::sort(files);
    for (const std::filesystem::path& path : files)
        if (path.extension() == ".res") results_[path.stem().string()] = path;
    support::progress_line progress;
    for (std::size_t i = 0; i < files.size(); ++i) {
        progress.show(i, files.size(), files[i].filename().string());
        compare(files[i]);
    }
    progress.clear();
    if (found_.rows.empty()) {
        std::string reason;
        for (const row& r : skipped())
            reason += (reason.empty() ? ": " : "; ") + r["reason"].get<std::string>();
        throw support::file_error(folder_ + " has no test vectors" + reason +
                                  "; expected files of the kinds in errbound conformance --help");
    }
    std::ranges::stable_sort(found_.rows, {}, &conformance_row::set);
    const rows all = table(), left_out = skipped();
    std::vector<support::output> outputs;
    if (csv_) outputs.push_back({*csv_, support::csv_of(support::columns_of(all), all)});
    if (json_)
        outputs.push_back(
            {*json_,
             support::json_of({{"table", all}, {"skipped", left_out}, {"wrong", found_.wrong}}, 2) +
                 '\n'});
    if (picture_) outputs.push_back({*picture_, picture()});
    support::write_whole(outputs);
    std::ostream& people = support::stream_for_people({csv_, json_, picture_});
    people << support::text_of(all) << '\n' << support::text_of(left_out);
    for (std::size_t i = 0; i < std::min<std::size_t>(found_.wrong.size(), 20); ++i)
        people << support::printable(found_.wrong[i]) << '\n';
    people << (left_out.empty() ? "" : "\n")
           << (found_.wrong.empty() ? "no" : std::to_string(found_.wrong.size()))
           << (found_.wrong.size() == 1 ? " wrong answer\n" : " wrong answers\n");
    return found_.wrong.empty() ? support::done : support::broken_promise;
}

}  // namespace
}  // namespace errbound::validation

const errbound::support::command_maker errbound::conformance_command =
    errbound::support::make_command<validation::conformance_command>;
