#include <algorithm>
#include <ccd/batch.hpp>
#include <ccd/method.hpp>
#include <deque>
#include <stdexcept>

#include "tests/bench/sections.hpp"

namespace bench {
namespace {

struct contestant {
    std::string name;
    std::size_t queries;
    std::size_t collisions;  ///< or uncertain
};

// How many of the sample's queries one pass of a method takes on: a pass is to last some half a
// second at most, as a first look at a few tells.
template <class Query>
std::size_t affordable(ccd::method method, const std::vector<Query>& sample) {
    const std::size_t few = std::min<std::size_t>(1000, sample.size());
    const clock::time_point start = clock::now();
    for (std::size_t i = 0; i < few; ++i)
        keep(ccd::decide(method, sample[i * sample.size() / few]));
    const double in_time = 0.5 / seconds_since(start) * static_cast<double>(few);
    return in_time < static_cast<double>(sample.size())
               ? std::max(few, static_cast<std::size_t>(in_time))
               : sample.size();
}

template <class Query>
void add_rows(const scene& s, const query_set<Query>& all, const options& o,
              std::vector<std::vector<cell>>& rows) {
    if (all.size() == 0) return;
    const std::vector<Query> sample = all.at_most(o.max_queries()).all_stored();
    const query_set<Query> batch = o.quick ? all.at_most(5 * o.max_queries()) : all;
    std::vector<ccd::outcome> answers(batch.size());

    std::vector<contestant> contestants;
    std::vector<std::function<void()>> passes;
    std::deque<std::vector<Query>> parts;  // of the sample, for slow methods
    std::size_t tight = 0;
    for (const ccd::method_info& m : ccd::methods()) {
        if (m.method == ccd::method::tight) tight = contestants.size();
        const std::size_t size = affordable(m.method, sample);
        const std::vector<Query>& queries =
            size == sample.size() ? sample : parts.emplace_back(all.resized(size).all_stored());
        const auto collisions = std::ranges::count_if(
            queries, [&m](const Query& q) { return ccd::may_collide(ccd::decide(m.method, q)); });
        contestants.push_back(
            {std::string(m.name), queries.size(), static_cast<std::size_t>(collisions)});
        passes.push_back([&queries, method = m.method] {
            for (const Query& q : queries) keep(ccd::decide(method, q));
        });
    }
    const auto add_batch = [&](ccd::instruction_set set, int threads, const std::string& how) {
        const auto pass = [&batch, &answers, set, threads] {
            batch.decide_batch(0, answers, {.threads = threads, .set = set});
        };
        const auto previous = answers;
        pass();
        if (contestants.size() > std::size(ccd::methods()) && answers != previous)
            throw std::runtime_error(s.name + ": answers differ on " + how);
        contestants.push_back(
            {"exact, " + how, batch.size(),
             static_cast<std::size_t>(std::ranges::count(answers, ccd::outcome::collides))});
        passes.push_back(pass);
    };
    for (const ccd::instruction_set set : ccd::instruction_sets()) {
        add_batch(set, 1, "batch on " + std::string(ccd::name(set)));
    }
    // What batches answered is what the queries get one by one.
    for (std::size_t i = 0; i < batch.size(); i += 1 + batch.size() / o.max_queries()) {
        if (ccd::decide(ccd::method::exact, batch[i]).outcome != answers[i])
            throw std::runtime_error(s.name + ": batches and one by one differ");
    }
    const ccd::instruction_set best = ccd::instruction_sets().back();
    add_batch(best, 0, "batch on " + std::string(ccd::name(best)) + ", all threads");

    // The same sample as one by one, stored: 192 bytes a query.
    std::vector<ccd::outcome> of_sample(sample.size());
    passes.push_back(
        [&sample, &of_sample] { ccd::decide_batch(std::span<const Query>(sample), of_sample); });
    passes.back()();
    contestants.push_back(
        {"exact, batch on " + std::string(ccd::name(best)) + ", stored queries", sample.size(),
         static_cast<std::size_t>(std::ranges::count(of_sample, ccd::outcome::collides))});

    const std::vector<timing> timings = race(passes, o.repeats());
    const auto ns = [&](std::size_t i, double seconds) {
        return 1e9 * seconds / static_cast<double>(contestants[i].queries);
    };
    for (std::size_t i = 0; i < contestants.size(); ++i) {
        rows.push_back({word(short_name(ccd::kind_of<Query>)), word(contestants[i].name),
                        count(contestants[i].queries), count(contestants[i].collisions),
                        number(ns(i, timings[i].minimum), 1), number(ns(i, timings[i].median), 1),
                        number(ns(tight, timings[tight].minimum) / ns(i, timings[i].minimum), 2)});
    }
}

}  // namespace

void methods(const scene& s, const options& o, report& out) {
    std::vector<std::vector<cell>> rows;
    add_rows(s, s.queries.vertex_face, o, rows);
    add_rows(s, s.queries.edge_edge, o, rows);
    out.table(
        "methods", {{"scene", s.name}},
        s.name +
            ": ns per query, one by one (on an even sample where there are fewer) and "
            "in batches, on one thread unless said; last, how many times as fast as tight one "
            "by one",
        {{"kind", "kind", true},
         {"contestant", "method", true},
         {"queries", "queries"},
         {"collisions", "collide"},
         {"ns_min", "min ns"},
         {"ns_median", "median ns"},
         {"times_tight", "speed-up over tight"}},
        rows);
}

}  // namespace bench
