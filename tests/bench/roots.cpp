// ns per polynomial for counting and isolating real roots, by family and degree, compared with
// FLINT's count and arb's isolation. FLINT 2.9 counts exactly by Sturm's theorem but does not
// isolate; arb isolates all complex roots. Also compares the integers that decide undecided
// intervals: errbound's, Boost's cpp_int and GMP's.
#include <boost/multiprecision/cpp_int.hpp>
#include <cstdio>
#include <cstdlib>
#include <errbound/polynomial.hpp>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "ccd/lab/machine.hpp"
#include "tests/bench/harness.hpp"
#include "tests/errbound/roots/flint_polynomial.hpp"
#include "tests/errbound/roots/polynomial_families.hpp"
#ifdef ERRBOUND_HAS_ARB
#include "tests/errbound/roots/arb_roots.hpp"
#endif

namespace {

using polynomial_families::family;

constexpr double infinity = std::numeric_limits<double>::infinity();

using gmp_integer = polynomial_families::integer;
using boost_integer = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>,
                                                    boost::multiprecision::et_off>;

/// Polynomials with coefficients of the type that users would choose.
template <class Integer>
struct by_integers {
    std::vector<errbound::polynomial<Integer>> whole = {};
    std::vector<errbound::polynomial<double>> doubles = {};

    void add(const polynomial_families::sample& s) {
        if (s.doubles.empty())
            whole.emplace_back(polynomial_families::in<Integer>(s.whole));
        else
            doubles.emplace_back(s.doubles);
    }
    template <class Ask>
    std::function<void()> pass(const Ask& ask) const {
        return [this, ask] {
            for (const auto& p : whole) bench::keep(ask(p));
            for (const auto& p : doubles) bench::keep(ask(p));
        };
    }
    std::function<void()> counted() const {
        return pass(
            [](const auto& p) { return errbound::count_roots<Integer>(p, -infinity, infinity); });
    }
    std::function<void()> isolated() const {
        return pass([](const auto& p) {
            return errbound::isolate_roots<Integer>(p, -infinity, infinity).size();
        });
    }
};

/// The same polynomials in all types of integers, and FLINT's.
struct contest {
    by_integers<errbound::integer> own = {};
    by_integers<boost_integer> boost = {};
    by_integers<gmp_integer> gmp = {};
    std::vector<std::unique_ptr<flint_polynomial>> others = {};

    void add(const polynomial_families::sample& s) {
        own.add(s);
        boost.add(s);
        gmp.add(s);
        others.push_back(std::make_unique<flint_polynomial>(s.whole));
    }
    bench::cell nanoseconds(const bench::timing& t) const {
        return bench::number(1e9 * t.minimum / static_cast<double>(others.size()), 0);
    }

