#include "ccd/lab/report.hpp"

#include <cctype>
#include <ctime>
#include <errbound/support/error.hpp>
#include <optional>
#include <system_error>
#include <utility>

#include "ccd/io/plots/plots.hpp"
#include "ccd/lab/machine.hpp"
#include "ccd/lab/sections.hpp"
#include "ccd/lab/stress.hpp"
#include "errbound/support/output_file.hpp"

namespace ccd::lab {
namespace {

using errbound::support::csv_of;
using errbound::support::file_error;
using errbound::support::read_whole;
using errbound::support::write_whole;

namespace fs = std::filesystem;

using show_progress = std::function<void(double, const std::string&)>;
using print_line = std::function<void(const std::string&)>;

std::string now() {
    const std::time_t seconds = std::time(nullptr);
    char text[32] = "";
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", std::gmtime(&seconds));
    return text;
}

/// A unit of measurement, kept in a file so that a stopped report continues.
struct part {
    std::string name;
    row depends_on;       ///< all that its rows depend on
    std::string section;  ///< "speeds" are joined to the rows of "methods"
    double cost;          ///< roughly, in microseconds
    row about;            ///< columns that its rows begin with
    std::function<rows(const progress&)> measure;

    fs::path file_in(const fs::path& folder) const {
        // Legible, and yet different for names that differ in other characters only.
        std::string file = name;
        for (char& c : file)
            if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '.') c = '_';
        return folder / (file.substr(0, 100) + "-" + fingerprint_of(name).substr(0, 8) + ".json");
    }
    /// The rows, if the folder has the part's file, undamaged and with the same dependencies.
    std::optional<rows> stored_in(const fs::path& folder) const {
        const fs::path path = file_in(folder);
        std::error_code error;
        if (!fs::is_regular_file(path, error)) return std::nullopt;
        const std::optional<row> kept = kept_value(read_whole(path), depends_on);
        return kept && kept->is_array() ? std::optional(kept->get<rows>()) : std::nullopt;
    }
};

/// The parts of a report, in the order of measurement. Keeps references to the list and the data.
class part_list {
  public:
    explicit part_list(const report_options& settings, const row& machine)
        : settings_(settings),
          size_(sizes(settings.quick)),
          program_({{"program", program_fingerprint()},
                    {"commit", settings.commit},
                    {"processor", machine["processor"]}}) {
        for (const std::string& name : settings.methods)
            if (name != batch_name) singly_.push_back(name);
    }

    part_list(const part_list&) = delete;
    part_list& operator=(const part_list&) = delete;

    void add_data(const data_set& data) {
        for (const kind which : stored_kinds) {
            const std::size_t n =
                data.visit(which, [](const auto& known) { return known.queries.size(); });
            if (n > 0) add_data(data, which, static_cast<double>(n));
        }
    }

    void add_tightness(const std::vector<loaded_data>& data) {
#ifdef ERRBOUND_HAVE_MPFR
        add("tightness", "tightness: expressions", {{"number", size_.expressions}},
            20.0 * static_cast<double>(size_.expressions), {{"part", "expressions"}},
            [this](const progress& show) {
                return measure_expressions(size_, settings_.threads, show);
            });
        std::vector<const data_set*> sets;
        row fingerprints = row::array();
        for (const auto& set : data) {
            sets.push_back(set.get());
            fingerprints.push_back(set->fingerprint);
        }
        add("tightness", "tightness: queries",
            {{"data", fingerprints}, {"at_most", size_.tightness}},
            2000.0 * static_cast<double>(size_.tightness * sets.size()), {{"part", "queries"}},
            [this, sets](const progress& show) {
                return measure_tightness(sets, size_, settings_.threads, show);
            });
#else
        (void)data;
#endif
    }

    void add_families() {
        for (const family& f : families()) {
            const auto queries = static_cast<double>(size_.stress_queries * f.knobs.size());
            if (f.finite)
                add("contacts", "first contacts of stress: " + std::string(f.name),
                    {{"queries", size_.stress_queries}, {"repeats", size_.repeats}},
                    20.0 * queries * size_.repeats, {{"data_set", f.name}, {"origin", "stress"}},
                    [this, &f](const progress& show) { return contacts_of(f, show); });
        }
        const auto methods = static_cast<double>(settings_.methods.size());
        for (const family& f : families())
            add("stress", "stress: " + std::string(f.name),
                {{"methods", settings_.methods}, {"quick", settings_.quick}},
                2e6 * size_.stress_seconds * static_cast<double>(f.knobs.size()) * (methods + 1),
                row::object(), [this, &f](const progress& show) { return stress_of(f, show); });
    }

    const std::vector<part>& parts() const {
        return parts_;
    }

