// Polynomials of doubles and of integers: roots counted, isolated and refined, and signs at them,
// against FLINT and Tarski's query.
#include <errbound/polynomial.hpp>
#include <limits>
#include <string>
#include <vector>

#include "tests/errbound/roots/flint_polynomial.hpp"
#include "tests/errbound/roots/polynomial_families.hpp"
#include "tests/errbound/roots/tarski.hpp"
#include "tests/support/fuzz_numbers.hpp"

namespace {

using errbound::polynomial;
using errbound::sign_type;
using polynomial_families::generator;
using polynomial_families::integer;
using polynomial_families::sample;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t max_size = 14;  // coefficients

std::vector<integer> small_factor(fuzz::numbers& from) {
    std::vector<integer> factor(2 + from.below(2));
    for (integer& c : factor) c = static_cast<int>(from.byte()) - 128;
    if (factor.back() == 0) factor.back() = 1;
    return factor;
}

/// Doubles as they come, or a product of small factors, many of them repeated, with one coefficient
/// off by little.
sample polynomial_from(fuzz::numbers& from) {
    if (from.byte() % 2 == 0) {
        std::vector<double> c(1 + from.below(max_size));
        for (double& x : c) x = from.next();
        return generator::of_doubles(c);
    }
    std::vector<integer> c{1}, factor = small_factor(from);
    for (std::size_t left = from.below(6); left > 0 && c.size() + 2 < max_size; --left) {
        if (from.byte() % 2 == 0) factor = small_factor(from);
        c = generator::product(c, factor);
    }
    const unsigned larger = from.byte() % 3 * 20u;
    for (integer& x : c) x <<= larger;
    c[from.below(c.size())] += static_cast<int>(from.below(3)) - 1;
    if (c.back() == 0) c.back() = 1;
    return {c};
}

void expect(bool holds, const char* what, const std::vector<integer>& c) {
    if (holds) return;
    std::string text = std::string(what) + ":";
    for (const integer& x : c) text += " " + x.str();
    fuzz::fail(text);
}

template <class C>
void check(const polynomial<C>& p, const std::vector<integer>& whole, const sample& other) {
    const flint_polynomial truth(whole);
    const std::size_t right = truth.distinct_real_roots();
    auto roots = errbound::isolate_roots<integer>(p, -infinity, infinity);
    expect(roots.size() == right, "isolated on the line", whole);
    expect(errbound::count_roots<integer>(p, -infinity, infinity) == right, "counted on the line",
           whole);
    expect(errbound::count_roots<integer>(p, 0, infinity) == truth.distinct_nonnegative_roots(),
           "counted from 0 on", whole);

    auto staged = errbound::roots::staged<integer>(polynomial<integer>(other.whole));
    int sum = 0;
    for (std::size_t k = 0; k < roots.size(); ++k) {
        if (k % 2 == 0) roots.refine(k, 0x1p-60);
        const sign_type sign = roots.sign_at(staged, k);
        expect(certain(sign), "an uncertain sign", whole);
        sum += sign == sign_type::positive ? 1 : sign == sign_type::negative ? -1 : 0;
        if (k > 0) expect(!(roots[k].low < roots[k - 1].high), "intervals that overlap", whole);
    }
    expect(sum == tarski(whole, other.whole).everywhere(), "signs at the roots", whole);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::numbers from(data, size);
    const sample s = polynomial_from(from), other = polynomial_from(from);
    if (s.whole.size() < 2) return 0;
    if (s.doubles.empty())
        check(polynomial<integer>(s.whole), s.whole, other);
    else
        check(polynomial<double>(s.doubles), s.whole, other);
    return 0;
}
