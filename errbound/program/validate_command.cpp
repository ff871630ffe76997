// `errbound validate`: runs what was asked for, and reports it as tables, JSON and CSV.
#include "errbound/program/validate_command.hpp"

#include <cmath>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "errbound/support/command_line.hpp"
#include "errbound/support/output_file.hpp"
#include "errbound/support/progress_line.hpp"
#include "errbound/support/table.hpp"

namespace errbound::validation {
namespace {

using errbound::support::progress_line;
using errbound::support::table;
using errbound::support::text_of;
using errbound::support::write_whole;

using nlohmann::ordered_json;

/// What was found by one part of the run.
struct part {
    std::string name;  ///< "expressions", "tiny" or the file
    report found;
};

struct named_quantile {
    const char* name;
    double share;
};
constexpr named_quantile quantiles[] = {{"min", 0},      {"q01", 0.01}, {"q25", 0.25},
                                        {"median", 0.5}, {"q75", 0.75}, {"q99", 0.99},
                                        {"max", 1}};

std::string text_of_counts(const std::vector<part>& parts) {
    table rows{{"part", "rule", "number", "cases", "values", "violations", "undetermined"}};
    for (const part& p : parts)
        for (const rule_counts& c : p.found.counts)
            rows.push_back({p.name, c.rule, c.number, std::to_string(c.cases),
                            std::to_string(c.values), std::to_string(c.violations),
                            std::to_string(c.undetermined)});
    return text_of(rows, 3);
}

std::string text_of_tightness(const std::vector<part>& parts) {
    table rows{{"part", "rule", "number", "quantity", "measure", "ratios", "exact", "unknown"}};
    for (const named_quantile& q : quantiles) rows.front().push_back(q.name);
    for (const part& p : parts)
        for (const tightness& t : p.found.distributions) {
            rows.push_back({p.name, t.rule, t.number, t.quantity, t.measure,
                            std::to_string(t.log10.ratios()), std::to_string(t.log10.exact()),
                            std::to_string(t.log10.unknown())});
            for (const named_quantile& q : quantiles) {
                char text[32] = "-";
                if (t.log10.ratios() > 0)
                    std::snprintf(text, sizeof text, "%.2f", t.log10.quantile(q.share));
                rows.back().push_back(text);
            }
        }
    return rows.size() > 1 ? text_of(rows, 5) : std::string();
}

std::string text_of_violations(const std::vector<part>& parts) {
    std::string text;
    for (const part& p : parts)
        for (const violation& v : p.found.violations)
            text += "\nviolation: " + p.name + ", " + v.rule + ", " + v.number + "\n" + v.what +
                    "\n" + v.code;
    return text;
}

ordered_json number_or_null(double x) {
    return std::isfinite(x) ? ordered_json(x) : ordered_json(nullptr);
}

std::string json_of(const std::vector<part>& parts) {
    ordered_json all{{"counts", ordered_json::array()},
                     {"violations", ordered_json::array()},
                     {"tightness", ordered_json::array()}};
    for (const part& p : parts) {
        for (const rule_counts& c : p.found.counts)
            all["counts"].push_back({{"part", p.name},
                                     {"rule", c.rule},
                                     {"number", c.number},
                                     {"cases", c.cases},
                                     {"values", c.values},
                                     {"violations", c.violations},
                                     {"undetermined", c.undetermined}});
        for (const violation& v : p.found.violations)
            all["violations"].push_back({{"part", p.name},
                                         {"rule", v.rule},
                                         {"number", v.number},
                                         {"what", v.what},
                                         {"code", v.code}});
        for (const tightness& t : p.found.distributions) {
            ordered_json entry{{"part", p.name},           {"rule", t.rule},
                               {"number", t.number},       {"quantity", t.quantity},
                               {"measure", t.measure},     {"ratios", t.log10.ratios()},
                               {"exact", t.log10.exact()}, {"unknown", t.log10.unknown()}};
            for (const named_quantile& q : quantiles)
                entry[q.name] = number_or_null(t.log10.quantile(q.share));
            all["tightness"].push_back(std::move(entry));
        }
    }
    // A path need not be UTF-8; the default would throw on such a one.
    return all.dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

/// A field, quoted where CSV asks for it.
std::string field(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
}

std::string csv_of(const std::vector<part>& parts) {
    std::string text = "part,rule,number,quantity,measure,ratios,exact,unknown";
    for (const named_quantile& q : quantiles) text += std::string(",") + q.name;
    text += '\n';
    for (const part& p : parts)
        for (const tightness& t : p.found.distributions) {
            text += field(p.name) + ',' + t.rule + ',' + t.number + ',' + t.quantity + ',' +
                    t.measure + ',' + std::to_string(t.log10.ratios()) + ',' +
                    std::to_string(t.log10.exact()) + ',' + std::to_string(t.log10.unknown());
            for (const named_quantile& q : quantiles) {
                char number[40] = ",";
                if (t.log10.ratios() > 0)
                    std::snprintf(number, sizeof number, ",%.6g", t.log10.quantile(q.share));
                text += number;
            }
            text += '\n';
        }
    return text;
}

}  // namespace

bool run_validate(const validate_arguments& arguments) {
    std::vector<part> parts;
    const auto run = [&parts](const std::string& name, const auto& validate) {
        progress_line progress;
        parts.push_back({name, validate([&](std::uint64_t done, std::uint64_t all) {
                             progress.show(done, all, "parts: " + name);
                         })});
    };
    const int threads = arguments.options.threads;
    std::vector<ccd::io::query_file> files;  // all read first: a bad one stops the run at once
    for (const auto& path : arguments.queries)
        files.push_back(ccd::io::read_queries(path, arguments.kind, arguments.round));

    if (arguments.tiny)
        run("tiny",
            [&](const progress& show) { return validate_tiny(arguments.rules, threads, show); });
    for (std::size_t i = 0; i < files.size(); ++i)
        run(arguments.queries[i].string(), [&](const progress& show) {
            return std::visit(
                [&](const auto& queries) {
                    return validate_queries(arguments.rules, std::span(queries), threads, show);
                },
                files[i].queries);
        });
    if (arguments.expressions)
        run("expressions", [&](const progress& show) {
            return validate_expressions(arguments.rules, arguments.options, show);
        });

    std::vector<errbound::support::output> outputs;
    if (arguments.json) outputs.push_back({*arguments.json, json_of(parts)});
    if (arguments.csv) outputs.push_back({*arguments.csv, csv_of(parts)});
    write_whole(outputs);
    std::ostream& people = errbound::support::stream_for_people({arguments.json, arguments.csv});
    people << text_of_counts(parts);
    if (const std::string text = text_of_tightness(parts); !text.empty())
        people << "\nlog10 of the measure:\n" << text;
    people << text_of_violations(parts);
    std::uint64_t violations = 0;
    for (const part& p : parts) violations += p.found.violation_count();
    people << '\n' << (violations == 0 ? "no" : std::to_string(violations)) << " violations\n";
    return violations == 0;
}

}  // namespace errbound::validation