  private:
    void add(const std::string& section, std::string name, const row& depends_on, double cost,
             row about, std::function<rows(const progress&)> measure) {
        if (!settings_.wants(section == "speeds" ? "methods" : section)) return;
        row all = program_;
        all.update(depends_on);
        parts_.push_back(
            {std::move(name), std::move(all), section, cost, std::move(about), std::move(measure)});
    }

    void add_data(const data_set& data, kind which, double n) {
        const auto add_part = [&](const char* section, const std::string& what, row depends_on,
                                  double cost, std::function<rows(const progress&)> measure) {
            depends_on["data"] = data.fingerprint;
            add(section, data.name + " " + std::string(short_name(which)) + ": " + what, depends_on,
                cost,
                {{"data_set", data.name}, {"origin", data.origin}, {"kind", short_name(which)}},
                std::move(measure));
        };
        const auto drawn = [n](std::size_t most) { return std::min(n, static_cast<double>(most)); };
        const double passes = 1 + size_.repeats;
        for (const std::string& method : settings_.methods)
            add_part("methods", "errors of " + method, {{"method", method}}, n / 2,
                     [this, &data, which, method](const progress& show) {
                         return count_errors(data, which, method, settings_.threads, show);
                     });
        add_part(
            "speeds", "ns per query",
            {{"methods", settings_.methods}, {"at_most", size_.speed}, {"repeats", size_.repeats}},
            drawn(size_.speed) * static_cast<double>(settings_.methods.size()) * passes,
            [this, &data, which](const progress& show) {
                return race_methods(data, which, settings_.methods, size_, show);
            });
        add_part("times", "times of single queries",
                 {{"methods", singly_}, {"at_most", size_.times}, {"repeats", size_.repeats}},
                 drawn(size_.times) * static_cast<double>(singly_.size()) * size_.repeats,
                 [this, &data, which](const progress& show) {
                     return time_queries(data, which, singly_, size_, show);
                 });
        add_part("contacts", "first contacts",
                 {{"at_most", size_.speed}, {"contacts", size_.times}, {"repeats", size_.repeats}},
                 n / 10 + 4.0 * drawn(size_.speed) * passes,
                 [this, &data, which](const progress& show) {
                     return find_contacts(data, which, size_, settings_.threads, show);
                 });
        add_part("bounds", "bounds", {{"at_most", size_.bounds}}, drawn(size_.bounds),
                 [this, &data, which](const progress&) { return take_bounds(data, which, size_); });
    }

    rows contacts_of(const family& f, const progress& show) const {
        const loaded_data data = data_of(f, size_.stress_queries, settings_.threads);
        rows all;
        for (const kind which : stored_kinds) {
            const double before = which == stored_kinds[0] ? 0 : 0.5;
            row r = {{"kind", short_name(which)}};
            r.update(find_contacts(*data, which, size_, settings_.threads, [&](double share) {
                         show(before + share / 2);
                     }).front());
            all.push_back(std::move(r));
        }
        return all;
    }

    rows stress_of(const family& f, const progress& show) const {
        plan what{.families = {&f},
                  .subjects = {},
                  .queries = size_.stress_queries,
                  .threads = settings_.threads,
                  .seconds = size_.stress_seconds};
        for (const std::string& name : settings_.methods)
            what.subjects.push_back(subject_named(name));
        const auto cells = run(what, [&](std::size_t done, std::size_t all, const family&) {
            show(static_cast<double>(done) / static_cast<double>(all));
        });
        rows result;
        for (const cell& c : cells) result.push_back(row_of(c, what));
        return result;
    }

    report_options settings_;
    sample_sizes size_;
    row program_;                      ///< all parts depend on it
    std::vector<std::string> singly_;  ///< methods that decide queries one by one
    std::vector<part> parts_;
};

/// Measures the parts that the folder lacks, and collects all rows.
void measure(const std::vector<part>& parts, report_summary& report, const show_progress& show,
             const print_line& print) {
    const fs::path folder = report.settings.out / "parts";
    make_folder(folder);
    report.parts = parts.size();
    double all_costs = 0, done = 0;
    std::vector<std::optional<rows>> results;
    for (const part& p : parts) {
        all_costs += p.cost;
        results.push_back(p.stored_in(folder));
        if (results.back()) done += p.cost;
        report.resumed += results.back().has_value();
    }
    if (report.resumed > 0)
        print("going on: " + std::to_string(report.resumed) + " of " +
              std::to_string(report.parts) + " parts are from an earlier run");
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const part& p = parts[i];
        if (!results[i]) {
            const auto show_share = [&](double share) {
                show((done + share * p.cost) / all_costs, p.name);
            };
            show_share(0);
            results[i] = p.measure(show_share);
            write_whole(p.file_in(folder), kept_text(p.depends_on, *results[i]));
            done += p.cost;
        }
        for (const row& r : *results[i]) {
            row whole = p.about;
            whole.update(r);
            report.tables[p.section].push_back(std::move(whole));
        }
    }
    for (row& r : report.tables["methods"])
        for (const row& s : report.tables["speeds"])
            if (s["data_set"] == r["data_set"] && s["kind"] == r["kind"] &&
                s["method"] == r["method"])
                r.update(s);
}

