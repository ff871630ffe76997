// Queries one by one: decisions, first times, contact data, distances; curves.
#include <array>
#include <ccd/contact.hpp>
#include <ccd/curves.hpp>
#include <ccd/exact.hpp>
#include <ccd/method.hpp>
#include <cmath>

#include "tests/everywhere/sections.hpp"

namespace everywhere {
namespace {

template <class Query>
constexpr bool is_stored =
    ccd::kind_of<Query> == ccd::kind::vertex_face || ccd::kind_of<Query> == ccd::kind::edge_edge;

template <class Query>
void record_times_of(recorder& to, const Query& query) {
    const ccd::first_time time = ccd::time_of_impact(query);
    to.add(ccd::contact_at(query, time));
    to.add(ccd::time_of_impact(query, 0.375));
    if (time.outcome == ccd::outcome::collides) return;
    for (const double d : {0x1p-40, 0.25, 3.0}) {
        const ccd::separation distance{d, std::ldexp(d, -60)};
        to.add(ccd::decide_within(query, distance));
        to.add(ccd::time_within(query, distance));
    }
}

/// Curves with three control points: both ends of one query's points, and the end of another's.
void record_curves(recorder& to) {
    for (const auto& f : query_families::families) {
        if (f.thinning > 1) continue;
        for (const ccd::kind which : {ccd::kind::vertex_face, ccd::kind::edge_edge}) {
            const auto p = query_families::make(f, which, 5, 0);
            const auto q = query_families::make(f, which, 5, 1);
            std::array<std::array<ccd::point<double>, 3>, 4> at;
            for (std::size_t i = 0; i < 4; ++i) at[i] = {p[i].t0, q[i].t0, p[i].t1};
            if (which == ccd::kind::vertex_face) {
                const ccd::vertex_face_curves query{at[0], at[1], at[2], at[3]};
                to.add(ccd::decide_exact(query));
                to.add(ccd::time_of_impact(query));
            } else {
                const ccd::edge_edge_curves query{at[0], at[1], at[2], at[3]};
                to.add(ccd::decide_exact(query));
                to.add(ccd::time_of_impact(query));
            }
            to.end_item("curves " + std::string(f.name));
        }
    }
}

}  // namespace

void record_decisions(recorder& to) {
    for_each_query(12, 1, [&]<class Query>(const Query& query, const std::string& name) {
        to.add(ccd::decide_exact(query));
        to.add(ccd::touches_at_start(query));
        if constexpr (is_stored<Query>)
            for (const auto& m : ccd::methods()) to.add(ccd::decide(m.method, query));
        to.end_item(name);
    });
}

void record_times(recorder& to) {
    for_each_query(4, 2, [&](const auto& query, const std::string& name) {
        record_times_of(to, query);
        to.end_item(name);
    });
    record_curves(to);
}

}  // namespace everywhere
