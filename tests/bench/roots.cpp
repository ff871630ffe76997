// ns per polynomial for counting and isolating real roots, by family and degree, next to FLINT's
// count and arb's isolation. FLINT 2.9 counts exactly, by Sturm's theorem, but does not isolate;
// arb, its companion, isolates all complex roots. The integers that decide undecided intervals are
// compared too: errbound's own, Boost's cpp_int and GMP's.
#include <boost/multiprecision/cpp_int.hpp>
#include <errbound/polynomial.hpp>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

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
    template <class Compute>
    std::function<void()> pass(const Compute& compute) const {
        return [this, compute] {
            for (const auto& p : whole) bench::keep(compute(p));
            for (const auto& p : doubles) bench::keep(compute(p));
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
    /// ns per polynomial: counted, isolated, counted by FLINT; and the ratio of the counts.
    void add_counts(const std::string& of, int repeats, bench::row& to) const {
        if (others.empty()) return;
        const auto timings = bench::race({own.counted(), own.isolated(),
                                          [this] {
                                              for (const auto& p : others)
                                                  bench::keep(p->distinct_real_roots());
                                          }},
                                         repeats);
        to[of + ":_count"] = timings[0].ns(others.size());
        to[of + ":_isolate"] = timings[1].ns(others.size());
        to[of + ":_FLINT"] = timings[2].ns(others.size());
        to[of + ":_FLINT/count"] = timings[2].minimum / timings[0].minimum;
    }
    /// The times of isolation by Boost's integers and by GMP's, as multiples of errbound's.
    void add_integers(int repeats, bench::row& to) const {
        const auto t = bench::race({own.isolated(), boost.isolated(), gmp.isolated()}, repeats);
        to["by_cpp_int/isolate"] = t[1].minimum / t[0].minimum;
        to["by_GMP/isolate"] = t[2].minimum / t[0].minimum;
    }
#ifdef ERRBOUND_HAS_ARB
    /// ns per polynomial isolated by arb, and as a multiple of errbound's.
    void add_arb(bench::row& to) const {
        if (others.empty()) return;
        const auto timings = bench::race({own.isolated(),
                                          [this] {
                                              for (const auto& p : others)
                                                  bench::keep(isolate_by_arb(*p));
                                          }},
                                         1);
        to["arb_isolates"] = timings[1].ns(others.size());
        to["arb/isolate"] = timings[1].minimum / timings[0].minimum;
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

void run(bool quick, bench::report& out) {
    bench::rows all_rows;
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
            bench::row& r = all_rows.emplace_back(bench::row{
                {"family", polynomial_families::names[static_cast<int>(f)]},
                {"degree", degree},
                {"by_filter_%", 100 * static_cast<double>(decided.others.size()) / polynomials}});
            decided.add_counts("those", quick ? 1 : 5, r);
            all.add_counts("all", quick ? 1 : 5, r);
            all.add_integers(quick ? 1 : 7, r);
#ifdef ERRBOUND_HAS_ARB
            few.add_arb(r);
#endif
        }
    }
    out.table("roots", {},
              "distinct real roots on the whole line, ns per polynomial (least of some passes)",
              all_rows);
}

/// Slow cases: roots near each other, and high degrees.
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
void run_hard_cases(bool quick, bench::report& out) {
    bench::rows all;
    for (const hard_case& c : hard_cases(quick)) {
        const errbound::polynomial<double> p(c.doubles);
        bench::row& r = all.emplace_back(bench::row{
            {"polynomial", c.name}, {"roots", errbound::count_roots(p, -infinity, infinity)}});
        const auto t = bench::race(
            {isolated<errbound::integer>(p), isolated<boost_integer>(p), isolated<gmp_integer>(p)},
            quick ? 1 : 3);
        constexpr const char* integers[] = {"errbound's", "Boost's", "GMP's"};
        for (std::size_t i = 0; i < t.size(); ++i) {
            r[integers[i]] = 1e3 * t[i].minimum;
            r[integers[i] + std::string("_median")] = 1e3 * t[i].median;
        }
    }
    out.table(
        "hard_roots", {},
        "hard cases, isolated on the whole line, ms (least and median of some passes), by the "
        "type of integers",
        all);
}

}  // namespace

int main(int argc, char** argv) {
    bench::program bench("./run bench --roots", "Roots of polynomials, next to FLINT's and arb's.");
    return bench.run(argc, argv, [&](bench::report& out) {
        run(bench.quick, out);
        run_hard_cases(bench.quick, out);
    });
}
