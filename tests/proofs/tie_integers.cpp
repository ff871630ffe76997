// Decisions in integers, of fixed width and to the end, against what the proofs' definitions decide
// of the same queries (proofs/tie_integers.ml).
#include <ccd/query.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ccd/exact/axis_units.hpp"
#include "ccd/exact/close_contact.hpp"
#include "ccd/exact/integer_decision.hpp"
#include "ccd/exact/integers.hpp"
#include "tests/proofs/table.hpp"
#include "tests/proofs/whole_query.hpp"

namespace {

using ccd::detail::decide_in_words;
using ccd::detail::extent_limit;
using ccd::detail::integer_units;
using tie::drawn_query;
using tie::hash;

void put(hash& h, ccd::outcome o) {
    h.put(static_cast<std::uint32_t>(o));
}

/// In as many words as it takes.
template <class Query>
ccd::outcome in_words(const Query& query) {
    const integer_units units(query);
    if (units.bits() <= extent_limit(1)) return decide_in_words<1>(query, units);
    if (units.bits() <= extent_limit(2)) return decide_in_words<2>(query, units);
    return decide_in_words<4>(query, units);
}
template <class Query>
void put_decision(hash& h, const Query& query) {
    h.put(static_cast<std::uint32_t>(integer_units(query).bits()));
    put(h, in_words(query));
    put(h, ccd::detail::decide_in_integers(query).outcome);
}
void put_decision(hash& h, const drawn_query& q) {
    if (q.edges)
        put_decision(h, q.as<ccd::edge_edge<double>>());
    else
        put_decision(h, q.as<ccd::vertex_face<double>>());
    put(h, in_words(ccd::vertex_edge<double>{q.moving(0), q.moving(1), q.moving(2)}));
    put(h, in_words(ccd::vertex_vertex<double>{q.moving(0), q.moving(1)}));
}

/// What is else asked only of few: where roots nearly coincide.
template <class Query>
void put_close(hash& h, const Query& query) {
    put(h, ccd::detail::decide_close<4>(forms_of(integer_units(query).converted<4>(query))));
}
void put_close(hash& h, const drawn_query& q) {
    if (q.edges)
        put_close(h, q.as<ccd::edge_edge<double>>());
    else
        put_close(h, q.as<ccd::vertex_face<double>>());
}

std::vector<tie::line> all_lines() {
    static std::vector<std::vector<drawn_query>> queries;
    tie::sequence numbers;
    std::vector<tie::line> lines;
    queries.reserve(20);
    for (int i = 0; i < 20; ++i) {
        auto& some = queries.emplace_back();
        for (int k = 0; k < 4000; ++k) some.push_back(tie::whole_query_maker(numbers).query());
        lines.push_back({"integers decide." + std::to_string(i), some.size(),
                         [&some](hash& h, std::uint64_t k) { put_decision(h, some[k]); }});
        lines.push_back({"integers close." + std::to_string(i), 1000,
                         [&some](hash& h, std::uint64_t k) { put_close(h, some[k]); }});
    }
    return lines;
}

}  // namespace

int main(int argc, char**) {
    return tie::compare(all_lines(), argc);
}
