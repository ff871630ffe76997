// The text of report.md.
#include <algorithm>
#include <cmath>

#include "ccd/lab/report.hpp"
#include "ccd/lab/sections.hpp"
#include "ccd/lab/stress.hpp"

namespace ccd::lab {
namespace {

using errbound::support::cells_of;
using errbound::support::digits;
using errbound::support::grouped;
using errbound::support::markdown_of;
using strings = std::vector<std::string>;

std::string word(const row& r, const char* column) {
    return r[column].get<std::string>();
}

const rows& table_of(const report_summary& report, const std::string& section) {
    static const rows none;
    const auto found = report.tables.find(section);
    return found == report.tables.end() ? none : found->second;
}

/// Headings are the columns' names with blanks. The first `left` columns are words.
std::string table_text(const rows& of, const strings& columns, std::size_t left) {
    strings heading = columns;
    for (std::string& name : heading) std::ranges::replace(name, '_', ' ');
    return markdown_of(cells_of(of, heading, columns), left);
}

std::string head(const report_summary& report) {
    const row& here = report.machine;
    return "# Collision detection: error against run time\n\n* Machine: " +
           word(here, "processor") + ", " + here["cores"].dump() + " cores, " +
           digits(here["memory_gib"]) + " GiB memory; load " + digits(here["load"]) +
           " at the start, " + digits(report.load_at_end) +
           " at the end; instruction sets: " + word(here, "instruction_sets") +
           "\n* Program: commit " + report.settings.commit + ", " + word(here, "compiler") +
           ", flags: " + word(here, "flags") + "\n* " + report.date +
           (report.settings.quick ? ", quick" : "") + "; " + std::to_string(report.parts) +
           " parts, " + std::to_string(report.resumed) +
           " of them measured in an earlier run of the same program, settings and data\n\n";
}

std::string failures(const report_summary& report) {
    std::string text = "## Failures\n\n";
    for (const std::string& failure : report.failures) text += "* " + failure + "\n";
    if (report.failures.empty()) text += "None: every method kept its promise on all data.\n";
    return text + "\n";
}

std::string methods_on(const report_summary& report, const std::string& heading,
                       const std::function<bool(const row&)>& counts) {
    rows all = totals(table_of(report, "methods"), counts);
    if (all.empty()) return "";
    for (row& r : all) {
        const auto per_million = [&r](const char* count, std::size_t of) {
            return of == 0 ? 0 : 1e6 * r[count].get<double>() / static_cast<double>(of);
        };
        const std::size_t colliding = r["colliding"], queries = r["queries"];
        r["FP_per_million_separate"] = per_million("false_positives", queries - colliding);
        r["FN_per_million_colliding"] = per_million("false_negatives", colliding);
        r["ns_per_query"] = r["ns"];
    }
    return heading + "\n\n" + grouped(all[0]["queries"]) + " queries, of which " +
           grouped(all[0]["colliding"]) + " collide.\n\n" +
           table_text(all,
                      {"method", "false_positives", "false_negatives", "uncertain",
                       "FP_per_million_separate", "FN_per_million_colliding", "ns_per_query"},
                      1);
}

std::string all_data(const report_summary& report) {
    if (table_of(report, "methods").empty()) return "";
    const auto from_scenes = [](const row& r) { return r["origin"] == "scene"; };
    return methods_on(report, "## All data", [](const row&) { return true; }) +
           "Errors are counted on all queries; uncertain answers count as collisions. ns per "
           "query: one thread; the least of several passes over the queries, methods alternately, "
           "drawn evenly where there are very many; the mean over all queries. `" +
           std::string(batch_name) + "` is `exact` over SIMD packs (ccd/batch.hpp).\n\n" +
           methods_on(report, "### Scenes only: all candidate pairs of their steps", from_scenes) +
           methods_on(report, "### Stored and generated queries only, which are hard",
                      [&](const row& r) { return !from_scenes(r); });
}

std::string data(const report_summary& report) {
    std::string text =
        "## Data\n\n" +
        table_text(report.data, {"data_set", "kind", "origin", "truth", "queries", "colliding"}, 4);
    for (const omission& o : report.skipped)
        text += "* skipped: `" + o.path.string() + "`: " + o.why + "\n";
    return text + (report.skipped.empty() ? "" : "\n");
}

std::string per_data_set(const report_summary& report) {
    const rows &methods = table_of(report, "methods"), &times = table_of(report, "times");
    std::string text;
    if (!methods.empty())
        text +=
            "## Methods on each data set\n\n" +
            table_text(methods,
                       {"data_set", "kind", "method", "queries", "collisions", "false_positives",
                        "false_negatives", "uncertain", "ns_min", "ns_median"},
                       3);
    if (!times.empty())
        text +=
            "## Times of single queries\n\nIn ns: the median, the quantiles of 90, 99 and 99.9 "
            "percent, and the worst.\n\n" +
            table_text(times,
                       {"data_set", "kind", "method", "timed", "ns_median", "ns_90", "ns_99",
                        "ns_99_9", "ns_worst"},
                       3);
    return text;
}

/// A quantile of log10 as a number, with <= or >= if it is clamped.
std::string tightness_of(const row& r, const std::string& quantile) {
    if (r[quantile].is_null()) return "-";
    const double log10 = r[quantile];
    const std::string clamped = ' ' + r.value("clamped", std::string()) + ' ';
    const bool is_clamped = clamped.find(' ' + quantile + ' ') != std::string::npos;
    return (is_clamped ? log10 < 0 ? "<=" : ">=" : "") + digits(std::pow(10, log10));
}

/// The ratio of bound to true error, its median and 99 % quantile, in double: a line per quantity,
/// a column per rule.
std::string tightness(const report_summary& report) {
    rows lines;
    strings columns{"part", "quantity"};
    for (const row& r : table_of(report, "tightness")) {
        if (r["number"] != "double" || r["measure"] == "error/value") continue;
        const std::string rule = word(r, "rule");
        if (std::ranges::find(columns, rule) == columns.end()) columns.push_back(rule);
        auto line = std::ranges::find_if(lines, [&](const row& other) {
            return other["part"] == r["part"] && other["quantity"] == r["quantity"];
        });
        if (line == lines.end()) {
            lines.push_back({{"part", r["part"]}, {"quantity", r["quantity"]}});
            line = lines.end() - 1;
        }
        (*line)[rule] = tightness_of(r, "median") + " (" + tightness_of(r, "q99") + ")";
    }
    if (lines.empty()) return "";
    return "## Tightness\n\nBound over true error, by MPFR: median (and 99 %), in double; for "
           "rules "
           "that estimate errors, the estimate. The columns claimed and observed of tightness.csv "
           "have the promised and the measured share of estimates that are no less. In further "
           "cases the true error is zero or the bound infinite; tightness.csv counts them.\n\n" +
           table_text(lines, columns, 2);
}

std::string first_contacts(const report_summary& report) {
    rows all = table_of(report, "contacts");
    if (all.empty()) return "";
    for (row& r : all) {
        r["ratio"] = r["ns_time"].get<double>() / r["ns_decision"].get<double>();
        r["batch_ratio"] = r["ns_batch_time"].get<double>() / r["ns_batch_decision"].get<double>();
    }
    return "## First contacts\n\nBy `exact`, in [0, 1]: the time of a contact is a double, or in a "
           "bracket of two neighbouring ones, whose width is in t. Data sets, then families of "
           "stress, over all values of their knobs.\n\n" +
           table_text(all,
                      {"data_set", "kind", "queries", "contacts", "at_start", "one_double",
                       "neighbours", "width_median", "width_largest"},
                      2) +
           "Cost: ns per query, one thread, the least of several passes alternately; yes or no, "
           "and with the first time. On the right only queries with a contact, one by one.\n\n" +
           table_text(all,
                      {"data_set", "kind", "timed", "ns_batch_decision", "ns_batch_time",
                       "batch_ratio", "ns_decision", "ns_time", "ratio", "timed_contacts",
                       "ns_contact_decision", "ns_contact_time"},
                      2);
}

std::string notes(const report_summary& report) {
    const rows& times = table_of(report, "times");
    return "## How it was measured\n\n"
           "* Single queries: the cost of two readings of the clock (" +
           (times.empty() ? "0" : digits(times.front()["clock_ns"])) +
           " ns) is subtracted; each query counts with the least of " +
           std::to_string(sizes(report.settings.quick).repeats) +
           " timings, taken at different times, so that interrupts are not taken for slow queries. "
           "Caches are warm, and a few ns are within the clock's own noise.\n"
           "* Bounds: as decide_bsc has them (ccd/methods/bsc.hpp), of queries drawn evenly where "
           "there are very many; queries whose coordinates are not of moderate size are first "
           "scaled by a power of two. Quantiles are by the nearest rank.\n"
           "* The CSV files hold the figures; `python3 plot.py` draws the pictures again.\n";
}

}  // namespace

std::string text_of(const report_summary& report) {
    std::string text = head(report) + failures(report) + all_data(report);
    for (const picture& p : report.pictures)
        text += "![" + p.caption + "](" + p.file + ")\n\n" + p.caption + "\n\n";
    return text + first_contacts(report) + tightness(report) + data(report) + per_data_set(report) +
           notes(report);
}

}  // namespace ccd::lab
