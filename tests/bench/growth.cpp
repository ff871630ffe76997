#include <ccd/batch.hpp>

#include "tests/bench/sections.hpp"

namespace bench {
namespace {

template <class Query>
void add_rows(const query_set<Query>& all, const options& o, std::vector<std::vector<cell>>& rows) {
    if (all.size() == 0) return;
    std::vector<std::size_t> sizes;
    const std::size_t most = o.quick ? 100'000 : 10'000'000;
    for (std::size_t n = 1000; n <= most; n *= 10) sizes.push_back(n);
    if (all.size() < most) sizes.push_back(all.size());
    std::ranges::sort(sizes);
    for (const std::size_t n : sizes) {
        const query_set<Query> set = all.resized(n);
        std::vector<ccd::outcome> answers(n);
        const auto timings = race({[&] { set.decide_batch(0, answers, {.threads = 1}); },
                                   [&] { set.decide_batch(0, answers, {.threads = 0}); }},
                                  o.repeats());
        const auto ns = [n](double seconds) { return 1e9 * seconds / static_cast<double>(n); };
        rows.push_back({word(short_name(ccd::kind_of<Query>)),
                        word(n == all.size()  ? "all"
                             : n < all.size() ? "even sample"
                                              : "over and over"),
                        count(n), number(ns(timings[0].minimum), 1),
                        number(ns(timings[0].median), 1), number(ns(timings[1].minimum), 1),
                        number(timings[0].minimum / timings[1].minimum, 2)});
    }
}

}  // namespace

void growth_with_queries(const scene& s, const options& o, report& out) {
    std::vector<std::vector<cell>> rows;
    add_rows(s.queries.vertex_face, o, rows);
    add_rows(s.queries.edge_edge, o, rows);
    out.table("growth", {{"scene", s.name}, {"with", "queries"}},
              s.name + ": batches of exact against the number of queries, ns per query",
              {{"kind", "kind", true},
               {"drawn", "drawn", true},
               {"queries", "queries"},
               {"ns_min", "min, 1 thread"},
               {"ns_median", "median, 1 thread"},
               {"ns_min_all_threads", "min, all threads"},
               {"speedup", "speed-up, all threads"}},
              rows);
}

}  // namespace bench
