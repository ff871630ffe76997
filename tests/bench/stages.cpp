#include <ccd/exact.hpp>
#include <ccd/explain.hpp>
#include <ccd/method.hpp>
#include <numeric>

#include "tests/bench/sections.hpp"

namespace bench {
namespace {

double total_seconds(const ccd::stage_report& r) {
    return std::accumulate(r.stages.begin(), r.stages.end(), 0.0,
                           [](double sum, const auto& e) { return sum + e.seconds; });
}

/// The fastest of several runs.
template <class Query>
ccd::stage_report quickest_report(const query_set<Query>& set, int repeats) {
    std::vector<ccd::outcome> answers(set.size());
    ccd::stage_report best;
    for (int i = 0; i < repeats; ++i) {
        const ccd::stage_report r = set.decide_batch(0, answers, {.threads = 1, .explain = true});
        if (i == 0 || total_seconds(r) < total_seconds(best)) best = r;
    }
    return best;
}

template <class Query>
void add_stage_rows(const query_set<Query>& set, const options& o, rows& table) {
    if (set.size() == 0) return;
    const ccd::stage_report r = quickest_report(set, o.repeats());
    const auto all = static_cast<double>(set.size());
    for (const ccd::stage_info& stage : ccd::exact_stages) {
        const auto& e = r[stage.stage];
        const auto entered = static_cast<double>(e.entered);
        table.push_back({{"kind", short_name(ccd::kind_of<Query>)},
                         {"stage", stage.name},
                         {"entered", e.entered},
                         {"skipped", e.skipped},
                         {"entered_%", 100 * entered / all},
                         {"separate", e.separate},
                         {"collide", e.collides},
                         {"time_%", 100 * e.seconds / total_seconds(r)},
                         {"ns_per_entered", e.entered > 0 ? row(1e9 * e.seconds / entered) : row()},
                         {"ns_per_query", 1e9 * e.seconds / all}});
    }
}

template <class Query>
double seconds_of(const Query& q) {
    const clock::time_point start = clock::now();
    keep(ccd::decide(ccd::method::exact, q));
    return seconds_since(start);
}

template <class Query>
double least_seconds_of(const Query& q, int repeats) {
    double least = seconds_of(q);
    for (int i = 1; i < repeats; ++i) least = std::min(least, seconds_of(q));
    return least;
}

/// The seconds of the slowest query. One pass over all queries finds suspects; each counts with its
/// shortest time.
template <class Query>
double slowest_seconds(const query_set<Query>& set, int repeats) {
    constexpr std::size_t suspects = 2000;
    std::vector<std::pair<double, std::size_t>> times;
    times.reserve(set.size());
    for (std::size_t i = 0; i < set.size(); ++i) times.emplace_back(seconds_of(set[i]), i);
    const auto end = times.begin() + static_cast<std::ptrdiff_t>(std::min(suspects, times.size()));
    std::ranges::partial_sort(times, end, std::greater<>());
    double slowest = 0;
    for (auto t = times.begin(); t != end; ++t) {
        slowest = std::max(slowest, least_seconds_of(set[t->second], repeats));
    }
    return slowest;
}

template <class Query>
void add_slow_row(const query_set<Query>& set, const options& o, rows& table) {
    if (set.size() == 0) return;
    std::vector<Query> last;
    for (std::size_t i = 0; i < set.size(); ++i) {
        ccd::stage_report r;
        ccd::decide_exact(set[i], &r);
        if (r[ccd::stage::integers].entered > 0) last.push_back(set[i]);
    }
    double sum = 0;
    for (const Query& q : last) sum += least_seconds_of(q, o.repeats());
    table.push_back({{"kind", short_name(ccd::kind_of<Query>)},
                     {"queries", set.size()},
                     {"reach_integers", last.size()},
                     {"their_mean_us",
                      last.empty() ? row() : row(1e6 * sum / static_cast<double>(last.size()))},
                     {"slowest_us", 1e6 * slowest_seconds(set, o.repeats())}});
}

}  // namespace

void stages(const scene& s, const options& o, report& out) {
    rows of_stages, slow;
    s.queries.for_each([&](const auto& known) {
        const auto set = o.sampled(known.queries);
        add_stage_rows(set, o, of_stages);
        add_slow_row(set, o, slow);
    });
    out.table("stages", {{"scene", s.name}}, s.name + ": stages of exact, in a batch on one thread",
              of_stages);
    out.table("slow queries", {{"scene", s.name}},
              s.name +
                  ": exact one by one, each query at its quickest (the clock's own cost, some "
                  "20 ns, included)",
              slow);
}

}  // namespace bench
