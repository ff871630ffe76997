#include "errbound/program/examined_parts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "errbound/support/output_file.hpp"
#include "errbound/support/progress_line.hpp"
#include "errbound/support/rows.hpp"

namespace errbound::validation {
namespace {

using support::csv_of, support::row, support::rows, support::text_of;

struct found_part {
    std::string name;
    report found;
};

struct named_quantile {
    const char* name;
    double share;
};
constexpr named_quantile quantiles[] = {{"min", 0},      {"q01", 0.01}, {"q25", 0.25},
                                        {"median", 0.5}, {"q75", 0.75}, {"q99", 0.99},
                                        {"max", 1}};

const std::vector<std::string> tightness_columns{
    "part",     "rule", "number", "quantity", "measure", "ratios", "exact", "unknown", "claimed",
    "observed", "min",  "q01",    "q25",      "median",  "q75",    "q99",   "max",     "clamped"};
const std::vector<std::string> function_columns{"function", "number",  "arguments", "largest",
                                                "at",       "assumed", "violations"};

row row_of(const rule_counts& c) {
    return {{"rule", c.rule},     {"number", c.number},         {"cases", c.cases},
            {"values", c.values}, {"violations", c.violations}, {"undetermined", c.undetermined}};
}

row row_of(const violation& v) {
    return {{"rule", v.rule}, {"number", v.number}, {"what", v.what}, {"code", v.code}};
}

row row_of(const function_errors& f) {
    return {{"function", f.function},    {"number", f.number}, {"arguments", f.arguments},
            {"largest", f.largest},      {"at", f.at},         {"assumed", f.assumed},
            {"violations", f.violations}};
}

/// A row for each entry of the parts' reports. If `named`, the first column is the part.
template <class Entry>
rows rows_of(const std::vector<found_part>& parts, std::vector<Entry> report::*entries,
             bool named = true) {
    rows all;
    for (const found_part& p : parts)
        for (const Entry& entry : p.found.*entries) {
            all.push_back(named ? row{{"part", p.name}} : row::object());
            all.back().update(row_of(entry));
        }
    return all;
}

std::string text_of_quantile(const distribution& log10, double share) {
    if (log10.ratios() == 0) return "-";
    const double value = log10.quantile(share);
    return (!log10.is_clamped(share) ? ""
            : value < 0              ? "<="
                                     : ">=") +
           support::fixed(value, "%.2f");
}

std::string text_of_tightness(const std::vector<found_part>& parts) {
    rows all;
    for (const found_part& p : parts)
        for (const tightness& t : p.found.distributions) {
            row& r = all.emplace_back(row{{"part", p.name}});
            r.update(row_of(t));
            r.erase("clamped");
            for (const char* rate : {"claimed", "observed"})
                if (!r[rate].is_null())
                    r[rate] = support::fixed(100 * r[rate].get<double>(), "%.1f");
            for (const auto& [name, share] : quantiles) r[name] = text_of_quantile(t.log10, share);
        }
    return text_of(all);
}

/// A row per rule over all parts, number types and quantities: counts and quantiles of log10 of the
/// measure.
std::string text_of_rules(const std::vector<found_part>& parts) {
    std::vector<std::pair<std::string, distribution>> rules;
    rows all;
    const auto place_of = [&](const std::string& rule) {
        const auto found = std::ranges::find(rules, rule, &decltype(rules)::value_type::first);
        const auto place = static_cast<std::size_t>(found - rules.begin());
        if (found == rules.end()) {
            rules.emplace_back(rule, distribution());
            all.push_back({{"rule", rule}});
        }
        return place;
    };
    for (const found_part& p : parts) {
        for (const rule_counts& c : p.found.counts) {
            row& sum = all[place_of(c.rule)];
            const row counts = row_of(c);
            for (const char* count : {"cases", "values", "violations", "undetermined"})
                sum[count] =
                    sum.value(count, std::uint64_t{0}) + counts[count].get<std::uint64_t>();
        }
        for (const tightness& t : p.found.distributions)
            if (t.measure != "error/value") rules[place_of(t.rule)].second.merge(t.log10);
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
        all[i]["median"] = text_of_quantile(rules[i].second, 0.5);
        all[i]["99 %"] = text_of_quantile(rules[i].second, 0.99);
    }
    return text_of(all);
}

/// Errors are rounded up, so that they stay bounds.
std::string text_of_functions(const std::vector<found_part>& parts) {
    rows all = rows_of(parts, &report::functions, false);
    for (row& r : all)
        for (const char* units : {"largest", "assumed"})
            r[units] = support::fixed(std::ceil(r[units].get<double>() * 1000) / 1000, "%.3f");
    return text_of(all);
}

std::string text_of_violations(const std::vector<found_part>& parts) {
    std::string text;
    for (const found_part& p : parts)
        for (const violation& v : p.found.violations)
            text += "\nviolation: " + p.name + ", " + v.rule + ", " + v.number + "\n" + v.what +
                    "\n" + v.code;
    return text;
}

void write_files(const std::vector<found_part>& parts, const result_files& to) {
    const rows tightness = rows_of(parts, &report::distributions);
    const rows functions = rows_of(parts, &report::functions, false);
    std::vector<support::output> outputs;
    if (to.json) {
        const row all = {{"counts", rows_of(parts, &report::counts)},
                         {"violations", rows_of(parts, &report::violations)},
                         {"tightness", tightness},
                         {"functions", functions}};
        outputs.push_back({*to.json, support::json_of(all, 2) + '\n'});
    }
    if (to.csv) outputs.push_back({*to.csv, csv_of(tightness_columns, tightness)});
    if (to.functions_csv)
        outputs.push_back({*to.functions_csv, csv_of(function_columns, functions)});
    support::write_whole(outputs);
}

}  // namespace

row row_of(const tightness& t) {
    const bool has_rates = t.claimed > 0 && t.log10.ratios() + t.log10.exact() > 0;
    row r = {{"rule", t.rule},
             {"number", t.number},
             {"quantity", t.quantity},
             {"measure", t.measure},
             {"ratios", t.log10.ratios()},
             {"exact", t.log10.exact()},
             {"unknown", t.log10.unknown()},
             {"claimed", has_rates ? row(t.claimed) : row()},
             {"observed", has_rates ? row(t.observed()) : row()}};
    std::string clamped;
    for (const auto& [name, share] : quantiles) {
        r[name] = t.log10.ratios() > 0 ? row(t.log10.quantile(share)) : row();
        if (t.log10.is_clamped(share)) clamped += (clamped.empty() ? "" : " ") + std::string(name);
    }
    r["clamped"] = clamped;
    return r;
}

void result_files::add_options(CLI::App& line) {
    support::add_output(line, "--json", json, "Write all tables as JSON");
    support::add_output(line, "--csv", csv, "Write the table of tightness as CSV");
}

support::exit_status examine_parts(const std::vector<part>& parts, int threads,
                                   const result_files& to) {
    std::vector<found_part> found;
    for (const part& p : parts) {
        support::progress_line progress;
        const auto show = [&](std::uint64_t done, std::uint64_t all) {
            progress.show(done, all, "parts: " + p.name);
        };
        found.push_back({p.name, examine(p.what, threads, show)});
    }
    write_files(found, to);
    std::ostream& people = support::stream_for_people(to.all());
    const auto print = [&people](const char* title, const std::string& text) {
        if (!text.empty()) people << title << text;
    };
    print("", text_of(rows_of(found, &report::counts)));
    print("\nerrors of functions, in units in the last place:\n", text_of_functions(found));
    print("\nlog10 of the measure:\n", text_of_tightness(found));
    people << text_of_violations(found);
    print("\nrules, with log10 of bound/error over all quantities:\n", text_of_rules(found));
    std::uint64_t violations = 0;
    for (const found_part& p : found) violations += p.found.violation_count();
    people << '\n' << (violations == 0 ? "no" : std::to_string(violations)) << " violations\n";
    return violations == 0 ? support::done : support::broken_promise;
}

}  // namespace errbound::validation
