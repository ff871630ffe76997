// `ccd query`: decides stored queries with some methods, compares with the truth, times them.
#include <algorithm>
#include <ccd/first_times.hpp>
#include <ccd/io/query_file.hpp>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "ccd/program/command.hpp"
#include "ccd/program/options.hpp"
#include "errbound/support/command_line.hpp"
#include "errbound/support/output_file.hpp"
#include "errbound/support/progress_line.hpp"
#include "errbound/support/table.hpp"

namespace ccd::program {
namespace {

using errbound::support::progress_line;
using errbound::support::table;
using errbound::support::text_of;
using errbound::support::usage_error;
using errbound::support::write_whole;

using std::chrono::steady_clock;

double seconds_since(steady_clock::time_point start) {
    return std::chrono::duration<double>(steady_clock::now() - start).count();
}

/// One row of the table.
struct result {
    std::string file;
    ccd::kind kind{};
    ccd::method method{};
    std::vector<bool> verdicts;  ///< true: may collide
    std::optional<std::size_t> false_positives, false_negatives;
    std::vector<first_time> times;  ///< if asked for
    double ns_per_query = 0;

    std::size_t collisions() const {
        return static_cast<std::size_t>(std::count(verdicts.begin(), verdicts.end(), true));
    }
};

/// What `exact` is asked beyond contact in the whole step.
struct time_question {
    bool times = false;
    double t_max = 1;
    std::optional<double> distance = {};

