// First contacts in integers of fixed width, and the doubles between which they are, against what
// the proofs' definitions tell of the same queries (proofs/tie_times.ml).
#include <bit>
#include <ccd/query.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ccd/contact/integer_times.hpp"
#include "ccd/contact/vertex_edge_time.hpp"
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
void put_times(hash& h, const drawn_query& q) {
    put(h, q.edges ? first_contact_in_integers(q.as<ccd::edge_edge<double>>())
                   : first_contact_in_integers(q.as<ccd::vertex_face<double>>()));
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
        lines.push_back({"times first." + std::to_string(i), some.size(),
                         [&some](hash& h, std::uint64_t k) { put_times(h, some[k]); }});
    }
    return lines;
}

}  // namespace

int main(int argc, char**) {
    return tie::compare(all_lines(), argc);
}
