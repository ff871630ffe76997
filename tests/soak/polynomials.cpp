// The part of the soak that counts and isolates roots; requires FLINT.
#include <algorithm>
#include <array>
#include <cstdint>
#include <errbound/polynomial.hpp>
#include <limits>
#include <string>
#include <vector>

#include "tests/errbound/roots/flint_polynomial.hpp"
#include "tests/errbound/roots/polynomial_families.hpp"
#include "tests/soak/parts.hpp"

namespace soak {
namespace {

using errbound::polynomial;
using polynomial_families::family;
using polynomial_families::generator;
using polynomial_families::integer;
using polynomial_families::sample;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int max_degree = 24;

/// A product of equal or nearly equal factors, sometimes with one coefficient changed by one. Roots
/// are a last place apart, or just miss the real line.
sample near_multiple(generator& make, int degree) {
    std::vector<integer> c{1};
    const integer scale = integer(1) << static_cast<unsigned>(4 + make.small(4));
    const integer root = make.small(100);
    while (static_cast<int>(c.size()) <= degree)
        c = generator::product(c, {integer(-(root * scale + make.small(1))), scale});
    c[static_cast<std::size_t>(make.small(degree) + degree) / 2] += make.small(1);
    return {c};
}

/// A similar product, expanded and rounded to doubles.
sample near_multiple_doubles(generator& make, int degree) {
    const double root = make.uniform();
    std::vector<double> c{1};
    while (static_cast<int>(c.size()) <= degree) c = generator::product(c, {-root, 1.0});
    return generator::of_doubles(c);
}

/// (ax − 1)(x^n − (ax − 1)): a rational root very close to another root.
sample beside_rational(generator& make, int degree) {
    const integer a = integer(1) << static_cast<unsigned>(20 + make.small(16));
    std::vector<integer> second(static_cast<std::size_t>(std::max(degree, 3)));
    second[0] = 1;
    second[1] = -a;
    second.back() += 1;
    return {generator::product({-1, a}, second)};
}

struct source_of_polynomials {
    std::string name;
    std::function<sample(generator&, int index)> make;
};

std::vector<source_of_polynomials> all_sources() {
    std::vector<source_of_polynomials> all;
    for (std::size_t f = 0; f < polynomial_families::all.size(); ++f)
        all.push_back({polynomial_families::names[f], [f](generator& make, int index) {
                           const family of = polynomial_families::all[f];
                           return make.make(
                               of, polynomial_families::degree_of_sample(of, index, max_degree));
                       }});
    const auto degree = [](int index) { return 2 + index % (max_degree - 1); };
    all.push_back({"near multiple", [degree](generator& make, int index) {
                       return near_multiple(make, degree(index));
                   }});
    all.push_back({"near multiple, doubles", [degree](generator& make, int index) {
                       return near_multiple_doubles(make, degree(index));
                   }});
    all.push_back({"beside a rational root", [degree](generator& make, int index) {
                       return beside_rational(make, degree(index));
                   }});
    return all;
}

constexpr int polynomials_per_block = 5;  // of each source

struct root_counts {
    std::size_t on_line, positive;

    friend bool operator==(const root_counts&, const root_counts&) = default;
    std::string text() const {
        return std::to_string(on_line) + ", not negative " + std::to_string(positive);
    }
};

/// Compares one type of integers; returns true if the filter decided without it.
template <class Integer>
bool compare_by(const std::string& integers, const sample& s, const root_counts& truth,
                std::uint64_t& differences, const std::string& name, findings& out) {
    const auto compare = [&](const auto& p) {
        const auto roots = errbound::isolate_roots<Integer>(p, -infinity, infinity);
        const root_counts counted{errbound::count_roots<Integer>(p, -infinity, infinity),
                                  errbound::count_roots<Integer>(p, 0, infinity)};
        if (roots.size() != truth.on_line || counted != truth) {
            ++differences;
            out.differ({name + ": by " + integers + " isolated " + std::to_string(roots.size()) +
                        " roots, counted " + counted.text() + "; FLINT " + truth.text()});
        }
        return roots.decided_by_filter();
    };
    return s.doubles.empty() ? compare(polynomial(polynomial_families::in<Integer>(s.whole)))
                             : compare(polynomial(s.doubles));
}

void compare(const sample& s, std::vector<std::uint64_t>& counts, const std::string& name,
             findings& out) {
    const flint_polynomial flint(s.whole);
    const root_counts truth{flint.distinct_real_roots(), flint.distinct_nonnegative_roots()};
    ++counts[0];
    counts[1] += truth.on_line;
    out.stir(truth.on_line);
    out.stir(truth.positive);
    counts[2] +=
        compare_by<errbound::integer>("errbound's integers", s, truth, counts[3], name, out);
    compare_by<integer>("GMP's integers", s, truth, counts[3], name, out);
}

findings compare_block(std::uint64_t seed, std::uint64_t block) {
    findings out{
        .blocks = 1,
        .tables = {{"polynomials", {"polynomials", "roots", "by the filter", "differences"}}}};
    generator make(seed * 0x100000001b3 + block);
    for (const auto& source : all_sources()) {
        for (int k = 0; k < polynomials_per_block; ++k) {
            const int index = static_cast<int>(block) * polynomials_per_block + k;
            const sample s = source.make(make, index);
            std::string name = source.name + ", coefficients";
            for (const integer& c : s.whole) name += " " + c.str();
            compare(s, out.table("polynomials")[source.name], name, out);
        }
    }
    return out;
}

}  // namespace

part polynomial_part() {
    part all{.name = "polynomials", .unit = "polynomials"};
    all.count = [count = all_sources().size()](std::uint64_t blocks) {
        return blocks * count * polynomials_per_block;
    };
    all.compare_block = compare_block;
    return all;
}

}  // namespace soak
