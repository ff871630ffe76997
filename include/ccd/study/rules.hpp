// Compares custom bound rules in collision detection: their decisions and their cost, in double and
// in float.
//
//   struct mine : errbound::derived_rule<mine, errbound::tight> { ... };
//   int main(int argc, char** argv) {
//       return ccd::study::rules_main<mine, errbound::tight>(argc, argv);
//   }
//   ./mine --out out/mine vertex-face/*.csv     # --out: also as CSV, JSON and a picture
//
// The method is BSC (ccd/methods/bsc.hpp), whose scalar is a number tracked under the rule. Needs
// the targets errbound::ccd and, for rules_main, errbound::ccd_io.
#pragma once

#include <algorithm>
#include <ccd/exact.hpp>
#include <ccd/io/query_file.hpp>
#include <ccd/kind.hpp>
#include <ccd/methods/bsc.hpp>
#include <ccd/methods/single_precision.hpp>
#include <ccd/verdict.hpp>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <errbound/support/error.hpp>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace ccd::study {

/// The decisions under one rule, and their cost.
struct rule_row {
    std::string rule, number;  ///< number: "double" or "float"
    bool promises = false;     ///< promises_bound of the rule
    std::size_t queries = 0;
    std::size_t collisions = 0;  ///< reported: all that is not certainly separate
    std::size_t false_positives = 0, false_negatives = 0, uncertain = 0;
    std::size_t wrong = 0;    ///< `separate` or `collides` that is not the truth
    double ns_per_query = 0;  ///< on one thread, the least of the passes

    /// True if the rule promises that certain signs are right, and some were not.
    bool is_broken() const { return promises && wrong > 0; }
};

namespace detail {

template <class Query>
struct rule_run {
    rule_row row;
    void (*decide_all)(std::span<const Query>, std::span<outcome>);
    std::vector<outcome> answers;
};

template <class Rule, class T, class Query>
void decide_all(std::span<const Query> queries, std::span<outcome> answers) {
    for (std::size_t i = 0; i < queries.size(); ++i)
        if constexpr (std::is_same_v<T, float>)
            answers[i] = decide_bsc_in_single_precision<Rule>(queries[i]).outcome;
        else
            answers[i] = decide_bsc<Rule>(queries[i]).outcome;
}

template <class Rule, class Query>
void add_runs(std::vector<rule_run<Query>>& runs, std::size_t queries) {
    const bool promises = errbound::promises_bound<Rule>;
    runs.push_back({{.rule = Rule::name, .number = "double", .promises = promises},
                    decide_all<Rule, double, Query>,
                    std::vector<outcome>(queries)});
    runs.push_back({{.rule = Rule::name, .number = "float", .promises = promises},
                    decide_all<Rule, float, Query>,
                    std::vector<outcome>(queries)});
}

inline void count(rule_row& row, outcome said, bool truth) {
    const bool reported = said != outcome::separate;
    ++row.queries;
    row.collisions += reported;
    row.uncertain += said == outcome::uncertain;
    row.false_positives += reported && !truth;
    row.false_negatives += !reported && truth;
    row.wrong += said != outcome::uncertain && reported != truth;
}

}  // namespace detail

/// Decides the queries under each rule in double and in float, where the error of the conversion is
/// the inputs' bound. truth[i] is true if query i collides. Rules alternate, `passes` >= 1 times,
/// so that a slower machine affects all of them. Allocates an answer for each query, rule and
/// number type.
template <class... Rules, class Query>
std::vector<rule_row> compare_rules(const std::vector<Query>& queries,
                                    const std::vector<bool>& truth, int passes = 5) {
    using clock = std::chrono::steady_clock;
    std::vector<detail::rule_run<Query>> runs;
    (detail::add_runs<Rules>(runs, queries.size()), ...);
    for (detail::rule_run<Query>& run : runs)
        run.row.ns_per_query = std::numeric_limits<double>::infinity();
    for (int pass = 0; pass < passes; ++pass)
        for (detail::rule_run<Query>& run : runs) {
            const clock::time_point start = clock::now();
            run.decide_all(queries, run.answers);
            const std::chrono::duration<double, std::nano> taken = clock::now() - start;
            run.row.ns_per_query = (std::min)(
                run.row.ns_per_query,
                taken.count() / static_cast<double>(std::max<std::size_t>(1, queries.size())));
        }
    std::vector<rule_row> rows;
    for (detail::rule_run<Query>& run : runs) {
        for (std::size_t i = 0; i < queries.size(); ++i)
            detail::count(run.row, run.answers[i], truth[i]);
        rows.push_back(std::move(run.row));
    }
    return rows;
}

