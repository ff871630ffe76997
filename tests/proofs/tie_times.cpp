// First contacts in integers of fixed width, and the doubles between which they are, of the whole
// step and of parts, against what the proofs' definitions tell of the same queries
// (proofs/tie_times.ml).
#include <bit>
#include <ccd/methods/forms.hpp>
#include <ccd/query.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <errbound/bernstein.hpp>
#include <errbound/integers/fixed_integer.hpp>
#include <errbound/sign.hpp>
#include <string>
#include <vector>

#include "ccd/contact/integer_times.hpp"
#include "ccd/contact/vertex_edge_time.hpp"
#include "ccd/exact/axis_units.hpp"
#include "ccd/exact/static_filter/subdivision.hpp"
#include "tests/proofs/table.hpp"
#include "tests/proofs/whole_query.hpp"

namespace {

using ccd::detail::first_contact_in_integers;
using tie::drawn_query;
using tie::hash;

void put(hash& h, const ccd::detail::found_time& found) {
    h.put(static_cast<std::uint32_t>(found.outcome));
    if (found.outcome != ccd::outcome::collides) return;
    h.put_both(std::bit_cast<std::uint64_t>(found.time.low));
    h.put_both(std::bit_cast<std::uint64_t>(found.time.high));
}
/// Of a part of the step where Y changes its sign, as if the filter had found contact in it: parts
/// and how Y bends there follow from the case's number.
template <class Query>
void put_part(hash& h, const Query& query, int k) {
    using errbound::sign_type;
    const int depth = k % 4, index = k / 4 % (1 << depth);
    const auto y = forms_of(ccd::detail::integer_units(query).template converted<4>(query)).y();
    const auto sign_at = [&](int i) {
        using number = errbound::integers::fixed_integer<1>;
        return sign_of(value_at(y, number((1 << depth) - i), number(i)));
    };
    const sign_type before = sign_at(index);
    if (before == sign_type::zero || sign_at(index + 1) != -before) return;
    const double start = before == sign_type::positive ? 1 : -1;
    ccd::static_filter::contact_part part{std::ldexp(index, -depth), std::ldexp(index + 1, -depth)};
    part.y.b = {start, k % 5 - 2.0, k % 7 - 3.0, -start};
    part.one_root = true;
    put(h, ccd::detail::root_in_integers(query, part));
}
template <class Query>
void put_times(hash& h, const Query& query, int k) {
    put_part(h, query, k);
    put(h, first_contact_in_integers(query));
}
void put_times(hash& h, const drawn_query& q, int k) {
    if (q.edges)
        put_times(h, q.as<ccd::edge_edge<double>>(), k);
    else
        put_times(h, q.as<ccd::vertex_face<double>>(), k);
    put(h,
        first_contact_in_integers(ccd::vertex_edge<double>{q.moving(0), q.moving(1), q.moving(2)}));
    put(h, first_contact_in_integers(ccd::vertex_vertex<double>{q.moving(0), q.moving(1)}));
}

std::vector<tie::line> all_lines() {
    static std::vector<std::vector<drawn_query>> queries;
    tie::sequence numbers;
    std::vector<tie::line> lines;
    queries.reserve(10);
    for (int i = 0; i < 10; ++i) {
        auto& some = queries.emplace_back();
        for (int k = 0; k < 1000; ++k) some.push_back(tie::whole_query_maker(numbers).query());
        lines.push_back(
            {"times first." + std::to_string(i), some.size(),
             [&some](hash& h, std::uint64_t k) { put_times(h, some[k], static_cast<int>(k)); }});
    }
    return lines;
}

}  // namespace

int main(int argc, char**) {
    return tie::compare(all_lines(), argc);
}
