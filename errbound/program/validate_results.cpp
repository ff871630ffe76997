// Results of `errbound validate` as tables, JSON and CSV.
#include "errbound/program/validate_results.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "errbound/support/command_line.hpp"
#include "errbound/support/output_file.hpp"
#include "errbound/support/table.hpp"

namespace errbound::validation {
namespace {

using nlohmann::ordered_json;
using support::table;
using support::text_of;

struct named_quantile {
    const char* name;
    double share;
};
constexpr named_quantile quantiles[] = {{"min", 0},      {"q01", 0.01}, {"q25", 0.25},
                                        {"median", 0.5}, {"q75", 0.75}, {"q99", 0.99},
                                        {"max", 1}};

std::string text_of_counts(const std::vector<found_part>& parts) {
    table rows{{"part", "rule", "number", "cases", "values", "violations", "undetermined"}};
    for (const found_part& p : parts)
        for (const rule_counts& c : p.found.counts)
            rows.push_back({p.name, c.rule, c.number, std::to_string(c.cases),
                            std::to_string(c.values), std::to_string(c.violations),
                            std::to_string(c.undetermined)});
    return rows.size() > 1 ? text_of(rows, 3) : std::string();
}

/// Marked if clamped.
std::string text_of_quantile(const distribution& log10, double share) {
    if (log10.ratios() == 0) return "-";
    const double value = log10.quantile(share);
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", value);
    if (!log10.is_clamped(share)) return text;
    return (value < 0 ? "<=" : ">=") + std::string(text);
}
std::string text_of_rate(double rate) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f", 100 * rate);
    return text;
}
/// True for estimates with a claimed rate.
bool has_rates(const tightness& t) {
    return t.claimed > 0 && t.log10.ratios() + t.log10.exact() > 0;
}

std::string text_of_tightness(const std::vector<found_part>& parts) {
    table rows{{"part", "rule", "number", "quantity", "measure", "ratios", "exact", "unknown",
                "claimed", "observed"}};
    for (const named_quantile& q : quantiles) rows.front().push_back(q.name);
    for (const found_part& p : parts)
        for (const tightness& t : p.found.distributions) {
            rows.push_back({p.name, t.rule, t.number, t.quantity, t.measure,
                            std::to_string(t.log10.ratios()), std::to_string(t.log10.exact()),
                            std::to_string(t.log10.unknown()),
                            has_rates(t) ? text_of_rate(t.claimed) : "-",
                            has_rates(t) ? text_of_rate(t.observed()) : "-"});
            for (const named_quantile& q : quantiles)
                rows.back().push_back(text_of_quantile(t.log10, q.share));
        }
    return rows.size() > 1 ? text_of(rows, 5) : std::string();
}

/// A line per rule over all parts and number types: counts, and quantiles of log10 of the measure
/// (bound/error, estimate/error) over all quantities.
std::string text_of_rules(const std::vector<found_part>& parts) {
    struct summary {
        rule_counts counts;
        distribution log10;
    };
    std::vector<summary> rules;
    const auto of_rule = [&rules](const std::string& rule) -> summary& {
        const auto same = [&rule](const summary& s) { return s.counts.rule == rule; };
        const auto found = std::ranges::find_if(rules, same);
        if (found != rules.end()) return *found;
        rules.emplace_back().counts.rule = rule;
        return rules.back();
    };
    for (const found_part& p : parts) {
        for (const rule_counts& c : p.found.counts) {
            rule_counts& sum = of_rule(c.rule).counts;
            sum.cases += c.cases, sum.values += c.values;
            sum.violations += c.violations, sum.undetermined += c.undetermined;
        }
        for (const tightness& t : p.found.distributions)
            if (t.measure != "error/value") of_rule(t.rule).log10.merge(t.log10);
    }
    table rows{{"rule", "cases", "values", "violations", "undetermined", "median", "99 %"}};
    for (const auto& [c, log10] : rules)
        rows.push_back({c.rule, std::to_string(c.cases), std::to_string(c.values),
                        std::to_string(c.violations), std::to_string(c.undetermined),
                        text_of_quantile(log10, 0.5), text_of_quantile(log10, 0.99)});
    return rules.empty() ? std::string() : text_of(rows, 1);
}

/// Three decimals, rounded up: a reliable bound.
std::string text_of_units(double units) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3f", std::ceil(units * 1000) / 1000);
    return text;
}

std::string text_of_functions(const std::vector<found_part>& parts) {
    table rows{{"function", "number", "at", "arguments", "largest", "assumed", "violations"}};
    for (const found_part& p : parts)
        for (const function_errors& f : p.found.functions)
            rows.push_back({f.function, f.number, f.at, std::to_string(f.arguments),
                            text_of_units(f.largest), text_of_units(f.assumed),
                            std::to_string(f.violations)});
    return rows.size() > 1 ? text_of(rows, 3) : std::string();
}

