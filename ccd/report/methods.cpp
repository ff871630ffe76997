// Errors and run time of the methods.
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include "ccd/batch/threads.hpp"
#include "ccd/report/measuring/statistics.hpp"
#include "ccd/report/report.hpp"
#include "ccd/report/sections.hpp"

namespace ccd::report {
namespace {

struct error_counts {
    std::size_t collisions = 0, uncertain = 0, false_positives = 0, false_negatives = 0;

    void add(outcome said, bool truth) {
        const bool reported = said != outcome::separate;
        collisions += reported;
        uncertain += said == outcome::uncertain;
        false_positives += reported && !truth;
        false_negatives += !reported && truth;
    }
    friend error_counts operator+(error_counts a, const error_counts& b) {
        a.collisions += b.collisions;
        a.uncertain += b.uncertain;
        a.false_positives += b.false_positives;
        a.false_negatives += b.false_negatives;
        return a;
    }
};

/// Of the queries from `first` to `last`, on the threads of the arena that this runs in.
template <class Query>
error_counts count_block(const queries_with_truth<Query>& data, ccd::method method,
                         std::size_t first, std::size_t last) {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(first, last, 256), error_counts(),
        [&](const tbb::blocked_range<std::size_t>& range, error_counts counts) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                counts.add(decide(method, data.queries[i]).outcome, data.collides[i] != 0);
            }
            return counts;
        },
        std::plus<>());
}

}  // namespace

template <class Query>
rows count_errors(const queries_with_truth<Query>& data, std::string_view method, int threads,
                  const progress& show) {
    error_counts counts;
    const std::size_t n = data.queries.size();
    if (method == batch_name) {
        std::vector<outcome> answers(n);
        data.queries.decide_batch(0, answers, {.threads = threads});
        for (std::size_t i = 0; i < n; ++i) counts.add(answers[i], data.collides[i] != 0);
    } else {
        constexpr std::size_t block = 1 << 14;  // small enough for progress to be seen
        detail::on_threads(threads, [&] {
            for (std::size_t first = 0; first < n; first += block) {
                counts = counts +
                         count_block(data, *find_method(method), first, std::min(first + block, n));
                show(static_cast<double>(first) / static_cast<double>(n));
            }
        });
    }
    return {{{"method", method},
             {"queries", n},
             {"colliding", data.colliding},
             {"collisions", counts.collisions},
             {"false_positives", counts.false_positives},
             {"false_negatives", counts.false_negatives},
             {"uncertain", counts.uncertain}}};
}

template <class Query>
rows race_methods(const queries_with_truth<Query>& data, const std::vector<std::string>& methods,
                  const sample_sizes& size, const progress& show) {
    const query_set<Query> sample = data.queries.at_most(size.speed);
    const std::vector<Query> queries = sample.all_stored();
    std::vector<outcome> answers(sample.size());
    std::vector<std::function<void()>> passes;
    for (const std::string& name : methods) {
        if (name == batch_name) {
            passes.push_back([&] { sample.decide_batch(0, answers, {.threads = 1}); });
        } else {
            passes.push_back([&queries, method = *find_method(name)] {
                for (const Query& q : queries) keep(decide(method, q));
            });
        }
    }
    const std::vector<timing> timings = race(passes, size.repeats, show);
    rows result;
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const auto ns = [&](double seconds) {
            return 1e9 * seconds / static_cast<double>(queries.size());
        };
        result.push_back({{"method", methods[i]},
                          {"timed", queries.size()},
                          {"ns_min", ns(timings[i].minimum)},
                          {"ns_median", ns(timings[i].median)}});
    }
    return result;
}

template <class Query>
rows time_queries(const queries_with_truth<Query>& data, const std::vector<std::string>& methods,
                  const sample_sizes& size, const progress& show) {
    const std::vector<Query> queries = data.queries.at_most(size.times).all_stored();
    // Of several timings of a query the least: an interrupt does not pose as a slow query.
    std::vector<std::vector<double>> least(
        methods.size(),
        std::vector<double>(queries.size(), std::numeric_limits<double>::infinity()));
    const double overhead = clock_overhead();
    for (int repeat = 0; repeat < size.repeats; ++repeat) {
        for (std::size_t m = 0; m < methods.size(); ++m) {
            const ccd::method method = *find_method(methods[m]);
            for (std::size_t i = 0; i < queries.size(); ++i) {
                const clock::time_point start = clock::now();
                keep(decide(method, queries[i]));
                least[m][i] = std::min(least[m][i], seconds_since(start));
            }
            show((repeat + static_cast<double>(m) / static_cast<double>(methods.size())) /
                 size.repeats);
        }
    }
    rows result;
    for (std::size_t m = 0; m < methods.size(); ++m) {
        for (double& s : least[m]) s = 1e9 * std::max(s - overhead, 0.0);
        std::ranges::sort(least[m]);
        const auto ns = [&](double p) { return quantile(least[m], p); };
        result.push_back({{"method", methods[m]},
                          {"timed", queries.size()},
                          {"ns_median", ns(0.5)},
                          {"ns_90", ns(0.9)},
                          {"ns_99", ns(0.99)},
                          {"ns_99_9", ns(0.999)},
                          {"ns_worst", ns(1)},
                          {"clock_ns", 1e9 * overhead}});
    }
    return result;
}

template rows count_errors(const queries_with_truth<vertex_face<double>>&, std::string_view, int,
                           const progress&);
template rows count_errors(const queries_with_truth<edge_edge<double>>&, std::string_view, int,
                           const progress&);
template rows race_methods(const queries_with_truth<vertex_face<double>>&,
                           const std::vector<std::string>&, const sample_sizes&, const progress&);
template rows race_methods(const queries_with_truth<edge_edge<double>>&,
                           const std::vector<std::string>&, const sample_sizes&, const progress&);
template rows time_queries(const queries_with_truth<vertex_face<double>>&,
                           const std::vector<std::string>&, const sample_sizes&, const progress&);
template rows time_queries(const queries_with_truth<edge_edge<double>>&,
                           const std::vector<std::string>&, const sample_sizes&, const progress&);

}  // namespace ccd::report