std::vector<loaded_data> collect_data(report_summary& report, const show_progress& show) {
    const report_options& settings = report.settings;
    const found_data found = find_data(settings.data);
    report.skipped = found.skipped;
    std::vector<loaded_data> all;
    for (const data_source& source : found.sources) {
        show(0, "reading " + source.name);
        try {
            loaded_data data = load(source, settings.threads);
            const auto size = [](const auto& known) { return known.queries.size(); };
            if (data->visit(kind::vertex_face, size) + data->visit(kind::edge_edge, size) > 0)
                all.push_back(std::move(data));
            else
                report.skipped.push_back({source.name, "it holds no queries"});
        } catch (const file_error& error) {
            report.skipped.push_back({source.name, error.what()});
        }
    }
    if (all.empty()) {
        std::string message = "number of data sets is 0; expected stored queries or a scene in";
        for (const fs::path& folder : settings.data) message.append(" ").append(folder.string());
        for (const omission& o : report.skipped)
            message.append("; skipped: ").append(o.path.string() + ": " + o.why);
        throw file_error(message);
    }
    if (settings.made)
        for (auto& data : made_data(settings.threads)) all.push_back(std::move(data));
    return all;
}

void describe(const data_set& data, report_summary& report) {
    std::size_t contradictions = 0, stored = 0;
    data.queries.for_each([&]<class Query>(const queries_with_truth<Query>& known) {
        contradictions += known.contradictions;
        stored += known.stored_truths;
        if (known.queries.size() == 0) return;
        const std::string count = errbound::support::grouped(known.stored_truths);
        std::string truth = "exact, in batches";
        if (known.stored_truths > 0 && data.origin != "scene")
            truth = count + " stored" +
                    (known.stored_truths < known.queries.size() ? ", else exact" : "");
        if (known.stored_truths > 0 && data.origin == "scene")
            truth += "; of " + count + " stored ones " + std::to_string(known.contradictions) +
                     " differ";
        report.data.push_back({{"data_set", data.name},
                               {"kind", short_name(kind_of<Query>)},
                               {"origin", data.origin},
                               {"truth", truth},
                               {"queries", known.queries.size()},
                               {"colliding", known.colliding}});
    });
    if (contradictions > 0)
        report.failures.push_back(data.name + ": exact contradicts " +
                                  std::to_string(contradictions) + " of " + std::to_string(stored) +
                                  " stored truths");
}

std::string text(const row& r, const char* column) {
    return r[column].is_string() ? r[column].get<std::string>() : r[column].dump();
}

void add_broken_methods(report_summary& report) {
    for (const row& r : report.tables["methods"]) {
        const subject promised = subject_named(text(r, "method"));
        const auto check = [&](bool may, const char* count, const std::string& what) {
            if (!may && r[count] != 0)
                report.failures.push_back(promised.name + ": " + text(r, count) + " " + what +
                                          " on " + text(r, "data_set") + ", " + text(r, "kind") +
                                          ", against its promise");
        };
        check(promised.may_lose_collisions, "false_negatives", "collisions lost");
        check(promised.may_report_false_collisions, "false_positives", "false collisions");
        check(promised.may_report_false_collisions, "uncertain", "queries left uncertain");
    }
}

void add_failures(report_summary& report) {
    add_broken_methods(report);
    const auto add = [&report](const char* table, const auto& where) {
        for (const row& r : report.tables[table])
            if (r.contains("broken"))
                report.failures.push_back(where(r) + ": " + text(r, "broken"));
    };
    add("tightness",
        [](const row& r) { return "rule " + text(r, "rule") + " in " + text(r, "part"); });
    add("contacts", [](const row& r) {
        return "first contacts on " + text(r, "data_set") + ", " + text(r, "kind");
    });
    add("stress", [](const row& r) {
        return text(r, "method") + " on stress family " + text(r, "family") + ", knob " +
               text(r, "knob") + ", " + text(r, "kind") + ", query " + text(r, "query");
    });
}

void write_tables(report_summary& report) {
    for (const section& s : sections()) {
        const fs::path path = report.settings.out / (s.name + ".csv");
        std::error_code ignored;
        fs::remove(path, ignored);
        const rows& table = report.tables[s.name];
        if (table.empty()) continue;
        write_whole(
            path,
            csv_of(s.columns.empty() ? errbound::support::columns_of(table) : s.columns, table));
    }
}

