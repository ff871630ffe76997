// Writes the inputs that a tie draws, for the programs of the proofs' definitions
// (proofs/tie/tie_queries.ml). Each number is its words in hexadecimal, the upper first.
//
// usage: tie_inputs integers|floats|times
#include <bit>
#include <cstdint>
#include <cstdio>
#include <string>
#include <type_traits>

#include "tests/proofs/drawn_query.hpp"
#include "tests/proofs/whole_forms.hpp"
#include "tests/proofs/whole_query.hpp"

namespace {

using tie::sequence;

void give_word(std::uint64_t word) {
    std::printf("%016llx", static_cast<unsigned long long>(word));
}
template <class T>
requires std::is_integral_v<T>
void give(T n) {
    std::putchar(' ');
    give_word(static_cast<std::uint64_t>(static_cast<std::int64_t>(n)));
}
void give(double x) {
    give(std::bit_cast<std::int64_t>(x));
}
template <int Words>
void give(const errbound::integers::fixed_integer<Words>& x) {
    std::putchar(' ');
    for (int i = Words - 1; i >= 0; --i) give_word(x[i]);
}
template <class... All>
requires(sizeof...(All) > 1) void give(const All&... all) {
    (give(all), ...);
}
template <class Range>
void give_all(const Range& range) {
    for (const auto& x : range) give(x);
}

void give(const tie::drawn_query& q) {
    give(q.edges);
    give_all(q.x), give_all(q.low), give_all(q.high);
}
void give_vectors(const tie::drawn_forms& f) {
    give(f.edges);
    for (const auto& v : f.vectors) give(v.x[0], v.x[1], v.y[0], v.y[1], v.z[0], v.z[1]);
}
void give(const tie::drawn_forms& f) {
    give_vectors(f);
    give(f.level, f.path, f.off, f.root, f.root_unit, f.words, f.cut);
}
void give(const tie::drawn_deep& d) {
    give_vectors(d.forms);
    give(d.unit_bits, d.root_bits, d.test_from, d.limit_unit_bits, d.limit_bits, d.limit_index,
         d.limit_negative);
    give_all(d.pair);
}
void give(const tie::drawn_quadratics& q) {
    for (const auto& f : q.forms) give_all(f.h);
    give_all(q.other.h);
}
void give(const tie::drawn_search& d) {
    give(d.degree);
    give_all(d.roots);
    give(d.bits, d.low, d.high, d.estimate, d.negative);
}
void give(const tie::drawn_bounded& d) {
    give(d.a, d.a_bits, d.b, d.b_bits);
}

template <class Draw>
void give_drawn(int cases, sequence& s, const Draw& draw) {
    for (int k = 0; k < cases; ++k) {
        give(draw(s));
        std::putchar('\n');
    }
}

}  // namespace

int main(int, char** argv) {
    const std::string tie = argv[1];
    const auto query = [](sequence& s) { return tie::whole_query_maker(s).query(); };
    const auto wide = [](sequence& s) { return tie::whole_query_maker(s).wide_query(); };
    const auto forms = [](sequence& s) { return tie::whole_forms_maker(s).forms(); };
    sequence s;
    if (tie == "floats")
        give_drawn(20000, s, [](sequence& of) { return tie::query_maker(of).query(); });
    if (tie == "integers") {
        give_drawn(80000, s, query);
        give_drawn(4000, s, wide);
        give_drawn(5000, s, forms);
        give_drawn(2000, s, tie::draw_deep);
        give_drawn(4000, s, tie::draw_quadratics);
        give_drawn(4000, s, tie::draw_bounded);
    }
    if (tie == "times") {
        give_drawn(10000, s, query);
        give_drawn(1000, s, wide);
        give_drawn(4000, s, forms);
        give_drawn(8000, s, tie::draw_search);
    }
}