    /// ns per polynomial: counted, isolated, counted by FLINT; and the ratio of the counts.
    std::vector<bench::cell> cells(int repeats) const {
        if (others.empty()) return {bench::none(), bench::none(), bench::none(), bench::none()};
        const auto timings = bench::race({own.counted(), own.isolated(),
                                          [this] {
                                              for (const auto& p : others)
                                                  bench::keep(p->distinct_real_roots());
                                          }},
                                         repeats);
        return {nanoseconds(timings[0]), nanoseconds(timings[1]), nanoseconds(timings[2]),
                bench::number(timings[2].minimum / timings[0].minimum, 1)};
    }
    /// The isolation time with Boost's and with GMP's integers, divided by that with errbound's: of
    /// the least times and of the medians.
    std::vector<bench::cell> integer_cells(int repeats) const {
        const auto t = bench::race({own.isolated(), boost.isolated(), gmp.isolated()}, repeats);
        std::vector<bench::cell> ratios;
        for (const auto& other : {t[1], t[2]}) {
            ratios.push_back(bench::number(other.minimum / t[0].minimum, 2));
            ratios.push_back(bench::number(other.median / t[0].median, 2));
        }
        return ratios;
    }
#ifdef ERRBOUND_HAS_ARB
    /// ns per polynomial isolated by arb, and its ratio to errbound's time.
    std::vector<bench::cell> arb_cells(int repeats) const {
        if (others.empty()) return {bench::none(), bench::none()};
        const auto timings = bench::race({own.isolated(),
                                          [this] {
                                              for (const auto& p : others)
                                                  bench::keep(isolate_by_arb(*p));
                                          }},
                                         repeats);
        return {nanoseconds(timings[1]), bench::number(timings[1].minimum / timings[0].minimum, 0)};
    }
#endif
};

bool decided_by_filter(const polynomial_families::sample& s) {
    const auto is_decided = [](const auto& p) {
        return errbound::isolate_roots(p, -infinity, infinity).decided_by_filter();
    };
    return s.doubles.empty() ? is_decided(errbound::polynomial(
                                   polynomial_families::in<errbound::integer>(s.whole)))
                             : is_decided(errbound::polynomial(s.doubles));
}

void run(bool quick) {
    bench::report out;
    std::vector<std::vector<bench::cell>> rows;
    for (const family f : polynomial_families::all) {
        for (const int degree : {2, 3, 5, 8, 12, 20, 30}) {
            if (f == family::wide && degree > 8) continue;
            polynomial_families::generator make(1);
            contest all, decided, few;
            const int polynomials = quick ? 5 : 200;
            for (int k = 0; k < polynomials; ++k) {
                const auto s = make.make(f, degree);
                all.add(s);
                if (decided_by_filter(s)) decided.add(s);
                // arb takes up to milliseconds per polynomial, and seconds for exponents of any
                // size.
                if (k < 8 && f != family::wide) few.add(s);
            }
            std::vector<bench::cell> row{
                bench::word(polynomial_families::names[static_cast<int>(f)]),
                bench::count(static_cast<std::uint64_t>(degree)),
                bench::percent(static_cast<double>(decided.others.size()) / polynomials)};
            const int repeats = quick ? 1 : 5;
            for (const contest* c : {&decided, &all})
                for (auto& cell : c->cells(repeats)) row.push_back(cell);
            for (auto& cell : all.integer_cells(quick ? 1 : 7)) row.push_back(cell);
#ifdef ERRBOUND_HAS_ARB
            for (auto& cell : few.arb_cells(1)) row.push_back(cell);
#endif
            rows.push_back(row);
        }
    }
    std::vector<bench::column> columns{
        {"family", "family", true},       {"degree", "degree"},
        {"decided", "decided by filter"}, {"decided_count", "those: count"},
        {"decided_isolate", "isolate"},   {"decided_flint", "FLINT count"},
        {"decided_ratio", "FLINT/count"}, {"count", "all: count"},
        {"isolate", "isolate"},           {"flint", "FLINT count"},
        {"ratio", "FLINT/count"},         {"boost", "by cpp_int/isolate"},
        {"boost_median", "medians"},      {"gmp", "by GMP/isolate"},
        {"gmp_median", "medians"}};
#ifdef ERRBOUND_HAS_ARB
    columns.push_back({"arb", "arb isolates"});
    columns.push_back({"arb_ratio", "arb/isolate"});
#endif
    out.table("roots", {},
              "distinct real roots on the whole line, ns per polynomial (least of some passes)",
              columns, rows);
}

/// A slow input: roots near each other, or a high degree.
struct hard_case {
    std::string name;
    std::vector<double> doubles;
};
std::vector<hard_case> hard_cases(bool quick) {
    std::vector<hard_case> cases;
    for (const std::size_t n : {7, 30, 45, 100, 200}) {
        if (quick && n > 30) break;
        const double a = n > 7 ? 0x1p510 : 0x1p500;
        cases.push_back(
            {"(ax - 1)(x^" + std::to_string(n) + " - (ax - 1)), a = " + (n > 7 ? "2^510" : "2^500"),
             polynomial_families::close_pair(n, a)});
    }
    for (const int n : {100, 500, 1000, 2000}) {
        if (quick && n > 100) break;
        polynomial_families::generator make(1);
        cases.push_back({"degree " + std::to_string(n) + ", uniform coefficients",
                         make.make(family::random, n).doubles});
    }
    for (const std::size_t n : {5000, 100000}) {
        std::vector<double> c(n + 1);
        c[0] = -2;
        c[n / 2] = 0.5;
        c[n] = 1;
        cases.push_back({"x^" + std::to_string(n) + " + x^" + std::to_string(n / 2) + "/2 - 2", c});
    }
    return cases;
}
template <class Integer>
std::function<void()> isolated(const errbound::polynomial<double>& p) {
    return [&p] { bench::keep(errbound::isolate_roots<Integer>(p, -infinity, infinity).size()); };
}
void run_hard_cases(bool quick) {
    bench::report out;
    std::vector<std::vector<bench::cell>> rows;
    for (const hard_case& c : hard_cases(quick)) {
        const errbound::polynomial<double> p(c.doubles);
        const std::size_t roots = errbound::count_roots(p, -infinity, infinity);
        std::vector<bench::cell> row{bench::word(c.name), bench::count(roots)};
        for (const auto& t : bench::race({isolated<errbound::integer>(p),
                                          isolated<boost_integer>(p), isolated<gmp_integer>(p)},
                                         quick ? 1 : 3)) {
            row.push_back(bench::number(1e3 * t.minimum, 1));
            row.push_back(bench::number(1e3 * t.median, 1));
        }
        rows.push_back(row);
    }
    out.table("hard_roots", {},
              "hard cases, isolated on the whole line, ms (least and median of some passes)",
              {{"polynomial", "polynomial", true},
               {"roots", "roots"},
               {"own", "errbound's integers"},
               {"own_median", "median"},
               {"boost", "Boost's"},
               {"boost_median", "median"},
               {"gmp", "GMP's"},
               {"gmp_median", "median"}},
              rows);
}

}  // namespace

int main(int argc, char** argv) {
    const bool quick = argc == 2 && std::string_view(argv[1]) == "--quick";
    if (argc > 1 && !quick) {
        std::fprintf(stderr, "usage: ./run bench --roots [--quick]\n");
        return 2;
    }
    std::printf("%s\n", ccd::lab::text_of(ccd::lab::this_machine(), 1).c_str());
    run(quick);
    run_hard_cases(quick);
    return 0;
}