struct compared_file {
    std::string name;
    ccd::kind kind{};
    std::size_t colliding = 0;  ///< number of the file's queries that collide
    std::vector<rule_row> rows;
};

/// Makes the folder, writes methods.csv (with the columns of `ccd report`), methods.json and
/// plot.py, and runs plot.py, which draws pareto-queries.png and .svg: errors against run time.
/// Returns false if there are no pictures: no Python, or one without matplotlib. Throws
/// errbound::support::file_error. Needs the target errbound::ccd_io.
bool write_comparison(const std::filesystem::path& folder, const std::vector<compared_file>& files);

namespace detail {

/// Compares the rules on a file. `exact` gives the truth if the file has none. Throws
/// errbound::support::file_error.
template <class... Rules>
compared_file compare_on_file(const std::string& path) {
    const io::query_file file = io::read_queries(path, std::nullopt, false);
    return std::visit(
        [&](const auto& queries) {
            std::vector<bool> truth = file.truth.value_or(std::vector<bool>());
            if (!file.truth)
                for (const auto& query : queries)
                    truth.push_back(decide_exact(query).outcome == outcome::collides);
            const auto colliding = std::count(truth.begin(), truth.end(), true);
            return compared_file{path, file.kind(), static_cast<std::size_t>(colliding),
                                 compare_rules<Rules...>(queries, truth)};
        },
        file.queries);
}

inline void print(const compared_file& file) {
    for (const rule_row& r : file.rows)
        std::printf("%-12s %-7s %9zu %10zu %9zu %9zu %9zu %9zu %9.1f  %s\n", r.rule.c_str(),
                    r.number.c_str(), r.queries, r.collisions, r.false_positives, r.false_negatives,
                    r.uncertain, r.wrong, r.ns_per_query, file.name.c_str());
}

}  // namespace detail

/// A main program that compares the rules on files of queries and prints a row for each file, rule
/// and number type. The path gives their kind; `exact` gives the truth if a file has none. With
/// `--out FOLDER` before the files it also calls write_comparison. Returns 0, 2 without files, or 1
/// after bad input or wrong certain answers under a rule with a true bound.
template <class... Rules>
int rules_main(int argc, const char* const* argv) {
    const bool writes = argc > 2 && std::string_view(argv[1]) == "--out";
    const int first = writes ? 3 : 1;
    if (argc <= first) {
        std::fprintf(
            stderr,
            "usage: %s [--out FOLDER] FILE...   stored queries, as ccd query takes them, in\n"
            "folders called vertex-face and edge-edge, or with names that end in vf or ee\n",
            argc > 0 ? argv[0] : "rules");
        return 2;
    }
    std::printf("%-12s %-7s %9s %10s %9s %9s %9s %9s %9s  %s\n", "rule", "number", "queries",
                "collisions", "FP", "FN", "uncertain", "wrong", "ns/query", "file");
    bool broken = false;
    try {
        std::vector<compared_file> files;
        for (int i = first; i < argc; ++i) {
            files.push_back(detail::compare_on_file<Rules...>(argv[i]));
            detail::print(files.back());
            for (const rule_row& r : files.back().rows) broken = broken || r.is_broken();
        }
        if (writes && !write_comparison(argv[2], files))
            std::fprintf(stderr, "%s: no pictures, since no Python with matplotlib was found\n",
                         argv[2]);
    } catch (const errbound::support::file_error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return broken ? 1 : 0;
}

}  // namespace ccd::study
