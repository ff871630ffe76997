#include "ccd/report/report.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <ctime>
#include <system_error>

#include "ccd/io/error.hpp"
#include "ccd/io/output_file.hpp"

namespace ccd::report {

extern const std::string_view plot_script;  // ccd/report/plot.py, by the build

namespace {

namespace fs = std::filesystem;

/// A part to be measured. `share` is told while it is.
struct task {
    part_key key;
    double cost;  ///< in some unit that all tasks share
    row about;    ///< columns that its rows begin with
    std::function<rows(const progress& share)> measure;
    rows* into;
};

std::string now() {
    const std::time_t seconds = std::time(nullptr);
    char text[32] = "";
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", std::gmtime(&seconds));
    return text;
}

/// The tasks of all data sets, in the order in which they are done.
class task_list {
  public:
    task_list(const options& settings, const machine& here)
        : settings_(settings),
          size_(sizes(settings.quick)),
          program_({{"program", program_fingerprint()},
                    {"commit", settings.commit},
                    {"processor", here.processor}}) {
        for (const std::string& name : settings.methods) {
            if (name != batch_name) singly_.push_back(name);
        }
    }

    void add(const data_set& data) {
        add(data, data.vertex_face_queries);
        add(data, data.edge_edge_queries);
    }

    std::vector<task> tasks;
    rows errors, speeds, times, bounds;

  private:
    template <class Query>
    void add(const data_set& data, const judged_queries<Query>& judged) {
        const std::size_t n = judged.queries.size();
        if (n == 0) return;
        const row about = {{"data_set", data.name}, {"kind", kind_of<Query>::name}};
        const auto add_task = [&](const std::string& section, row depends_on, double cost,
                                  std::function<rows(const progress&)> measure, rows& into) {
            row all = program_;
            all["data"] = data.fingerprint;
            all.update(depends_on);
            tasks.push_back({{data.name + " " + std::string(kind_of<Query>::name) + ": " + section,
                              std::move(all)},
                             cost,
                             about,
                             std::move(measure),
                             &into});
        };
        const auto drawn = [n](std::size_t most) { return static_cast<double>(std::min(n, most)); };
        for (const std::string& method : settings_.methods) {
            add_task(
                "errors of " + method, {{"method", method}}, static_cast<double>(n) / 2,
                [&judged, method, threads = settings_.threads](const progress& share) {
                    return count_errors(judged, method, threads, share);
                },
                errors);
        }
        const auto methods = static_cast<double>(settings_.methods.size());
        add_task(
            "ns per query",
            {{"methods", settings_.methods}, {"at_most", size_.speed}, {"repeats", size_.repeats}},
            drawn(size_.speed) * methods * (1 + size_.repeats),
            [&judged, this](const progress&) {
                return race_methods(judged, settings_.methods, size_);
            },
            speeds);
        add_task(
            "times of single queries",
            {{"methods", singly_}, {"at_most", size_.times}, {"repeats", size_.repeats}},
            drawn(size_.times) * methods * size_.repeats,
            [&judged, this](const progress& share) {
                return time_queries(judged, singly_, size_, share);
            },
            times);
        add_task(
            "bounds", {{"at_most", size_.bounds}}, drawn(size_.bounds),
            [&judged, this](const progress&) { return take_bounds(judged, size_); }, bounds);
    }

    options settings_;
    sample_sizes size_;
    row program_;
    std::vector<std::string> singly_;
};

/// The rows of `errors`, each with what `speeds` tells of the same data set, kind and method.
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
    const auto of = [](const auto& judged) {
        return data_summary::kind{judged.queries.size(), judged.colliding, judged.stored_truths,
                                  judged.contradictions};
    };
    return {data.name, data.is_scene, of(data.vertex_face_queries), of(data.edge_edge_queries)};
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
        if (!promised.may_report_false_collisions) fail("false_positives", "false collisions");
    }
    for (const data_summary& data : report.data) {
        for (const auto* kind : {&data.vertex_face, &data.edge_edge}) {
            if (kind->contradictions > 0)
                failures.push_back(data.name + ": exact contradicts " +
                                   std::to_string(kind->contradictions) + " of " +
                                   std::to_string(kind->stored_truths) + " stored truths");
        }
    }
    return failures;
}

