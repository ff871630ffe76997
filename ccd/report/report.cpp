#include "ccd/report/report.hpp"

#include <ctime>
#include <errbound/support/error.hpp>
#include <system_error>

#include "ccd/io/plots/plots.hpp"
#include "ccd/report/tasks.hpp"
#include "errbound/support/output_file.hpp"

namespace ccd::report {

namespace {

using errbound::support::file_error;
using errbound::support::write_whole;

namespace fs = std::filesystem;

std::string now() {
    const std::time_t seconds = std::time(nullptr);
    char text[32] = "";
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", std::gmtime(&seconds));
    return text;
}

/// The rows of `errors`, each with what `speeds` has on the same data set, kind and method.
rows joined(rows errors, const rows& speeds) {
    for (row& r : errors) {
        for (const row& s : speeds) {
            if (s["data_set"] == r["data_set"] && s["kind"] == r["kind"] &&
                s["method"] == r["method"])
                r.update(s);
        }
    }
    return errors;
}

data_summary summary_of(const data_set& data) {
    data_summary result{data.name, data.origin, {}};
    data.queries.for_each([&result]<class Query>(const queries_with_truth<Query>& known) {
        result.kinds.push_back({kind_of<Query>, known.queries.size(), known.colliding,
                                known.stored_truths, known.contradictions});
    });
    return result;
}

std::vector<std::string> failures_of(const summary& report) {
    std::vector<std::string> failures;
    for (const row& r : report.methods) {
        const std::string name = r["method"];
        const method_info& promised = info(name == batch_name ? method::exact : *find_method(name));
        const auto fail = [&](const char* count, const std::string& what) {
            if (r[count] != 0)
                failures.push_back(name + ": " + r[count].dump() + " " + what + " on " +
                                   r["data_set"].get<std::string>() + ", " +
                                   r["kind"].get<std::string>() + ", against its promise");
        };
        if (!promised.may_lose_collisions) fail("false_negatives", "collisions lost");
        if (!promised.may_report_false_collisions) {
            fail("false_positives", "false collisions");
            fail("uncertain", "queries left uncertain");
        }
    }
    for (const row& r : report.tightness) {
        if (!r.contains("broken")) continue;
        failures.push_back(std::string("rule ")
                               .append(r["rule"].get<std::string>())
                               .append(" in " + r["part"].get<std::string>())
                               .append(": " + r["broken"].get<std::string>()));
    }
    for (const row& r : report.contacts) {
        if (r.contains("broken"))
            failures.push_back("first contacts on " + r["data_set"].get<std::string>() + ", " +
                               r["kind"].get<std::string>() + ": " +
                               r["broken"].get<std::string>());
    }
    for (const row& r : report.stress) {
        if (!r.contains("broken")) continue;
        failures.push_back(r["method"].get<std::string>() + ": " + r["broken"].get<std::string>() +
                           "; stress family " + r["family"].get<std::string>() + ", knob " +
                           r["knob"].dump() + ", " + r["kind"].get<std::string>() + ", query " +
                           r["query"].dump());
    }
    for (const data_summary& data : report.data) {
        for (const data_summary::counts& of : data.kinds) {
            if (of.contradictions > 0)
                failures.push_back(data.name + ": exact contradicts " +
                                   std::to_string(of.contradictions) + " of " +
                                   std::to_string(of.stored_truths) + " stored truths");
        }
    }
    return failures;
}

const std::vector<picture>& possible_pictures() {
    static const std::vector<picture> all{
        {"pareto.png",
         "Error against run time on all candidate pairs of the scenes' steps. The band holds the "
         "methods without an error; height within it means nothing."},
        {"pareto-queries.png",
         "Error against run time on stored and made queries, which are picked to be hard."},
        {"bounds.png",
         "Bounds on the rounding error of the six critical variables of BSC under each rule, "
         "relative to the query's largest control value |k| of Y (the paper's Figure 8)."},
        {"times.png", "Times of single queries: median, 99 %, 99.9 % and the slowest."},
        {"contacts.png",
         "First contacts by exact: whether their time is a double or between two neighbouring "
         "ones, and what it costs beside yes or no, in which there is nothing to find for queries "
         "without a contact."},
        {"tightness.png",
         "How much larger each rule's bounds are than the true errors, by MPFR, in random "
         "expressions and in BSC on queries of all data sets: the median and 99 % of the ratio, in "
         "double."},
        {"stress-false-negatives.png", "False negatives on stiff and extreme queries."},
        {"stress-false-positives.png", "False positives on stiff and extreme queries."},
        {"stress-ns.png", "Time per query on stiff and extreme queries."},
    };
    return all;
}

const std::vector<std::string> time_columns{"data_set", "kind",  "method",  "timed",    "ns_median",
                                            "ns_90",    "ns_99", "ns_99_9", "ns_worst", "clock_ns"};
const std::vector<std::string> contact_columns{"data_set",
                                               "origin",
                                               "kind",
                                               "queries",
                                               "contacts",
                                               "at_start",
                                               "one_double",
                                               "neighbours",
                                               "width_median",
                                               "width_largest",
                                               "timed",
                                               "ns_batch_decision",
                                               "ns_batch_time",
                                               "ns_decision",
                                               "ns_time",
                                               "timed_contacts",
                                               "ns_contact_decision",
                                               "ns_contact_time"};
const std::vector<std::string> tightness_columns{
    "part",     "rule", "number", "quantity", "measure", "count", "exact", "unknown", "claimed",
    "observed", "q0",   "q1",     "q25",      "q50",     "q75",   "q99",   "q100",    "clamped"};
const std::vector<std::string> stress_columns{"family",     "knob_name",       "knob",
                                              "kind",       "method",          "queries",
                                              "collisions", "false_positives", "false_negatives",
                                              "uncertain",  "ns_per_query"};
const std::vector<std::string> bound_columns{
    "data_set",     "kind",         "rule",         "variable",    "count",        "exact",
    "unknown",      "q0",           "q1",           "q25",         "q50",          "q75",
    "q99",          "q100",         "relative_q0",  "relative_q1", "relative_q25", "relative_q50",
    "relative_q75", "relative_q99", "relative_q100"};

using show_progress = std::function<void(double, const std::string&)>;
using say_line = std::function<void(const std::string&)>;

/// Reads the data; what cannot be read is left out and reported.
std::vector<std::unique_ptr<data_set>> collect_data(const options& settings, summary& report,
                                                    const show_progress& show) {
    const found_data found = find_data(settings.data);
    report.left_out = found.left_out;
    std::vector<std::unique_ptr<data_set>> all;
    for (const data_source& source : found.sources) {
        show(0, "reading " + source.name);
        try {
            all.push_back(load(source, settings.threads));
        } catch (const file_error& error) {
            report.left_out.push_back({source.name, error.what()});
            continue;
        }
        if (summary_of(*all.back()).queries() == 0) {
            report.left_out.push_back({source.name, "it holds no queries"});
            all.pop_back();
        }
    }
    if (all.empty()) {
        std::string folders;
        for (const fs::path& folder : settings.data) folders.append(" ").append(folder.string());
        std::string why;
        for (const omission& without : report.left_out)
            why.append("; left out: ").append(without.path.string() + ": " + without.why);
        throw file_error("found no stored queries and no scene in" + folders +
                         ", expected a data set" + why);
    }
    if (settings.made) {
        for (auto& data : made_data(settings.threads)) all.push_back(std::move(data));
    }
    return all;
}

/// Does the tasks whose parts are not in the report's folder yet, and collects all rows.
void measure(const task_list& list, const options& settings, summary& report,
             const show_progress& show, const say_line& say) {
    const part_store store(settings.out / "parts");
    report.parts = list.tasks.size();
    double all_costs = 0, done = 0;
    std::vector<rows> results(list.tasks.size());
    std::vector<bool> is_done(list.tasks.size());
    for (std::size_t i = 0; i < list.tasks.size(); ++i) {
        all_costs += list.tasks[i].cost;
        is_done[i] = store.find(list.tasks[i].key, results[i]);
        if (is_done[i]) done += list.tasks[i].cost;
        report.resumed += is_done[i];
    }
    if (report.resumed > 0)
        say("going on: " + std::to_string(report.resumed) + " of " + std::to_string(report.parts) +
            " parts are from an earlier run");
    for (std::size_t i = 0; i < list.tasks.size(); ++i) {
        const task& t = list.tasks[i];
        if (!is_done[i]) {
            const auto show_share = [&](double share) {
                show((done + share * t.cost) / all_costs, t.key.name);
            };
            show_share(0);
            results[i] = t.measure(show_share);
            store.keep(t.key, results[i]);
            done += t.cost;
        }
        for (const row& r : results[i]) {
            row whole = t.about;
            whole.update(r);
            t.into->push_back(std::move(whole));
        }
    }
}

/// Writes the tables that were asked for; others, of an earlier run, must not pose as these.
void write_tables(const summary& report) {
    const struct {
        std::string_view section;
        const std::vector<std::string>& columns;
        const rows& table;
    } tables[] = {{"methods", io::method_columns, report.methods},
                  {"times", time_columns, report.times},
                  {"contacts", contact_columns, report.contacts},
                  {"bounds", bound_columns, report.bounds},
                  {"tightness", tightness_columns, report.tightness},
                  {"stress", stress_columns, report.stress}};
    for (const auto& t : tables) {
        const fs::path path = report.settings.out / (std::string(t.section) + ".csv");
        std::error_code ignored;
        fs::remove(path, ignored);
        if (!t.table.empty()) write_whole(path, io::csv_of(t.columns, t.table));
    }
}

/// Writes plot.py and runs it. Pictures that it could not make are left out, which is reported.
void draw_pictures(summary& report, const say_line& say) {
    const fs::path& folder = report.settings.out;
    for (const picture& p : possible_pictures()) {  // of earlier data
        std::error_code ignored;
        fs::remove(folder / p.file, ignored);
        fs::remove((folder / p.file).replace_extension(".svg"), ignored);
    }
    const int status = io::draw_pictures(folder);
    if (status == io::no_python) say("no pictures: Python (python3) cannot be run");
    if (status == io::no_matplotlib || status == io::no_python) {
        report.left_out.push_back({"pictures", "no Python with matplotlib"});
    } else if (status != 0) {
        report.failures.push_back("plot.py ended with status " + std::to_string(status));
    }
    for (const picture& p : possible_pictures()) {
        if (fs::exists(folder / p.file)) report.pictures.push_back(p);
    }
}

}  // namespace

std::vector<method_total> totals(const rows& methods,
                                 const std::function<bool(const row&)>& counts) {
    std::vector<method_total> all;
    for (const row& r : methods) {
        if (!counts(r)) continue;
        auto total = std::ranges::find(all, r["method"].get<std::string>(), &method_total::method);
        if (total == all.end()) total = all.insert(all.end(), method_total{r["method"]});
        const std::size_t queries = r["queries"];
        total->queries += queries;
        total->colliding += r["colliding"].get<std::size_t>();
        total->false_positives += r["false_positives"].get<std::size_t>();
        total->false_negatives += r["false_negatives"].get<std::size_t>();
        total->uncertain += r["uncertain"].get<std::size_t>();
        total->ns += r["ns_min"].get<double>() * static_cast<double>(queries);
    }
    for (method_total& total : all) total.ns /= static_cast<double>(total.queries);
    return all;
}

summary make(const options& settings, const std::function<void(double, const std::string&)>& show,
             const std::function<void(const std::string&)>& say) {
    summary report;
    report.settings = settings;
    report.here = this_machine();
    report.date = now();
    task_list list(settings, report.here);
    const auto data = collect_data(settings, report, show);
    for (const omission& without : report.left_out) {
        say("left out: " + without.path.string() + ": " + without.why);
    }
    for (const auto& set : data) {
        report.data.push_back(summary_of(*set));
        list.add(*set);
    }
    list.add_others();
    measure(list, settings, report, show, say);

    report.methods = joined(list.errors, list.speeds);
    report.times = list.times;
    report.contacts = list.contacts;
    report.bounds = list.bounds;
    report.tightness = list.tightness;
    report.stress = list.stress;
    report.failures = failures_of(report);
    report.load_at_end = this_machine().load;

    write_tables(report);
    show(1, "pictures");
    draw_pictures(report, say);
    write_whole(settings.out / "report.md", markdown_of(report));
    return report;
}

}  // namespace ccd::report
