#include <algorithm>
#include <array>
#include <bit>
#include <ccd/batch.hpp>
#include <ccd/exact.hpp>
#include <ccd/method.hpp>
#include <ccd/step.hpp>
#include <cstring>

#include "ccd/report/measuring/timing.hpp"
#include "tests/bench/worst_cases/subjects.hpp"

namespace worst_cases {
namespace {

using ccd::report::keep;

template <class Query>
Query query_of(const double* numbers) {
    std::array<double, sizeof(Query) / sizeof(double)> all;
    std::copy_n(numbers, all.size(), all.begin());
    return std::bit_cast<Query>(all);
}

template <class Query, class Ask>
subject of(const std::string& function, const Ask& ask, int calls = 1) {
    return {function + ", " + std::string(name(ccd::kind_of<Query>)),
            sizeof(Query) / sizeof(double),
            [ask](const double* numbers) { keep(ask(query_of<Query>(numbers))); }, calls};
}

template <class Query>
void add_exact(std::vector<subject>& all) {
    all.push_back(of<Query>("decide_exact", [](const Query& q) { return decide_exact(q); }));
    all.push_back(
        of<Query>("touches_at_start", [](const Query& q) { return touches_at_start(q); }));
    constexpr int copies = 256;
    all.push_back(of<Query>(
        "decide_batch",
        [](const Query& q) {
            return ccd::decide_batch(std::vector<Query>(copies, q), {.threads = 1});
        },
        copies));
}

template <class Query>
void add_methods(std::vector<subject>& all) {
    for (const ccd::method_info& m : ccd::methods())
        if (m.method != ccd::method::exact)
            all.push_back(of<Query>("decide by " + std::string(m.name),
                                    [of = m.method](const Query& q) { return decide(of, q); }));
}

/// A vertex and a face that do not belong together.
ccd::step_result step_of(const ccd::vertex_face<double>& q) {
    const ccd::mesh before{{q.v.t0, q.f0.t0, q.f1.t0, q.f2.t0}, {{1, 2, 3}}};
    const ccd::mesh after{{q.v.t1, q.f0.t1, q.f1.t1, q.f2.t1}, {{1, 2, 3}}};
    return ccd::step(before, after, {.threads = 1});
}

}  // namespace

std::vector<subject> of_queries() {
    std::vector<subject> all;
    add_exact<ccd::vertex_face<double>>(all);
    add_exact<ccd::edge_edge<double>>(all);
    add_exact<ccd::vertex_edge<double>>(all);
    add_exact<ccd::vertex_vertex<double>>(all);
    add_methods<ccd::vertex_face<double>>(all);
    add_methods<ccd::edge_edge<double>>(all);
    all.push_back(of<ccd::vertex_face<double>>("step of one pair", step_of));
    return all;
}

}  // namespace worst_cases