std::string text_of_violations(const std::vector<found_part>& parts) {
    std::string text;
    for (const found_part& p : parts)
        for (const violation& v : p.found.violations)
            text += "\nviolation: " + p.name + ", " + v.rule + ", " + v.number + "\n" + v.what +
                    "\n" + v.code;
    return text;
}

/// Names of the clamped quantiles.
std::string clamped(const distribution& log10) {
    std::string names;
    for (const named_quantile& q : quantiles)
        if (log10.is_clamped(q.share)) names += (names.empty() ? "" : " ") + std::string(q.name);
    return names;
}

ordered_json number_or_null(double x) {
    return std::isfinite(x) ? ordered_json(x) : ordered_json(nullptr);
}

std::string json_of(const std::vector<found_part>& parts) {
    ordered_json all{{"counts", ordered_json::array()},
                     {"violations", ordered_json::array()},
                     {"tightness", ordered_json::array()},
                     {"functions", ordered_json::array()}};
    for (const found_part& p : parts) {
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
                               {"exact", t.log10.exact()}, {"unknown", t.log10.unknown()},
                               {"claimed", nullptr},       {"observed", nullptr}};
            if (has_rates(t)) {
                entry["claimed"] = t.claimed;
                entry["observed"] = t.observed();
            }
            for (const named_quantile& q : quantiles)
                entry[q.name] = number_or_null(t.log10.quantile(q.share));
            entry["clamped"] = clamped(t.log10);
            all["tightness"].push_back(std::move(entry));
        }
        for (const function_errors& f : p.found.functions)
            all["functions"].push_back({{"function", f.function},
                                        {"number", f.number},
                                        {"arguments", f.arguments},
                                        {"largest", f.largest},
                                        {"at", f.at},
                                        {"assumed", f.assumed},
                                        {"violations", f.violations}});
    }
    // Paths need not be UTF-8; the default handler would throw.
    return all.dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

/// Quoted if CSV requires.
std::string field(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
}

std::string number_text(double x) {
    char text[40];
    std::snprintf(text, sizeof text, "%.6g", x);
    return text;
}

std::string csv_of(const std::vector<found_part>& parts) {
    std::string text = "part,rule,number,quantity,measure,ratios,exact,unknown,claimed,observed";
    for (const named_quantile& q : quantiles) text += std::string(",") + q.name;
    text += ",clamped\n";
    for (const found_part& p : parts)
        for (const tightness& t : p.found.distributions) {
            text += field(p.name) + ',' + t.rule + ',' + t.number + ',' + t.quantity + ',' +
                    t.measure + ',' + std::to_string(t.log10.ratios()) + ',' +
                    std::to_string(t.log10.exact()) + ',' + std::to_string(t.log10.unknown()) +
                    ',' + (has_rates(t) ? number_text(t.claimed) : "") + ',' +
                    (has_rates(t) ? number_text(t.observed()) : "");
            for (const named_quantile& q : quantiles)
                text += ',' + (t.log10.ratios() > 0 ? number_text(t.log10.quantile(q.share)) : "");
            text += ',' + clamped(t.log10) + '\n';
        }
    return text;
}

std::string csv_of_functions(const std::vector<found_part>& parts) {
    std::string text = "function,number,arguments,largest,at,assumed,violations\n";
    for (const found_part& p : parts)
        for (const function_errors& f : p.found.functions) {
            char numbers[80];
            std::snprintf(numbers, sizeof numbers, ",%.9g,", f.largest);
            text += f.function + ',' + f.number + ',' + std::to_string(f.arguments) + numbers +
                    field(f.at);
            std::snprintf(numbers, sizeof numbers, ",%.9g,", f.assumed);
            text += numbers + std::to_string(f.violations) + '\n';
        }
    return text;
}

}  // namespace

exit_status write_results(const std::vector<found_part>& parts, const validate_arguments& to) {
    std::vector<support::output> outputs;
    if (to.json) outputs.push_back({*to.json, json_of(parts)});
    if (to.csv) outputs.push_back({*to.csv, csv_of(parts)});
    if (to.functions_csv) outputs.push_back({*to.functions_csv, csv_of_functions(parts)});
    support::write_whole(outputs);
    std::ostream& people = support::stream_for_people({to.json, to.csv, to.functions_csv});
    if (const std::string text = text_of_counts(parts); !text.empty()) people << text;
    if (const std::string text = text_of_functions(parts); !text.empty())
        people << "\nerrors of functions, in units in the last place:\n" << text;
    if (const std::string text = text_of_tightness(parts); !text.empty())
        people << "\nlog10 of the measure:\n" << text;
    people << text_of_violations(parts);
    if (const std::string text = text_of_rules(parts); !text.empty())
        people << "\nrules, with log10 of bound/error over all quantities:\n" << text;
    std::uint64_t violations = 0;
    for (const found_part& p : parts) violations += p.found.violation_count();
    people << '\n' << (violations == 0 ? "no" : std::to_string(violations)) << " violations\n";
    return violations == 0 ? done : violations_found;
}

}  // namespace errbound::validation
