#include <algorithm>
#include <ccd/batch.hpp>
#include <ccd/method.hpp>
#include <deque>
#include <stdexcept>

#include "tests/bench/sections.hpp"

namespace bench {
namespace {

/// The number of the sample's queries for one pass of a method. A pass takes at most half a second,
/// estimated from the first queries.
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

/// Rows of contestants, and their passes.
struct contestants {
    rows table = {};
    std::vector<std::function<void()>> passes = {};

    void add(const std::string& name, std::size_t queries, std::ptrdiff_t collide,
             const std::function<void()>& pass) {
        table.push_back({{"contestant", name}, {"queries", queries}, {"collide", collide}});
        passes.push_back(pass);
    }
    /// Runs the pass once for its answers.
    void add_exact(const std::string& how, const std::vector<ccd::outcome>& answers,
                   const std::function<void()>& pass) {
        pass();
        add("exact, batch on " + how, answers.size(),
            std::ranges::count(answers, ccd::outcome::collides), pass);
    }
};

/// Every method one by one, on `sample`. Slow methods get fewer queries, which are kept in `parts`.
/// Returns the index of tight.
template <class Query>
std::size_t add_methods(const query_set<Query>& all, const std::vector<Query>& sample,
                        std::deque<std::vector<Query>>& parts, contestants& to) {
    std::size_t tight = 0;
    for (const ccd::method_info& m : ccd::methods()) {
        if (m.method == ccd::method::tight) tight = to.table.size();
        const std::size_t size = affordable(m.method, sample);
        const std::vector<Query>& queries =
            size == sample.size() ? sample : parts.emplace_back(all.resized(size).all_stored());
        const auto collide = std::ranges::count_if(  // uncertain counts as a collision
            queries, [&m](const Query& q) { return ccd::may_collide(ccd::decide(m.method, q)); });
        to.add(std::string(m.name), queries.size(), collide, [&queries, method = m.method] {
            for (const Query& q : queries) keep(ccd::decide(method, q));
        });
    }
    return tight;
}

/// Races the contestants on a scene's queries of one kind: every method one by one, and batches.
template <class Query>
void add_rows(const query_set<Query>& all, const options& o, rows& table) {
    contestants found;
    const std::vector<Query> sample = all.at_most(o.max_queries()).all_stored();
    std::deque<std::vector<Query>> parts;
    const std::size_t tight = add_methods(all, sample, parts, found);

    const query_set<Query> batch = o.quick ? all.at_most(5 * o.max_queries()) : all;
    std::vector<ccd::outcome> right, answers(batch.size()), of_sample(sample.size());
    const auto add_batch = [&](const std::string& how, ccd::instruction_set set, int threads) {
        found.add_exact(how, answers, [&, set, threads] {
            batch.decide_batch(0, answers, {.threads = threads, .set = set});
        });
        if (right.empty()) right = answers;
        if (answers != right) throw std::runtime_error("answers differ: " + how);
    };
    const auto sets = ccd::instruction_sets();
    for (const ccd::instruction_set set : sets) add_batch(std::string(ccd::name(set)), set, 1);
    const std::string best(ccd::name(sets.back()));
    add_batch(best + ", all threads", sets.back(), 0);
    for (std::size_t i = 0; i < batch.size(); i += 1 + batch.size() / o.max_queries())
        if (ccd::decide(ccd::method::exact, batch[i]).outcome != right[i])
            throw std::runtime_error("batches and single calls disagree");
    found.add_exact(best + ", stored queries", of_sample,  // 192 bytes a query
                    [&] { ccd::decide_batch(sample, of_sample, {.threads = 1}); });

    const std::vector<timing> timings = race(found.passes, o.repeats());
    const auto ns = [&](std::size_t i) { return timings[i].ns(found.table[i]["queries"]); };
    for (std::size_t i = 0; i < timings.size(); ++i) {
        row& r = table.emplace_back(row{{"kind", short_name(ccd::kind_of<Query>)}});
        r.update(found.table[i]);
        r.update({{"ns_min", ns(i)},
                  {"ns_median", timings[i].median_ns(r["queries"])},
                  {"speed-up_over_tight", ns(tight) / ns(i)}});
    }
}

}  // namespace

void methods(const scene& s, const options& o, report& out) {
    rows all;
    s.queries.for_each([&](const auto& known) {
        if (known.queries.size() > 0) add_rows(known.queries, o, all);
    });
    out.table("methods", {{"scene", s.name}},
              s.name +
                  ": ns per query, one by one (on an even sample where there are fewer) and in "
                  "batches, on one thread by default; last, the speed-up over tight one by one",
              all);
}

}  // namespace bench