    /// Whether the files' truth, of contact in the whole step, is another question's.
    bool is_another() const { return t_max < 1 || distance; }
};

template <class Query>
outcome decide_one(const Query& query, ccd::method method, const time_question& asked) {
    if (asked.t_max < 1)
        return asked.distance ? time_within(query, {*asked.distance, 0}, asked.t_max).outcome
                              : time_of_impact(query, asked.t_max).outcome;
    return asked.distance ? decide_within(query, {*asked.distance, 0}).outcome
                          : decide(method, query).outcome;
}

template <class Query>
std::vector<first_time> find_times(const std::vector<Query>& queries, const device_choice& device,
                                   const time_question& asked) {
    if (!device.cuda)
        return first_times(queries,
                           {.t_max = asked.t_max, .distances = {asked.distance.value_or(0)}});
    std::vector<first_time> times(queries.size());
    find_times_on_device<Query>(queries, times, asked.t_max);
    return times;
}

template <class Query>
void answer_on_device(const std::vector<Query>& queries, const device_choice& device, method m,
                      const time_question& asked, std::vector<outcome>& outcomes) {
    if (asked.t_max < 1)
        std::ranges::transform(find_times(queries, device, asked), outcomes.begin(),
                               &first_time::outcome);
    else
        decide_on_device<Query>(queries, outcomes, m, device.precision);
}

template <class Query>
void decide_all(const std::vector<Query>& queries, const device_choice& device,
                const time_question& asked, result& out) {
    // Made into bits afterwards, since that is work which is not the method's.
    std::vector<outcome> outcomes(queries.size());
    double fastest = std::numeric_limits<double>::infinity();
    const steady_clock::time_point start = steady_clock::now();
    do {
        const steady_clock::time_point pass = steady_clock::now();
        if (device.cuda)
            answer_on_device(queries, device, out.method, asked, outcomes);
        else
            for (std::size_t i = 0; i < queries.size(); ++i)
                outcomes[i] = decide_one(queries[i], out.method, asked);
        fastest = std::min(fastest, seconds_since(pass));
    } while (seconds_since(start) < 0.02);
    out.verdicts.clear();
    for (const outcome o : outcomes) out.verdicts.push_back(o != outcome::separate);
    out.ns_per_query = fastest * 1e9 / static_cast<double>(queries.size());
    if (asked.times) out.times = find_times(queries, device, asked);
}

result decide_file(const io::query_file& queries, const std::string& file, ccd::method method,
                   const device_choice& device, const time_question& asked) {
    result out;
    out.file = file;
    out.kind = queries.kind();
    out.method = method;
    std::visit([&](const auto& all) { decide_all(all, device, asked, out); }, queries.queries);
    if (queries.truth && !asked.is_another()) {
        std::size_t positives = 0, negatives = 0;
        for (std::size_t i = 0; i < out.verdicts.size(); ++i) {
            if (out.verdicts[i] && !(*queries.truth)[i]) ++positives;
            if (!out.verdicts[i] && (*queries.truth)[i]) ++negatives;
        }
        out.false_positives = positives;
        out.false_negatives = negatives;
    }
    return out;
}

std::string text_of_results(const std::vector<result>& results) {
    const auto or_dash = [](const std::optional<std::size_t>& count) {
        return count ? std::to_string(*count) : std::string("-");
    };
    table rows = {{"file", "kind", "method", "queries", "collisions", "FP", "FN", "ns/query"}};
    for (const result& r : results) {
        char ns[32];
        std::snprintf(ns, sizeof ns, "%.1f", r.ns_per_query);
        rows.push_back({r.file, std::string(short_name(r.kind)), std::string(info(r.method).name),
                        std::to_string(r.verdicts.size()), std::to_string(r.collisions()),
                        or_dash(r.false_positives), or_dash(r.false_negatives), ns});
    }
    return text_of(rows, 3);
}

std::string json_of(const std::vector<result>& results) {
    const auto or_null = [](const std::optional<std::size_t>& count) {
        return count ? nlohmann::ordered_json(*count) : nlohmann::ordered_json(nullptr);
    };
    auto array = nlohmann::ordered_json::array();
    for (const result& r : results) {
        array.push_back({{"file", r.file},
                         {"kind", std::string(short_name(r.kind))},
                         {"method", info(r.method).name},
                         {"queries", r.verdicts.size()},
                         {"collisions", r.collisions()},
                         {"false_positives", or_null(r.false_positives)},
                         {"false_negatives", or_null(r.false_negatives)},
                         {"ns_per_query", r.ns_per_query}});
    }
    // A path need not be UTF-8; the default would throw on such a one.
    return array.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

class query final : public command {
  public:
    explicit query(CLI::App& program) : command(program, "query", "Decide stored queries") {
        line_
            .add_option(
                "FILE", files_,
                "CSV, 8 rows per query: v f0 f1 f2 (or a0 a1 b0 b1) at t = 0, then at t = 1; a row "
                "is\n"
                "xnum,xden,ynum,yden,znum,zden or x,y,z, then optionally the truth, 0 or 1;\n"
                "-: standard input")
            ->required()
            ->transform(errbound::support::input_named);
        line_
            .add_option("--kind", kind_,
                        "Kind of query; else the path says (vertex-face or vf, edge-edge or ee)")
            ->check(CLI::IsMember(io::kind_names()));
        line_.add_flag(
            "--round", round_,
            "Round rationals and hexadecimal floats that no double equals, instead of refusing\n"
            "them (decimals always mean the nearest double)");
        line_
            .add_option("--verdicts", verdicts_,
                        "Write 0 or 1 per query (one method, one file); -: standard output")
            ->type_name("OUT");
        line_
            .add_option(
                "--toi", toi_,
                "Write low,high per query, between which the first contact is (hexadecimal\n"
                "floats; both 0 at the start, equal where the time is a double), or - where\n"
                "there is none (method exact, one file); -: standard output")
            ->type_name("OUT");
        line_.add_option("--json", json_, "Write the table as JSON; -: standard output")
            ->type_name("OUT");
    }

    exit_status run() override {
        const device_choice device = device_.chosen();
        const time_question asked = time_asked();
        const std::vector<ccd::method> methods = methods_on(device);
        for (const auto& [option, output] : {std::pair("--verdicts", &verdicts_), {"--toi", &toi_}})
            if (*output && (files_.size() != 1 || methods.size() != 1))
                throw usage_error(std::string(option) + ": found " + std::to_string(files_.size()) +
                                  " files and " + std::to_string(methods.size()) +
                                  " methods, expected one FILE and one --method");
        errbound::support::require_good_outputs({verdicts_, toi_, json_}, files_);

        // Nothing is printed or written unless all files are good.
        const std::vector<result> results = decide_files(methods, device, asked);
        std::vector<errbound::support::output> outputs;
        if (verdicts_) {
            std::string lines;
            for (const bool verdict : results.front().verdicts) lines += verdict ? "1\n" : "0\n";
            outputs.push_back({*verdicts_, lines});
        }
        if (toi_) {
            std::string lines;
            for (const first_time& time : results.front().times) lines += text_of_time(time) + '\n';
            outputs.push_back({*toi_, lines});
        }
        if (json_) outputs.push_back({*json_, json_of(results)});
        write_whole(outputs);
        errbound::support::stream_for_people({verdicts_, toi_, json_}) << text_of_results(results);
        return done;
    }

  private:
    time_question time_asked() const {
        constexpr double most = std::numeric_limits<double>::max();
        time_question asked{.times = toi_.has_value(), .t_max = t_max_.value(1, 1)};
        if (separation_.was_given()) asked.distance = separation_.value(0, most);
        return asked;
    }
    /// Whether something is asked that only `exact` answers.
    bool asks_exact_alone() const { return toi_ || t_max_.was_given() || separation_.was_given(); }

    std::vector<ccd::method> methods_on(const device_choice& device) const {
        if (asks_exact_alone()) {
            const bool exact_given =
                !methods_.was_given() || methods_.methods() == std::vector{method::exact};
            if (!exact_given)
                throw usage_error(
                    "--toi, --separation and --t-max: found another --method, expected exact");
            if (device.cuda && separation_.was_given())
                throw usage_error("--separation: found --device cuda, expected --device cpu");
            return {method::exact};
        }
        if (device.cuda && !methods_.was_given()) return methods_on_device();
        std::vector<ccd::method> methods = methods_.methods();
        if (device.cuda)
            for (const ccd::method m : methods) require_on_device(m);
        return methods;
    }

    std::vector<result> decide_files(const std::vector<ccd::method>& methods,
                                     const device_choice& device,
                                     const time_question& asked) const {
        std::vector<result> results;
        progress_line progress;
        for (std::size_t i = 0; i < files_.size(); ++i) {
            const std::string file = files_[i].string();
            progress.show(i, files_.size(), file);
            const io::query_file queries = io::read_queries(files_[i], find_kind(kind_), round_);
            for (const ccd::method m : methods)
                results.push_back(decide_file(queries, file, m, device, asked));
        }
        return results;
    }

    std::vector<std::filesystem::path> files_;
    std::string kind_;  ///< empty: from each path
    bool round_ = false;
    std::optional<std::filesystem::path> verdicts_, toi_, json_;
    number_option separation_{line_, "--separation",
                              "Ask for a distance of at most that, in place of contact"};
    number_option t_max_{line_, "--t-max", "Ask about times from 0 to that, in place of 1"};
    methods_option methods_{line_};
    device_options device_{line_};
};

}  // namespace

std::unique_ptr<command> query_command(CLI::App& program) {
    return std::make_unique<query>(program);
}

}  // namespace ccd::program