const std::vector<picture> possible_pictures{
    {"pareto.png",
     "Error against run time on all candidate pairs of the scenes' steps. The band holds the "
     "methods without an error; height within it means nothing."},
    {"pareto-queries.png", "Error against run time on stored and generated hard queries."},
    {"bounds.png",
     "Bounds on the rounding error of the six critical variables of BSC under each rule, "
     "relative to the query's largest control value |k| of Y (the paper's Figure 8)."},
    {"times.png", "Times of single queries: median, 99 %, 99.9 % and the slowest."},
    {"contacts.png",
     "First contacts by exact: whether their time is a double or between two neighbouring ones, "
     "and their cost compared with yes or no."},
    {"tightness.png",
     "Each rule's bounds over the true errors, by MPFR, in random expressions and in BSC on "
     "queries of all data sets: the median and 99 % of the ratio, in double."},
    {"stress-false-negatives.png", "False negatives on stiff and extreme queries."},
    {"stress-false-positives.png", "False positives on stiff and extreme queries."},
    {"stress-ns.png", "Time per query on stiff and extreme queries."},
};

void draw_pictures(report_summary& report, const print_line& print) {
    const fs::path& folder = report.settings.out;
    for (const picture& p : possible_pictures) {  // of earlier data
        std::error_code ignored;
        fs::remove(folder / p.file, ignored);
        fs::remove((folder / p.file).replace_extension(".svg"), ignored);
    }
    const int status = io::draw_pictures(folder);
    if (status == io::no_python) print("no pictures: Python (python3) cannot be run");
    if (status == io::no_matplotlib || status == io::no_python)
        report.skipped.push_back({"pictures", "no Python with matplotlib"});
    else if (status != 0)
        report.failures.push_back("plot.py ended with status " + std::to_string(status));
    for (const picture& p : possible_pictures)
        if (fs::exists(folder / p.file)) report.pictures.push_back(p);
}

}  // namespace

const std::vector<section>& sections() {
    static const std::vector<section> all{
        {"methods", io::method_columns},
        {"times",
         {"data_set", "kind", "method", "timed", "ns_median", "ns_90", "ns_99", "ns_99_9",
          "ns_worst", "clock_ns"}},
        {"contacts",
         {"data_set", "origin", "kind", "queries", "contacts", "at_start", "one_double",
          "neighbours", "width_median", "width_largest", "timed", "ns_batch_decision",
          "ns_batch_time", "ns_decision", "ns_time", "timed_contacts", "ns_contact_decision",
          "ns_contact_time"}},
        {"bounds", {"data_set",     "kind",         "rule",         "variable",     "count",
                    "exact",        "unknown",      "q0",           "q1",           "q25",
                    "q50",          "q75",          "q99",          "q100",         "relative_q0",
                    "relative_q1",  "relative_q25", "relative_q50", "relative_q75", "relative_q99",
                    "relative_q100"}},
        {"tightness", {}},
        {"stress", stress_columns},
    };
    return all;
}

rows totals(const rows& methods, const std::function<bool(const row&)>& counts) {
    rows all;
    for (const row& r : methods) {
        if (!counts(r)) continue;
        auto total = std::ranges::find_if(
            all, [&](const row& other) { return other["method"] == r["method"]; });
        if (total == all.end()) {
            all.push_back({{"method", r["method"]}, {"queries", 0}, {"ns", 0.0}});
            total = all.end() - 1;
        }
        const double before = (*total)["queries"], here = r["queries"];
        (*total)["ns"] =
            ((*total)["ns"].get<double>() * before + r["ns_min"].get<double>() * here) /
            (before + here);
        for (const char* count :
             {"queries", "colliding", "false_positives", "false_negatives", "uncertain"})
            (*total)[count] = total->value(count, std::size_t{0}) + r[count].get<std::size_t>();
    }
    return all;
}

report_summary make_report(const report_options& settings, const show_progress& show,
                           const print_line& print) {
    report_summary report;
    report.settings = settings;
    report.machine = this_machine();
    report.date = now();
    const std::vector<loaded_data> data = collect_data(report, show);
    for (const omission& o : report.skipped) print("skipped: " + o.path.string() + ": " + o.why);
    part_list list(settings, report.machine);
    for (const auto& set : data) {
        describe(*set, report);
        list.add_data(*set);
    }
    list.add_tightness(data);
    list.add_families();
    measure(list.parts(), report, show, print);
    add_failures(report);
    report.load_at_end = this_machine()["load"];

    write_tables(report);
    show(1, "pictures");
    draw_pictures(report, print);
    write_whole(settings.out / "report.md", text_of(report));
    return report;
}

}  // namespace ccd::lab
