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
void add_stage_rows(const query_set<Query>& set, const options& o,
                    std::vector<std::vector<cell>>& rows) {
    if (set.size() == 0) return;
    const ccd::stage_report r = quickest_report(set, o.repeats());
    const auto all = static_cast<double>(set.size());
    for (const ccd::stage_info& stage : ccd::exact_stages) {
        const auto& e = r[stage.stage];
        const auto entered = static_cast<double>(e.entered);
        rows.push_back({word(short_name(ccd::kind_of<Query>)), word(stage.name), count(e.entered),
                        count(e.left_out), percent(entered / all), count(e.separate),
                        count(e.collides), percent(e.seconds / total_seconds(r)),
                        e.entered > 0 ? number(1e9 * e.seconds / entered, 1) : none(),
                        number(1e9 * e.seconds / all, 2)});
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
void add_slow_row(const query_set<Query>& set, const options& o,
                  std::vector<std::vector<cell>>& rows) {
    if (set.size() == 0) return;
    std::vector<Query> last;
    for (std::size_t i = 0; i < set.size(); ++i) {
        ccd::stage_report r;
        ccd::decide_exact(set[i], &r);
        if (r[ccd::stage::integers].entered > 0) last.push_back(set[i]);
    }
    double sum = 0;
    for (const Query& q : last) sum += least_seconds_of(q, o.repeats());
    rows.push_back({word(short_name(ccd::kind_of<Query>)), count(set.size()), count(last.size()),
                    last.empty() ? none() : number(1e6 * sum / static_cast<double>(last.size()), 2),
                    number(1e6 * slowest_seconds(set, o.repeats()), 2)});
}

}  // namespace

void stages(const scene& s, const options& o, report& out) {
    // Quick runs sample the queries. Others take all: the slowest query may be the only one of its
    // sort.
    const std::size_t most =
        o.quick ? o.max_queries() : s.queries.vertex_face.size() + s.queries.edge_edge.size();
    const auto vf = s.queries.vertex_face.at_most(most);
    const auto ee = s.queries.edge_edge.at_most(most);
    std::vector<std::vector<cell>> rows;
    add_stage_rows(vf, o, rows);
    add_stage_rows(ee, o, rows);
    out.table("stages", {{"scene", s.name}}, s.name + ": stages of exact, in a batch on one thread",
              {{"kind", "kind", true},
               {"stage", "stage", true},
               {"entered", "entered"},
               {"skipped", "skipped"},
               {"entered_share", "of all"},
               {"separate", "separate"},
               {"collides", "collide"},
               {"time_share", "share of time"},
               {"ns_per_entered", "ns per entered"},
               {"ns_per_query", "ns per query"}},
              rows);
    rows.clear();
    add_slow_row(vf, o, rows);
    add_slow_row(ee, o, rows);
    out.table("slow queries", {{"scene", s.name}},
              s.name +
                  ": exact one by one, each query at its quickest (the clock's own cost, some "
                  "20 ns, included)",
              {{"kind", "kind", true},
               {"queries", "queries"},
               {"reach_integers", "reach integers"},
               {"integers_us_mean", "their mean us"},
               {"slowest_us", "slowest us"}},
              rows);
}

}  // namespace bench
