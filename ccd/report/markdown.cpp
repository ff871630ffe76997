// report.md: the report as a person reads it.
#include <cstdio>
#include <set>

#include "ccd/report/measuring/statistics.hpp"
#include "ccd/report/report.hpp"
#include "ccd/report/sections.hpp"
#include "errbound/support/table.hpp"

namespace ccd::report {
namespace {

using errbound::support::grouped;

/// Three digits that count: 1,234,567 (or more of them), 12.3, 0.012, 1.23e-20. Not negative.
std::string digits(double x) {
    char text[48];
    const double size = std::abs(x);
    if (x == 0) return "0";
    if (size >= 1000 && size < 1e9) return grouped(static_cast<std::size_t>(std::round(x)));
    if (size < 1e-3 || size >= 1e9) {
        std::snprintf(text, sizeof text, "%.2e", x);
    } else {
        const int after = size >= 100 ? 0 : size >= 10 ? 1 : size >= 1 ? 2 : 3;
        std::snprintf(text, sizeof text, "%.*f", after, x);
    }
    return text;
}

std::string text_of(const row& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number_integer()) return grouped(value.get<std::size_t>());
    return value.is_number() ? digits(value.get<double>()) : "-";
}

/// A table; the first `left` columns are words.
std::string table(const std::vector<std::string>& heading, std::size_t left,
                  const std::vector<std::vector<std::string>>& lines) {
    const auto line = [](const std::vector<std::string>& cells) {
        std::string text = "|";
        for (const std::string& cell : cells) text += " " + cell + " |";
        return text + "\n";
    };
    std::vector<std::string> rule(heading.size(), "---:");
    std::fill_n(rule.begin(), left, "---");
    std::string text = line(heading) + line(rule);
    for (const auto& cells : lines) text += line(cells);
    return text + "\n";
}

/// A table of these columns of the rows.
std::string table(const std::vector<std::string>& heading, std::size_t left,
                  const std::vector<std::string>& columns, const rows& of) {
    std::vector<std::vector<std::string>> lines;
    for (const row& r : of) {
        lines.emplace_back();
        for (const std::string& column : columns) {
            lines.back().push_back(r.contains(column) ? text_of(r[column]) : "-");
        }
    }
    return table(heading, left, lines);
}

/// The rows of one data set.
rows of_data_set(const rows& all, const std::string& name) {
    rows some;
    for (const row& r : all) {
        if (r["data_set"] == name) some.push_back(r);
    }
    return some;
}

std::string head(const summary& report) {
    const machine& here = report.here;
    std::string text = "# Collision detection: error against run time\n\n";
    text += "* Machine: " + here.processor + ", " + std::to_string(here.cores) + " cores, " +
            digits(here.memory_gib) + " GiB memory; load " + digits(here.load) + " at the start, " +
            digits(report.load_at_end) + " at the end; instruction sets: " + here.instruction_sets +
            "\n";
    text += "* Program: commit " + report.settings.commit + ", " + here.compiler +
            ", flags: " + here.flags + "\n";
    text += "* " + report.date + (report.settings.quick ? ", quick" : "") + "; " +
            std::to_string(report.parts) + " parts, " + std::to_string(report.resumed) +
            " of them measured in an earlier run of the same program, settings and data\n\n";
    return text;
}

std::string failures(const summary& report) {
    std::string text = "## Failures\n\n";
    for (const std::string& failure : report.failures) text += "* " + failure + "\n";
    if (report.failures.empty()) text += "None: every method kept its promise on all data.\n";
    return text + "\n";
}

std::string data(const summary& report) {
    std::vector<std::vector<std::string>> lines;
    for (const data_summary& set : report.data) {
        for (const data_summary::counts& k : set.kinds) {
            if (k.queries == 0) continue;
            std::string truth = "exact, in batches";
            if (k.stored_truths > 0 && set.origin != origin::scene)
                truth = grouped(k.stored_truths) + " stored" +
                        (k.stored_truths < k.queries ? ", else exact" : "");
            if (k.stored_truths > 0 && set.origin == origin::scene)
                truth +=
                    "; of " + grouped(k.stored_truths) + " stored ones " +
                    (k.contradictions == 0 ? "all agree" : grouped(k.contradictions) + " differ");
            lines.push_back({set.name, std::string(short_name(k.kind)),
                             std::string(name(set.origin)), grouped(k.queries),
                             grouped(k.colliding), truth});
        }
    }
    std::string text =
        "## Data\n\n" +
        table({"data set", "kind", "queries", "number", "colliding", "truth"}, 3, lines);
    for (const omission& without : report.left_out) {
        text += "* left out: `" + without.path.string() + "`: " + without.why + "\n";
    }
    return text + (report.left_out.empty() ? "" : "\n");
}

/// What share of one method's false positives another one has.
std::string ratio(const std::vector<method_total>& all, const std::string& of,
                  const std::string& to) {
    const auto a = std::ranges::find(all, of, &method_total::method);
    const auto b = std::ranges::find(all, to, &method_total::method);
    if (a == all.end() || b == all.end() || b->false_positives == 0) return "";
    return "* `" + of + "` has " +
           digits(100 * static_cast<double>(a->false_positives) /
                  static_cast<double>(b->false_positives)) +
           " % of the false positives of `" + to + "`\n";
}

/// A row for each method.
std::string table(const std::vector<method_total>& all) {
    std::vector<std::vector<std::string>> lines;
    for (const method_total& m : all) {
        const std::size_t separate = m.queries - m.colliding;
        lines.push_back({m.method, grouped(m.false_positives), grouped(m.false_negatives),
                         grouped(m.uncertain), digits(per_million(m.false_positives, separate)),
                         digits(per_million(m.false_negatives, m.colliding)), digits(m.ns)});
    }
    return table({"method", "false positives", "false negatives", "uncertain",
                  "FP per million separate", "FN per million colliding", "ns per query"},
                 1, lines);
}

/// All queries that `counts` picks, under a heading.
std::string all_of(const summary& report, const std::string& heading,
                   const std::function<bool(const row&)>& counts) {
    const auto all = totals(report.methods, counts);
    if (all.empty()) return "";
    const std::string ratios = ratio(all, "tight", "safe") + ratio(all, "safeccd-tight", "safeccd");
    return heading + "\n\n" + grouped(all[0].queries) + " queries, of which " +
           grouped(all[0].colliding) + " collide.\n\n" + table(all) + ratios +
           (ratios.empty() ? "" : "\n");
}

std::string all_data(const summary& report) {
    if (report.methods.empty()) return "";
    const auto from_scenes = [](const row& r) { return r["origin"] == name(origin::scene); };
    return all_of(report, "## All data", [](const row&) { return true; }) +
           "Errors are counted on all queries; uncertain answers count as collisions. ns per "
           "query: "
           "one thread; the least of several passes over the queries, methods in turn, drawn "
           "evenly "
           "where there are very many; the mean over all queries. `" +
           std::string(batch_name) + "` is `exact` over SIMD packs (ccd/batch.hpp).\n\n" +
           all_of(report, "### Scenes alone: all candidate pairs of their steps", from_scenes) +
           all_of(report, "### Stored and made queries alone, which are picked to be hard",
                  [&](const row& r) { return !from_scenes(r); });
}

/// The paper's Figure 11: its benchmarks are our data sets, its columns our methods.
std::string figure_11(const summary& report) {
    if (report.methods.empty()) return "";
    struct column {
        std::string_view method, title;
    };
    constexpr column in_order[] = {{"bsc-exact", "BSC-exact"},
                                   {"tight", "TightCCD"},
                                   {"safe", "BSC with SafeBound"},
                                   {"safeccd-tight", "SafeCCD with TightBound"},
                                   {"safeccd", "SafeCCD"},
                                   {"float", "BSC-float"},
                                   {"exact", "exact"},
                                   {batch_name, "exact, batch"}};
    std::vector<std::string> heading{"data set", "queries"};
    std::vector<column> columns;
    for (const column& c : in_order) {
        if (std::ranges::find(report.settings.methods, c.method) == report.settings.methods.end())
            continue;
        columns.push_back(c);
        heading.push_back(std::string(c.title));
    }
    std::vector<std::vector<std::string>> lines;
    for (const data_summary& set : report.data) {
        const auto all =
            totals(report.methods, [&](const row& r) { return r["data_set"] == set.name; });
        lines.push_back({set.name, grouped(set.queries())});
        for (const column& c : columns) {
            const method_total& m = *std::ranges::find(all, c.method, &method_total::method);
            lines.back().push_back(digits(1e-3 * m.ns) + " / " + grouped(m.false_positives) +
                                   " / " + grouped(m.false_negatives));
        }
    }
    return "## The paper's Figure 11 on this data\n\nPer method: µs per query on one thread / "
           "false positives / false negatives.\n\n" +
           table(heading, 1, lines);
}

std::string per_data_set(const summary& report) {
    std::string text = "## Data set by data set\n\n";
    for (const data_summary& set : report.data) {
        text += "### " + set.name + "\n\n";
        text += table({"kind", "method", "queries", "collisions", "false positives",
                       "false negatives", "uncertain", "ns, least", "ns, median"},
                      2,
                      {"kind", "method", "queries", "collisions", "false_positives",
                       "false_negatives", "uncertain", "ns_min", "ns_median"},
                      of_data_set(report.methods, set.name));
        text += "Times of single queries, ns:\n\n";
        text +=
            table({"kind", "method", "timed", "median", "90 %", "99 %", "99.9 %", "worst"}, 2,
                  {"kind", "method", "timed", "ns_median", "ns_90", "ns_99", "ns_99_9", "ns_worst"},
                  of_data_set(report.times, set.name));
        text += "Bounds of the critical variables, and relative to the largest k in size:\n\n";
        text +=
            table({"kind", "rule", "variable", "median", "99 %", "median / max k", "99 % / max k"},
                  3, {"kind", "rule", "variable", "q50", "q99", "relative_q50", "relative_q99"},
                  of_data_set(report.bounds, set.name));
    }
    return text;
}

/// Bound over true error, the median and 99 %, in double: a line for each quantity, a column for
/// each rule.
std::string tightness(const summary& report) {
    std::vector<std::string> heading{"part", "quantity"};
    std::vector<std::vector<std::string>> lines;
    const auto text_of_log = [](const row& r, const char* q) {
        if (!r.contains(q)) return std::string("-");
        const double log10 = r[q];
        const bool is_clamped =
            r.contains("clamped") &&
            (' ' + r["clamped"].get<std::string>() + ' ').find(' ' + std::string(q) + ' ') !=
                std::string::npos;
        return (is_clamped ? log10 < 0 ? "<=" : ">=" : "") + digits(std::pow(10, log10));
    };
    for (const row& r : report.tightness) {
        if (r["number"] != "double" || r["measure"] == "error/value") continue;
        const std::string part = r["part"], quantity = r["quantity"], rule = r["rule"];
        auto column = std::ranges::find(heading, rule);
        if (column == heading.end()) column = heading.insert(column, rule);
        const auto at = static_cast<std::size_t>(column - heading.begin());
        auto line = std::ranges::find_if(
            lines, [&](const auto& cells) { return cells[0] == part && cells[1] == quantity; });
        if (line == lines.end()) line = lines.insert(line, {part, quantity});
        line->resize(std::max(line->size(), at + 1), "-");
        (*line)[at] = text_of_log(r, "q50") + " (" + text_of_log(r, "q99") + ")";
    }
    if (lines.empty()) return "";
    for (auto& line : lines) line.resize(heading.size(), "-");
    return "## Tightness\n\nBound over true error, by MPFR: median (and 99 %), in double; of rules "
           "that estimate errors, the estimate; the columns claimed and observed of "
           "tightness.csv say how often it should be no less, and is. The "
           "true error is zero or the bound unknown in further cases; tightness.csv counts them."
           "\n\n" +
           table(heading, 2, lines);
}

/// Of `exact`: brackets, then costs.
std::string first_contacts(const summary& report) {
    if (report.contacts.empty()) return "";
    rows all = report.contacts;
    for (row& r : all) {
        const auto set_ratio = [&r](const char* column, const char* time, const char* decision) {
            if (r.contains(time)) r[column] = r[time].get<double>() / r[decision].get<double>();
        };
        set_ratio("batch_ratio", "ns_batch_time", "ns_batch_decision");
        set_ratio("ratio", "ns_time", "ns_decision");
    }
    return "## First contacts\n\nBy `exact`, in [0, 1]: the time of a contact is a double, or in a "
           "bracket of two neighbouring ones, whose width is in t. Data sets, then families of "
           "stress, over all values of their knobs.\n\n" +
           table({"data", "kind", "queries", "contacts", "at the start", "at another double",
                  "two neighbours", "width, median", "width, largest"},
                 2,
                 {"data_set", "kind", "queries", "contacts", "at_start", "one_double", "neighbours",
                  "width_median", "width_largest"},
                 all) +
           "Cost: ns per query, one thread, the least of several passes in turn; yes or no, and "
           "with "
           "the first time. On the right of queries with a contact alone, one by one.\n\n" +
           table({"data", "kind", "timed", "batch: yes or no", "and time", "ratio",
                  "one by one: yes or no", "and time", "ratio", "with a contact", "yes or no",
                  "and time"},
                 2,
                 {"data_set", "kind", "timed", "ns_batch_decision", "ns_batch_time", "batch_ratio",
                  "ns_decision", "ns_time", "ratio", "timed_contacts", "ns_contact_decision",
                  "ns_contact_time"},
                 all);
}

std::string notes(const summary& report) {
    const std::string clock =
        report.times.empty() ? "0" : digits(report.times.front()["clock_ns"].get<double>());
    return "## How it was measured\n\n"
           "* Single queries: what two readings of the clock take (" +
           clock + " ns) is subtracted; each query counts with the least of " +
           std::to_string(sizes(report.settings.quick).repeats) +
           " timings, taken at different times, so that interrupts do not pose as slow queries. "
           "Caches are warm, and a few ns are within the clock's own noise.\n"
           "* Bounds: those that decide_bsc meets (ccd/methods/bsc.hpp), of queries drawn evenly "
           "where "
           "there are very many; queries whose coordinates are not of moderate size are first "
           "scaled by a power of two. Quantiles are by the nearest rank.\n"
           "* The CSV files hold the figures; `python3 plot.py` draws the "
           "pictures again.\n";
}

}  // namespace

std::string markdown_of(const summary& report) {
    std::string text = head(report) + failures(report) + all_data(report);
    for (const picture& p : report.pictures) {
        text += "![" + p.caption + "](" + p.file + ")\n\n" + p.caption + "\n\n";
    }
    return text + figure_11(report) + first_contacts(report) + tightness(report) + data(report) +
           per_data_set(report) + notes(report);
}

}  // namespace ccd::report
