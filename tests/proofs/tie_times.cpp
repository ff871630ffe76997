// Compares first contacts in integers of fixed width, and the doubles around them, with the proofs'
// definitions on the same queries (proofs/tie/tie_times.ml). It compares the whole step and
// subintervals.
#include <algorithm>
#include <array>
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
#include "ccd/contact/time_bracket.hpp"
#include "ccd/contact/vertex_edge_time.hpp"
#include "ccd/exact/axis_units.hpp"
#include "ccd/exact/integer_decision.hpp"
#include "ccd/exact/static_filter/subdivision.hpp"
#include "tests/proofs/table.hpp"
#include "tests/proofs/whole_forms.hpp"
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
/// The root in a subinterval where Y changes its sign, as if the filter had found contact in it.
/// The case's index determines the subinterval and the shape of Y.
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
    ccd::static_filter::contact_interval part{std::ldexp(index, -depth),
                                              std::ldexp(index + 1, -depth)};
    part.y.b = {start, k % 5 - 2.0, k % 7 - 3.0, -start};
    part.one_root = true;
    put(h, ccd::detail::root_in_integers(query, part));
}
template <class Query>
void put_times(hash& h, const Query& query, int k) {
    put_part(h, query, k);
    put(h, first_contact_in_integers(query));
}
void put_smaller(hash& h, const drawn_query& q) {
    tie::with_smaller_queries(
        q, [&h](const auto& query) { put(h, first_contact_in_integers(query)); });
}
void put_times(hash& h, const drawn_query& q, int k) {
    tie::with_query(q, [&](const auto& query) { put_times(h, query, k); });
    put_smaller(h, q);
}

/// For all extents.
template <class Query>
void put_wide(hash& h, const Query& query) {
    if (ccd::detail::integer_units(query).bits() <= ccd::detail::extent_limit(2)) {
        put_part(h, query, 0);
    } else {
        ccd::static_filter::contact_interval part{0, 1};
        part.y.b = {1, 0, 0, -1};
        part.one_root = true;
        put(h, ccd::detail::root_in_integers(query, part));
    }
    put(h, first_contact_in_integers(query));
}
void put_wide(hash& h, const drawn_query& q) {
    if (!std::all_of(q.x.begin(), q.x.end(), [](double x) { return std::isfinite(x); })) return;
    tie::with_query(q, [&h](const auto& query) { put_wide(h, query); });
    put_smaller(h, q);
}

/// For queries that fit in doubles: points relative to one of them.
void put_of_forms(hash& h, const tie::drawn_forms& f, int k) {
    if (f.bits() > 50) return;
    drawn_query q{f.edges, {}, {}, {}};
    const auto place = [&](std::size_t p, const tie::whole_vector& v) {
        for (int e = 0; e < 2; ++e) {
            std::size_t i = 6 * p + 3 * static_cast<std::size_t>(e);
            for (const auto* x : {&v.x, &v.y, &v.z})
                q.x[i++] = static_cast<double>((*x)[e].low_word());
        }
    };
    const auto& [b, c, p] = f.vectors;
    place(f.edges ? 1 : 2, b);
    place(3, f.edges ? tie::whole_vector{p.x + c.x, p.y + c.y, p.z + c.z} : c);
    place(f.edges ? 2 : 0, p);
    put_times(h, q, k);
}

/// All vertices and edges from 0 with coordinates −1 to 1 in a plane, or edges along an axis; on a
/// line, with coordinates −3 to 3.
drawn_query small_query(int k) {
    constexpr int each = 6561;
    constexpr std::array<std::size_t, 8> planar{0, 1, 3, 4, 12, 13, 15, 16},
        spatial{0, 1, 2, 3, 4, 5, 12, 15};
    drawn_query q{};
    const auto put_digits = [&q](const auto& places, int digits, int size) {
        for (const std::size_t i : places) {
            q.x[i] = digits % (2 * size + 1) - size;
            digits /= 2 * size + 1;
        }
    };
    if (k < 2 * each)
        put_digits(k < each ? planar : spatial, k % each, 1);
    else
        put_digits(std::array<std::size_t, 4>{0, 3, 12, 15}, k - 2 * each, 3);
    return q;
}

/// The search for a root of N linear forms' product.
template <int N>
void put_search(hash& h, const tie::drawn_search& s) {
    using number = errbound::integers::fixed_integer<7>;
    errbound::bernstein<number, N> p{};
    p[0] = s.negative ? -1 : 1;
    auto before = s.negative ? errbound::sign_type::negative : errbound::sign_type::positive;
    const auto end = number::shifted(1, s.bits);
    for (int n = 0; n < N; ++n) {
        const number root = s.roots[static_cast<std::size_t>(n)];
        if (root > number(s.low)) before = -before;
        const auto times = [](const number& a, const number& b) {
            return (a * b).template from_bit<7>(0);
        };
        for (int i = n + 1; i > 0; --i) p[i] = times(p[i - 1], end - root) - times(p[i], root);
        p[0] = times(p[0], -root);
    }
    const auto place = [&s](std::int64_t x) { return std::ldexp(static_cast<double>(x), -s.bits); };
    const ccd::detail::root_search<7, N> search(p);
    put(h, search.between(place(s.low), place(s.high), before, place(s.estimate)));
}
void put_search(hash& h, const tie::drawn_search& s) {
    if (s.degree == 1) put_search<1>(h, s);
    if (s.degree == 2) put_search<2>(h, s);
    if (s.degree == 3) put_search<3>(h, s);
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
    using tie::line_of, tie::sequence;
    lines.push_back(line_of(
        "times wide", 1000, numbers,
        [](sequence& s) { return tie::whole_query_maker(s).wide_query(); },
        [](hash& h, const drawn_query& q, int) { put_wide(h, q); }));
    lines.push_back(line_of(
        "times forms", 4000, numbers, [](sequence& s) { return tie::whole_forms_maker(s).forms(); },
        put_of_forms));
    lines.push_back({"times small", 2 * 6561 + 2401, [](hash& h, std::uint64_t k) {
                         const drawn_query q = small_query(static_cast<int>(k));
                         put(h, first_contact_in_integers(ccd::vertex_edge<double>{
                                    q.moving(0), q.moving(1), q.moving(2)}));
                     }});
    lines.push_back(line_of("times search", 8000, numbers, tie::draw_search,
                            [](hash& h, const tie::drawn_search& s, int) { put_search(h, s); }));
    return lines;
}

}  // namespace

int main(int argc, char**) {
    return tie::compare(all_lines(), argc);
}
