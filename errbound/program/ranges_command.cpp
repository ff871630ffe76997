// `errbound ranges`.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <errbound/support/error.hpp>
#include <filesystem>
#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "errbound/program/commands.hpp"
#include "errbound/program/flame_graph.hpp"
#include "errbound/program/named_rules.hpp"
#include "errbound/program/published/fpcore.hpp"
#include "errbound/program/published/text.hpp"
#include "errbound/program/ratio_plot.hpp"
#include "errbound/support/decimal.hpp"
#include "errbound/support/hexadecimal.hpp"
#include "errbound/support/output_file.hpp"
#include "errbound/support/progress_line.hpp"
#include "errbound/support/rows.hpp"

namespace errbound::validation {
namespace {

using support::row, support::rows;

class ranges final : public support::command {
  public:
    explicit ranges(CLI::App& program);
    support::exit_status run() override;

  private:
    void add_comparisons_and_outputs();
    std::vector<fpcore> read_cores() const;
    void print(std::ostream& people) const;

    std::vector<std::string> files_;
    row row_of(const fpcore& core, worst_case_result& found) const;
    std::vector<std::string> compared() const;
    std::string picture() const;

    std::string precision_, only_, rules_;
    worst_case_options options_;
    std::vector<std::filesystem::path> published_;
    std::optional<std::filesystem::path> csv_, json_, picture_, operations_;
    std::map<std::string, std::map<std::string, double>> others_;  ///< bounds by source and core
    rows done_, not_done_;
    std::vector<explanation> explanations_;
};

constexpr std::uint64_t most_count = std::uint64_t{1} << 50;

const std::vector<std::string> first_columns{"core", "precision", "at_most", "at_least", "ratio"},
    last_columns{"relative", "lower", "upper", "boxes", "complete", "seconds"};

ranges::ranges(CLI::App& program)
    : command(
          program, "ranges",
          "Bound the rounding error of FPCore programs over all inputs that their preconditions "
          "allow,\nand search for inputs with a large error. Cores that cannot be bounded are "
          "listed with the reason") {
    support::add(line_, "FILE", files_, "FPCore files; - is standard input")
        .required()
        .type("FILE...");
    support::add(line_, "--only", only_, "Only the cores of that name").type("NAME");
    support::add(line_, "--precision", precision_,
                 "Use this precision for all cores, instead of their own")
        .among({"binary64", "binary32", "binary16", "binary80", "bfloat16", "e5m2", "e4m3"});
    support::add_flag(line_, "--round-inputs", options_.round_inputs,
                      "Inputs are real numbers; their rounding counts");
    support::add_flag(line_, "--relative", options_.relative, "Bound the relative error, too");
    support::add(line_, "--function-units", options_.function_units,
                 "Errors of elementary functions in units in the last place, instead of "
                 "function_error;\n0.5 for correct rounding")
        .between(0.5, 1024.0);
    support::add(line_, "--gap", options_.gap,
                 "Stop if further bisection can lower the bound by at most this share")
        .between(0.0, 1e6)
        .shows_default();
    support::add(line_, "--seconds", options_.seconds, "Limit of each bound")
        .between(0.0, 1e9)
        .shows_default();
    support::add(line_, "--boxes", options_.boxes, "Limit of each bound")
        .between(std::uint64_t{0}, most_count)
        .shows_default();
    support::add(line_, "--samples", options_.samples, "Inputs that each search tries")
        .between(std::uint64_t{0}, most_count)
        .shows_default();
    support::add(line_, "--measured", options_.measured,
                 "Random inputs of which MPFR measures each error, too")
        .between(std::uint64_t{0}, most_count);
    support::add(line_, "--seed", options_.seed, "Seed of the search")
        .check(support::checked_seed)
        .shows_default();
    add_comparisons_and_outputs();
}

void ranges::add_comparisons_and_outputs() {
    support::add(line_, "--rules", rules_,
                 "Search for the largest error() of these bound rules, too; all: every rule")
        .type("R[,R...]");
    support::add(line_, "--published", published_,
                 "Compare with other bounds: lines CORE,BOUND, the core's name without commas. "
                 "The\ncolumn has the file's name; may be repeated")
        .type("FILE");
    support::add_output(line_, "--csv", csv_, "Write the table as CSV");
    support::add_output(line_, "--json", json_,
                        "Write all results, with inputs and operations, as JSON");
    support::add_output(line_, "--picture", picture_,
                        "Draw all bounds as multiples of the observed error, an SVG file");
    support::add_output(line_, "--operations", operations_,
                        "Draw each bound's operations, an SVG file");
}

std::map<std::string, double> published_bounds(const std::filesystem::path& path) {
    std::map<std::string, double> bounds;
    const std::string text = support::read_whole(path);
    for_each_line(text, [&](std::size_t number, std::string_view line) {
        if (line.empty() || line[0] == '#') return;
        const std::size_t comma = line.rfind(',');
        const auto bound = support::parse_decimal<double>(
            line.substr(comma == std::string_view::npos ? 0 : comma + 1));
        if (comma == std::string_view::npos || bound.status != support::decimal_status::ok ||
            !(bound.value >= 0))
            throw support::file_error(path.string() + ':' + std::to_string(number) + ": line is '" +
                                      std::string(line) + "'; expected CORE,BOUND");
        bounds[std::string(line.substr(0, comma))] = bound.value;
    });
    return bounds;
}

row number(double x) {
    return std::isfinite(x) ? row(x) : row();
}
row ranges::row_of(const fpcore& core, worst_case_result& found) const {
    const double ratio = found.at_most == found.at_least ? 1 : found.at_most / found.at_least;
    row where = row::array(), operations = row::array();
    for (const double x : found.where) where.push_back(support::hexadecimal(x));
    for (const contribution& c : found.by_operation.contributions)
        operations.push_back({{"operation", c.operation},
                              {"line", c.scopes.empty() ? row() : row(c.scopes.back().line)},
                              {"amount", c.amount}});
    row r{{"at_most", number(found.at_most)},
          {"at_least", found.at_least},
          {"ratio", number(ratio)},
          {"relative", options_.relative ? number(found.relative_at_most) : row()},
          {"lower", number(found.lower)},
          {"upper", number(found.upper)},
          {"boxes", found.boxes},
          {"complete", found.complete},
          {"seconds", found.seconds},
          {"where", where},
          {"operations", operations}};
    for (const rule_bound& b : found.by_rule) r[b.rule] = number(b.largest);
    for (const auto& [source, bounds] : others_)
        if (const auto other = bounds.find(core.name); other != bounds.end())
            r[source] = other->second;
    if (!std::isfinite(found.at_most)) r["reason"] = no_finite_bound;
    if (found.where.empty() && found.at_most == 0)
        r["reason"] = "no number of the format satisfies the precondition";
    return r;
}
double median(std::vector<double> x) {
    std::ranges::sort(x);
    return x.empty() ? NAN : (x[x.size() / 2] + x[(x.size() - 1) / 2]) / 2;
}

std::vector<fpcore> ranges::read_cores() const {
    std::vector<fpcore> cores;
    for (const std::string& file : files_)
        for (fpcore& core : parse_fpcores(support::read_whole(file), file))
            if (only_.empty() || core.name == only_) cores.push_back(std::move(core));
    if (cores.empty() && !only_.empty())
        throw support::usage_error("--only is '" + only_ + "'; expected a core of the files");
    return cores;
}

support::exit_status ranges::run() {
    std::vector<std::filesystem::path> inputs;
    for (std::string& file : files_) inputs.emplace_back(file = support::input_named(file));
    inputs.insert(inputs.end(), published_.begin(), published_.end());
    support::require_one_standard_input("FILE", inputs);
    support::require_good_outputs({csv_, json_, picture_, operations_}, inputs);
    if (was_given("--rules")) options_.rules = rules_with_errors(rules_);
    const std::vector<fpcore> cores = read_cores();
    for (const std::filesystem::path& path : published_)
        if (const std::string name = path.stem().string();
            std::ranges::find(first_columns, name) != first_columns.end() ||
            std::ranges::find(last_columns, name) != last_columns.end() ||
            std::ranges::find(rules(), name, &rule::name) != rules().end() ||
            !others_.emplace(name, published_bounds(path)).second)
            throw support::usage_error("--published is '" + path.string() +
                                       "'; expected a name other than those of columns");
    support::progress_line progress;
    for (std::size_t i = 0; i < cores.size(); ++i) {
        const fpcore& core = cores[i];
        progress.show(i, cores.size(), core.name);
        const std::string& precision = precision_.empty() ? core.precision : precision_;
        row r{{"core", core.name}, {"precision", precision}, {"file", core.file}};
        try {
            worst_case_result found = worst_case_of(core, options_, precision_);
            r.update(row_of(core, found));
            found.by_operation.name = core.name;
            if (std::isfinite(found.at_most))
                explanations_.push_back(std::move(found.by_operation));
        } catch (const unsupported_core& e) {
            r["reason"] = e.what();
        }
        (r.contains("reason") ? not_done_ : done_).push_back(std::move(r));
    }
    progress.clear();
    std::vector<support::output> outputs;
    std::vector<std::string> columns = first_columns, more = compared();
    columns.insert(columns.end(), more.begin(), more.end());
    columns.insert(columns.end(), last_columns.begin(), last_columns.end());
    if (csv_) outputs.push_back({*csv_, support::csv_of(columns, done_)});
    if (json_)
        outputs.push_back(
            {*json_, support::json_of({{"done", done_}, {"not_done", not_done_}}, 2) + '\n'});
    if (picture_) outputs.push_back({*picture_, picture()});
    if (operations_) outputs.push_back({*operations_, explaining::flame_graphs(explanations_)});
    support::write_whole(outputs);
    print(support::stream_for_people({csv_, json_, picture_, operations_}));
    return support::done;
}

/// Columns of other bounds: the rules, then the published ones.
std::vector<std::string> ranges::compared() const {
    std::vector<std::string> names;
    for (const rule& r : options_.rules) names.emplace_back(r.name);
    for (const auto& [source, bounds] : others_) names.push_back(source);
    return names;
}

std::string ranges::picture() const {
    std::vector<std::string> series{"at_most"};
    for (std::string& name : compared()) series.push_back(std::move(name));
    std::vector<explaining::ratio_line> lines;
    for (const row& r : done_) {
        std::vector<double> ratios;
        for (const std::string& name : series)
            ratios.push_back(r.contains(name) && !r[name].is_null()
                                 ? r[name].get<double>() / r["at_least"].get<double>()
                                 : NAN);
        lines.emplace_back(r["core"], ratios);
    }
    return explaining::ratio_plot("bound / observed error", series, lines);
}

void ranges::print(std::ostream& people) const {
    const auto up = [](const row& x) { return x.is_null() ? row() : row(detail::scientific(x)); };
    rows shown;
    std::vector<double> ratios, seconds;
    for (const row& r : done_) {
        row& s = shown.emplace_back(row{{"core", r["core"]}, {"precision", r["precision"]}});
        s["error at most"] = up(r["at_most"]);
        s["at least"] = support::fixed(r["at_least"].get<double>() * (1 - 0x1p-8), "%.2e");
        s["ratio"] = r["ratio"].is_null() ? row() : row(support::fixed(r["ratio"], "%.2f"));
        for (const std::string& name : compared()) s[name] = up(r.value(name, row()));
        if (options_.relative) s["relative"] = up(r["relative"]);
        for (const char* end : {"lower", "upper"}) s[end] = support::fixed(r[end], "%.4g");
        s["boxes"] = r["boxes"];
        s["seconds"] = support::fixed(r["seconds"], "%.2f");
        if (!r["complete"].get<bool>()) s["seconds"] = s["seconds"].get<std::string>() + " (limit)";
        if (!r["ratio"].is_null()) ratios.push_back(r["ratio"]);
        seconds.push_back(r["seconds"]);
    }
    people << support::text_of(shown);
    people << (shown.empty() ? "" : "\n") << done_.size()
           << (done_.size() == 1 ? " core bounded" : " cores bounded");
    if (!ratios.empty())
        people << "; medians: " << support::fixed(median(ratios), "%.2f")
               << " of bound/observed error, " << support::fixed(median(seconds), "%.2f")
               << " s; slowest: " << support::fixed(std::ranges::max(seconds), "%.2f") << " s";
    people << '\n';
    for (const auto& [source, bounds] : others_) {
        std::vector<double> shares;
        for (const row& r : done_)
            if (r.contains(source))
                shares.push_back(r["at_most"].get<double>() / r[source].get<double>());
        if (!shares.empty())
            people << std::ranges::count_if(shares, [](double s) { return s <= 1; }) << " of "
                   << shares.size() << " bounds are at most those of " << source
                   << "; largest ratio to them: "
                   << support::fixed(std::ranges::max(shares), "%.2f") << '\n';
    }
    if (not_done_.empty()) return;
    rows reasons;
    for (const row& r : not_done_)
        reasons.push_back({{"not bounded", r["core"]}, {"reason", r["reason"]}});
    people << '\n' << support::text_of(reasons);
}

}  // namespace
}  // namespace errbound::validation

const errbound::support::command_maker errbound::ranges_command =
    errbound::support::make_command<validation::ranges>;
