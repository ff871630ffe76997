#include <algorithm>
#include <array>
#include <bit>
#include <boost/multiprecision/cpp_int.hpp>
#include <ccd/batch.hpp>
#include <ccd/exact.hpp>
#include <ccd/method.hpp>
#include <ccd/step.hpp>
#include <errbound/multiprecision.hpp>
#include <errbound/polynomial.hpp>
#include <errbound/predicates.hpp>
#include <limits>
#include <utility>

#include "ccd/lab/timing.hpp"
#include "tests/bench/worst_cases/worst_cases.hpp"

namespace worst_cases {
namespace {

using ccd::lab::keep;

template <class Query>
Query query_of(const double* numbers) {
    std::array<double, sizeof(Query) / sizeof(double)> all;
    std::copy_n(numbers, all.size(), all.begin());
    return std::bit_cast<Query>(all);
}

template <class Query, class Call>
subject of_query(const std::string& function, const Call& call, int calls = 1) {
    return {function + ", " + std::string(name(ccd::kind_of<Query>)),
            sizeof(Query) / sizeof(double),
            [call](const double* numbers) { keep(call(query_of<Query>(numbers))); }, calls};
}

template <class Query>
void add_exact(std::vector<subject>& all) {
    all.push_back(of_query<Query>("decide_exact", [](const Query& q) { return decide_exact(q); }));
    all.push_back(
        of_query<Query>("touches_at_start", [](const Query& q) { return touches_at_start(q); }));
    constexpr int copies = 256;
    all.push_back(of_query<Query>(
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
            all.push_back(
                of_query<Query>("decide by " + std::string(m.name),
                                [of = m.method](const Query& q) { return decide(of, q); }));
}

/// A step of one vertex and one face that share no vertex.
ccd::step_result step_of(const ccd::vertex_face<double>& q) {
    const ccd::mesh before{{q.v.t0, q.f0.t0, q.f1.t0, q.f2.t0}, {{1, 2, 3}}};
    const ccd::mesh after{{q.v.t1, q.f0.t1, q.f1.t1, q.f2.t1}, {{1, 2, 3}}};
    return ccd::step(before, after, {.threads = 1});
}

template <class Shape, class F, class Options>
subject of_predicate(std::string name,
                     const errbound::predicate_type<Shape, F, Options>& predicate) {
    const auto call = [predicate](const double* numbers) {
        [&]<std::size_t... K>(std::index_sequence<K...>) {
            keep(predicate((numbers + Shape::offset(K))...));
        }
        (std::make_index_sequence<Shape::count>());
    };
    return {std::move(name), Shape::size, call};
}

subject counting(std::size_t degree) {
    const auto call = [degree](const double* numbers) {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        const errbound::polynomial<double> p(std::vector<double>(numbers, numbers + degree + 1));
        keep(errbound::count_roots<boost::multiprecision::cpp_int>(p, -infinity, infinity));
    };
    return {"count_roots, degree " + std::to_string(degree), degree + 1, call};
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
    all.push_back(of_query<ccd::vertex_face<double>>("step of one pair", step_of));
    return all;
}

std::vector<subject> of_predicates() {
    return {of_predicate("orient2d", errbound::orient2d),
            of_predicate("orient3d", errbound::orient3d),
            of_predicate("incircle", errbound::incircle),
            of_predicate("insphere", errbound::insphere),
            of_predicate("power_incircle", errbound::power_incircle),
            of_predicate("power_insphere", errbound::power_insphere),
            of_predicate("compare_distances2d", errbound::compare_distances2d),
            of_predicate("compare_distances3d", errbound::compare_distances3d),
            of_predicate("segments_intersect3d", errbound::segments_intersect3d),
            of_predicate("segment_intersects_triangle", errbound::segment_intersects_triangle),
            of_predicate("orient2d_line_line", errbound::orient2d_line_line),
            of_predicate("orient3d_line_plane", errbound::orient3d_line_plane),
            of_predicate("compare_x_line_line", errbound::compare_x_line_line)};
}

std::vector<subject> of_roots() {
    return {counting(3), counting(8), counting(20)};
}

}  // namespace worst_cases
