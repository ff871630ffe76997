// Exact real roots of (x − 1)(x − 2)···(x − 20) with the coefficient −210 of x^19 reduced by 2^-23,
// so that ten roots are complex. (J. H. Wilkinson, The perfidious polynomial, 1984.)
#include <cstddef>
#include <cstdio>
#include <errbound/polynomial.hpp>
#include <limits>
#include <string>
#include <vector>

using errbound::integer;

// Sign changes on [0, 25] in steps of 1e-5, by Horner's rule. Near roots, rounding errors decide.
int sign_changes_in_double(const std::vector<integer>& p) {
    std::vector<double> c;
    for (const integer& x : p) c.push_back(static_cast<double>(x));
    int changes = 0, last = 0;
    for (int k = 0; k <= 2500000; ++k) {
        double value = 0;
        for (std::size_t i = c.size(); i-- > 0;) value = value * (k / 1e5) + c[i];
        const int sign = (value > 0) - (value < 0);
        if (sign != 0 && sign == -last) ++changes;
        if (sign != 0) last = sign;
    }
    return changes;
}

int main() {
    std::vector<integer> c{1};
    for (int k = 1; k <= 20; ++k) {
        c.insert(c.begin(), 0);
        for (std::size_t i = 0; i + 1 < c.size(); ++i) c[i] -= k * c[i + 1];
    }
    for (integer& x : c) x <<= 23;
    c[19] -= 1;

    std::printf("Values in double change sign %d times\n", sign_changes_in_double(c));

    const errbound::polynomial p(c);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    auto roots = errbound::isolate_roots(p, -infinity, infinity);
    std::printf("Real roots: %zu\n", roots.size());
    for (std::size_t k = 0; k < roots.size(); ++k) {
        roots.refine(k, 1e-10);
        std::printf("%14.10f\n", roots[k].low.to_double());
    }

    // One root to 30 digits: the lower end n·2^e of its interval, in units of 10^-30.
    const std::size_t last = roots.size() - 1;
    roots.refine(last, 1e-31);
    const auto& low = roots[last].low;
    integer digits = low.numerator();
    for (int k = 0; k < 30; ++k) digits *= 10;
    digits = low.exponent() < 0 ? digits >> -low.exponent() : digits << low.exponent();
    std::string text = to_string(digits);
    std::printf("The largest: %s\n", text.insert(text.size() - 30, ".").c_str());

    // The sign of another polynomial at this root. Digits cannot prove that it vanishes.
    const char* const names[] = {"negative", "zero", "positive"};
    const errbound::polynomial<double> g{-20.846908101482256,
                                         1.0};  // x minus an approximation of the root
    std::printf("x - 20.846908101482256 there: %s\n",
                names[static_cast<int>(roots.sign_at(g, last))]);
    std::printf("p itself there: %s\n", names[static_cast<int>(roots.sign_at(p, last))]);
}
