// Compares Bernstein sign classification, polynomials, and the forms of queries and predicates over
// symbols with the proofs' definitions (proofs/tie/tie_symbols.ml): they compute the same
// expressions and decide by the same signs.
#include <array>
#include <ccd/methods/forms.hpp>
#include <cstddef>
#include <errbound/bernstein.hpp>
#include <errbound/bsc.hpp>
#include <errbound/predicates.hpp>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "tests/proofs/symbol.hpp"
#include "tests/proofs/table.hpp"

namespace {

using errbound::bernstein;
using tie::hash;
using tie::symbol;

struct family {
    const char* name;
    tie::sign_rates rates;
};
/// Exact signs, some of them zero; few and many uncertain signs; no zeros. In the last two,
/// differences are uncertain, so that Y is halved, with and without excluded subintervals.
constexpr std::array<family, 6> families{{{"exact", {2, 0, 32, 0}},
                                          {"certain", {2, 2, 32, 2}},
                                          {"uncertain", {10, 10, 32, 10}},
                                          {"strict", {0, 1, 32, 1}},
                                          {"halved", {2, 1, 32, 48}},
                                          {"excluded", {1, 1, 50, 48}}}};

void begin(const family& f, std::uint64_t seed) {
    symbol::rates = f.rates;
    symbol::seed = seed;
}

template <int N>
bernstein<symbol, N> given(std::uint64_t first) {
    bernstein<symbol, N> p;
    for (int i = 0; i <= N; ++i) p[i] = symbol::given(first + static_cast<std::uint64_t>(i));
    return p;
}
template <int N>
void put(hash& h, const bernstein<symbol, N>& p) {
    for (const symbol& x : p.h) h.put_both(x.name());
}

template <std::size_t Constraints>
void put_root(hash& h) {
    const auto found = errbound::root_with_nonnegative(given<3>(0), [] {
        std::array<bernstein<symbol, 4>, Constraints> g;
        for (std::size_t i = 0; i < Constraints; ++i) g[i] = given<4>(10 + 5 * i);
        return g;
    });
    h.put(static_cast<std::uint32_t>(found));
}

/// All functions of a polynomial of degree N, and its product with one of degree 2.
template <int N>
void put_polynomial(hash& h) {
    const auto p = given<N>(0);
    const symbol v = symbol::given(20), w = symbol::given(21);
    h.put_both(value_at(p, v, w).name());
    h.put_both(value_at(p, v).name());
    put(h, p * given<2>(30));
    put(h, elevated(p));
    if constexpr (N > 0) put(h, derivative(p));
    for (const auto& [left, right] : {split(p, v, w), halves(p)}) {
        put(h, left);
        put(h, right);
    }
    put(h, -p);
}

template <int N>
void put_signs(hash& h) {
    const auto p = given<N>(0);
    h.put(static_cast<std::uint32_t>(sign_inside(p)));
    h.put(static_cast<std::uint32_t>(sign_throughout(p)));
    h.put(certainly_rootless(p));
}

ccd::moving_point<symbol> moving(std::uint64_t first) {
    const auto at = [](std::uint64_t i) {
        return ccd::point<symbol>{symbol::given(i), symbol::given(i + 1), symbol::given(i + 2)};
    };
    return {at(first), at(first + 3)};
}
template <class Query>
void put_forms(hash& h) {
    const auto f = forms_of(Query{moving(0), moving(6), moving(12), moving(18)});
    put(h, f.y());
    for (const auto& g : f.inside()) put(h, g);
}

/// A predicate's expression or its sign, and the degrees of coordinates, if not all are 1.
template <class Shape, class F, class Options>
void put(hash& h, const errbound::predicate_type<Shape, F, Options>&) {
    const auto point = [](std::uint64_t k) {
        return std::array{symbol::given(10 * k), symbol::given(10 * k + 1),
                          symbol::given(10 * k + 2), symbol::given(10 * k + 3)};
    };
    const auto x = [&]<std::size_t... K>(std::index_sequence<K...>) {
        return F()(point(K)...);
    }
    (std::make_index_sequence<Shape::count>());
    if constexpr (std::is_same_v<decltype(x), const symbol>)
        h.put_both(x.name());
    else
        h.put(static_cast<std::uint32_t>(x));
    for (const int degree : Options::degrees) h.put(static_cast<std::uint32_t>(degree));
}
template <const auto& Predicate>
void put_predicate(hash& h) {
    put(h, Predicate);
}

std::vector<tie::line> all_lines() {
    std::vector<tie::line> lines;
    const auto once = [&](const std::string& name, void (*put_case)(hash&)) {
        lines.push_back({"symbol " + name, 1, [put_case](hash& h, std::uint64_t seed) {
                             begin(families[0], seed);
                             put_case(h);
                         }});
    };
    const auto drawn = [&](const std::string& name, std::uint64_t cases, void (*put_case)(hash&)) {
        for (const family& f : families)
            lines.push_back({"symbol " + name + "." + f.name, cases,
                             [&f, put_case](hash& h, std::uint64_t seed) {
                                 begin(f, seed);
                                 put_case(h);
                             }});
    };
    once("polynomial<0>", put_polynomial<0>);
    once("polynomial<1>", put_polynomial<1>);
    once("polynomial<2>", put_polynomial<2>);
    once("polynomial<3>", put_polynomial<3>);
    once("polynomial<4>", put_polynomial<4>);
    once("polynomial<7>", put_polynomial<7>);
    once("vertex_face_forms", put_forms<ccd::vertex_face<symbol>>);
    once("edge_edge_forms", put_forms<ccd::edge_edge<symbol>>);
    once("orient2d", put_predicate<errbound::orient2d>);
    once("orient3d", put_predicate<errbound::orient3d>);
    once("incircle", put_predicate<errbound::incircle>);
    once("insphere", put_predicate<errbound::insphere>);
    once("power_incircle", put_predicate<errbound::power_incircle>);
    once("power_insphere", put_predicate<errbound::power_insphere>);
    once("compare_distances2d", put_predicate<errbound::compare_distances2d>);
    once("compare_distances3d", put_predicate<errbound::compare_distances3d>);
    drawn("orient2d_line_line", 1000, put_predicate<errbound::orient2d_line_line>);
    drawn("orient3d_line_plane", 1000, put_predicate<errbound::orient3d_line_plane>);
    drawn("compare_x_line_line", 1000, put_predicate<errbound::compare_x_line_line>);
    drawn("signs<1>", 1000, put_signs<1>);
    drawn("signs<2>", 1000, put_signs<2>);
    drawn("signs<3>", 1000, put_signs<3>);
    drawn("signs<4>", 1000, put_signs<4>);
    drawn("root_with_nonnegative<3>", 40000, put_root<3>);
    drawn("root_with_nonnegative<4>", 40000, put_root<4>);
    return lines;
}

}  // namespace

int main(int argc, char**) {
    return tie::compare(all_lines(), argc);
}