/// Runs plot.py in the folder. False if nothing could be drawn; the script has then said why.
bool draw(const fs::path& folder) {
    const std::string script = (folder / "plot.py").string();
    const pid_t child = fork();
    if (child == 0) {
        // Distribution packages belong to the distribution's Python, which need not be the first
        // on PATH.
        for (const char* python : {"/usr/bin/python3", "python3"}) {
            execlp(python, python, script.c_str(), static_cast<char*>(nullptr));
        }
        _exit(127);
    }
    int status = 0;
    return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) &&
           WEXITSTATUS(status) == 0;
}

const std::vector<picture>& possible_pictures() {
    static const std::vector<picture> all{
        {"pareto.png",
         "Error against run time. Each method over all data sets; the band holds those without an "
         "error."},
        {"bounds.png",
         "Bounds on the rounding error of the six critical variables of BSC under each rule, "
         "relative to the query's largest control value |k| of Y (the paper's Figure 8)."},
        {"times.png", "Times of single queries: median, 99 %, 99.9 % and the slowest."},
        {"tightness.png", "How much larger each rule's bounds are than the true errors."},
        {"stress-false-negatives.png", "False negatives on stiff and extreme queries."},
        {"stress-false-positives.png", "False positives on stiff and extreme queries."},
        {"stress-ns.png", "Time per query on stiff and extreme queries."},
    };
    return all;
}

const std::vector<std::string> method_columns{
    "data_set",  "kind",       "method",          "queries",
    "colliding", "collisions", "false_positives", "false_negatives",
    "uncertain", "timed",      "ns_min",          "ns_median"};
const std::vector<std::string> time_columns{"data_set", "kind",  "method",  "timed",    "ns_median",
                                            "ns_90",    "ns_99", "ns_99_9", "ns_worst", "clock_ns"};
const std::vector<std::string> bound_columns{
    "data_set",     "kind",         "rule",         "variable",    "count",        "exact",
    "unknown",      "q0",           "q1",           "q25",         "q50",          "q75",
    "q99",          "q100",         "relative_q0",  "relative_q1", "relative_q25", "relative_q50",
    "relative_q75", "relative_q99", "relative_q100"};

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
    const part_store store(settings.out / "parts");
    summary report;
    report.settings = settings;
    report.here = this_machine();
    report.date = now();
    const found_data found = find_data(settings.data);
    report.left_out = found.left_out;

    task_list list(settings, report.here);
    std::vector<std::unique_ptr<data_set>> data;
    for (const data_source& source : found.sources) {
        show(0, "reading " + source.name);
        try {
            data.push_back(load(source, settings.threads));
        } catch (const io::file_error& error) {
            report.left_out.push_back({source.name, error.what()});
            continue;
        }
        report.data.push_back(summary_of(*data.back()));
        list.add(*data.back());
    }
    for (const omission& without : report.left_out) {
        say("left out: " + without.path.string() + ": " + without.why);
    }
    if (list.tasks.empty()) {
        std::string folders;
        for (const fs::path& folder : settings.data) folders.append(" ").append(folder.string());
        throw io::file_error("found no stored queries and no scene in" + folders +
                             ", expected a data set");
    }

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
    report.methods = joined(list.errors, list.speeds);
    report.times = list.times;
    report.bounds = list.bounds;
    report.failures = failures_of(report);

    io::write_whole(settings.out / "methods.csv", csv_of(method_columns, report.methods));
    io::write_whole(settings.out / "times.csv", csv_of(time_columns, report.times));
    io::write_whole(settings.out / "bounds.csv", csv_of(bound_columns, report.bounds));
    io::write_whole(settings.out / "plot.py", plot_script);
    // Pictures of earlier data must not pose as these.
    for (const picture& p : possible_pictures()) {
        std::error_code ignored;
        fs::remove(settings.out / p.file, ignored);
        fs::remove((settings.out / p.file).replace_extension(".svg"), ignored);
    }
    show(1, "pictures");
    if (!draw(settings.out)) say("the pictures are left out; all else is written");
    for (const picture& p : possible_pictures()) {
        if (fs::exists(settings.out / p.file)) report.pictures.push_back(p);
    }
    io::write_whole(settings.out / "report.md", markdown_of(report));
    return report;
}

}  // namespace ccd::report
