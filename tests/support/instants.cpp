#include "tests/support/instants.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace oracle::detail {

namespace mp = boost::multiprecision;

// ---- Polynomials ----

void trim(polynomial& p) {
    while (!p.empty() && p.back().is_zero()) p.pop_back();
}

polynomial operator+(const polynomial& a, const polynomial& b) {
    polynomial sum = a.size() < b.size() ? b : a;
    const polynomial& shorter = a.size() < b.size() ? a : b;
    for (std::size_t i = 0; i < shorter.size(); ++i) sum[i] += shorter[i];
    trim(sum);
    return sum;
}

polynomial operator-(polynomial a) {
    for (integer& c : a) c.backend().negate();
    return a;
}

polynomial operator-(const polynomial& a, const polynomial& b) {
    polynomial difference = a;
    if (difference.size() < b.size()) difference.resize(b.size());
    for (std::size_t i = 0; i < b.size(); ++i) difference[i] -= b[i];
    trim(difference);
    return difference;
}

polynomial operator*(const polynomial& a, const polynomial& b) {
    if (a.empty() || b.empty()) return {};
    polynomial product(a.size() + b.size() - 1);
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < b.size(); ++j)
            mpz_addmul(product[i + j].backend().data(), a[i].backend().data(),
                       b[j].backend().data());
    return product;
}

vector operator-(const vector& a, const vector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

polynomial dot(const vector& a, const vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

vector cross(const vector& a, const vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

namespace {

polynomial derivative(const polynomial& p) {
    polynomial d;
    for (std::size_t i = 1; i < p.size(); ++i) d.push_back(p[i] * i);
    return d;
}

// Divides by the largest positive number that divides all coefficients.
polynomial primitive(polynomial p) {
    integer divisor = 0;
    for (std::size_t i = p.size(); i-- > 0 && divisor != 1;) divisor = gcd(divisor, p[i]);
    if (divisor > 1)
        for (integer& c : p) c /= divisor;
    return p;
}

// A positive multiple of the remainder of a by b. The factor |leading coefficient of b| keeps the
// coefficients whole and all signs.
polynomial remainder(polynomial a, const polynomial& b) {
    const integer lead = abs(b.back());
    const bool negative = b.back().sign() < 0;
    while (a.size() >= b.size()) {
        const integer top = negative ? integer(-a.back()) : a.back();
        const std::size_t shift = a.size() - b.size();
        for (std::size_t i = 0; i < a.size(); ++i) {
            a[i] *= lead;
            if (i >= shift) a[i] -= top * b[i - shift];
        }
        trim(a);
    }
    return a;
}

// a / b. Precondition: b divides a. Both are primitive, so by Gauss's lemma every division is
// exact.
polynomial quotient(polynomial a, const polynomial& b) {
    polynomial q(a.size() - b.size() + 1);
    for (std::size_t k = q.size(); k-- > 0;) {
        q[k] = a[k + b.size() - 1] / b.back();
        for (std::size_t i = 0; i < b.size(); ++i) a[k + i] -= q[k] * b[i];
    }
    return q;
}

int sign_at(const polynomial& p, const dyadic& t) {
    integer value = 0;
    unsigned scale = 0;
    for (std::size_t i = p.size(); i-- > 0; scale += t.shift) {
        value *= t.numerator;
        value += p[i] << scale;
    }
    return value.sign();
}

dyadic middle(const dyadic& low, const dyadic& high) {
    const unsigned shift = std::max(low.shift, high.shift);
    dyadic t{(low.numerator << (shift - low.shift)) + (high.numerator << (shift - high.shift)),
             shift + 1};
    if (t.numerator.is_zero()) return {0, 0};
    const unsigned even = std::min(t.shift, static_cast<unsigned>(mp::lsb(t.numerator)));
    t.numerator >>= even;
    t.shift -= even;
    return t;
}

// p divided by its linear factor with the root t. With an odd numerator the divisor 2^shift t -
// numerator is primitive, so by Gauss's lemma every division below is exact.
polynomial without_root(const polynomial& p, const dyadic& t) {
    polynomial quotient(p.size() - 1);
    integer carry = 0;
    for (std::size_t i = quotient.size(); i-- > 0;) {
        carry = (p[i + 1] + carry * t.numerator) >> t.shift;
        quotient[i] = carry;
    }
    return quotient;
}

// The sign of g throughout [low, high] if its control values there have one sign, else 0: g lies
// between their minimum and maximum. Up to positive factors, they are the coefficients of (1 + x)^n
// g((low + high x) / (1 + x)).
int sign_throughout(polynomial g, const dyadic& low, const dyadic& high) {
    const std::size_t n = g.size() - 1;
    const unsigned shift = std::max(low.shift, high.shift);
    const integer from = low.numerator << (shift - low.shift);
    const integer width = (high.numerator << (shift - high.shift)) - from;
    for (std::size_t i = 0; i < n; ++i) g[i] <<= shift * (n - i);  // a polynomial in 2^shift t
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = n; j-- > i;) g[j] += g[j + 1] * from;
    integer power = 1;
    for (std::size_t i = 1; i <= n; ++i) g[i] *= power *= width;
    std::ranges::reverse(g);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = n; j-- > i;) g[j] += g[j + 1];
    const int sign = g[0].sign();
    return std::ranges::all_of(g, [sign](const integer& c) { return c.sign() == sign; }) ? sign : 0;
}

// ---- Tarski queries ----

using chain = std::vector<polynomial>;

// The signed remainder sequence of p and q, up to a positive factor of each member.
chain signed_remainders(const polynomial& p, polynomial q) {
    chain sequence{p};
    while (!q.empty()) {
        sequence.push_back(primitive(std::move(q)));
        q = -remainder(sequence[sequence.size() - 2], sequence.back());
    }
    return sequence;
}

int sign_changes(const chain& sequence, const dyadic& t) {
    int changes = 0;
    int last = 0;
    for (const polynomial& p : sequence) {
        const int sign = sign_at(p, t);
        if (sign != 0 && last != 0 && sign != last) ++changes;
        if (sign != 0) last = sign;
    }
    return changes;
}

// The sum of the signs of g at the distinct roots of p in (low, high). Precondition: p is nonzero
// at both ends. Multiple roots count once, so p need not be squarefree.
int tarski_query(const polynomial& p, const polynomial& g, const dyadic& low, const dyadic& high) {
    const polynomial reduced = primitive(remainder(g, p));
    if (reduced.empty()) return 0;
    const chain sequence = signed_remainders(p, remainder(derivative(p) * reduced, p));
    return sign_changes(sequence, low) - sign_changes(sequence, high);
}

// ---- Isolation ----

// Isolates all roots of p between low and high by bisection. If a middle is a root, it stops and
// returns true, with that root at the end of `found`. Tarski queries may not end at a root, so the
// search must start again without it.
bool hits_root(const polynomial& p, const chain& sturm, const dyadic& low, const dyadic& high,
               int changes_low, int changes_high, std::vector<instant>& found) {
    if (changes_low == changes_high) return false;
    if (changes_low - changes_high == 1) {
        found.push_back({p, low, high});
        return false;
    }
    const dyadic t = middle(low, high);
    if (sign_at(p, t) == 0) {
        found.push_back({{}, t, t});
        return true;
    }
    const int changes = sign_changes(sturm, t);
    return hits_root(p, sturm, low, t, changes_low, changes, found) ||
           hits_root(p, sturm, t, high, changes, changes_high, found);
}

// The same root in a shorter interval, in which more polynomials have constant sign. Precondition:
// the root is simple.
instant narrowed(instant t) {
    const int at_low = sign_at(t.p, t.low);
    for (int i = 0; i < 12; ++i) {
        const dyadic m = middle(t.low, t.high);
        const int sign = sign_at(t.p, m);
        if (sign == 0) return {{}, m, m};
        (sign == at_low ? t.low : t.high) = m;
    }
    return t;
}

}  // namespace

scaled::scaled(double x) {
    if (x == 0) return;
    mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), 53));
    for (exponent -= 53; mantissa % 2 == 0; ++exponent) mantissa /= 2;
}

integer scaled::in_units_of(int unit) const {
    return mantissa == 0 ? integer(0) : integer(mantissa) << (exponent - unit);
}

dyadic dyadic_of(double t) {
    const scaled s(t);
    if (s.exponent >= 0) return {t == 0 ? 0 : 1, 0};
    return {s.mantissa, static_cast<unsigned>(-s.exponent)};
}

int instant::sign(const polynomial& g) const {
    if (g.size() < 2) return g.empty() ? 0 : g[0].sign();
    if (p.empty()) return sign_at(g, low);
    const int throughout = sign_throughout(g, low, high);
    return throughout != 0 ? throughout : tarski_query(p, g, low, high);
}

std::vector<instant> roots_between(polynomial p, const dyadic& low, const dyadic& high) {
    p = primitive(std::move(p));
    while (sign_at(p, low) == 0) p = without_root(p, low);
    while (sign_at(p, high) == 0) p = without_root(p, high);
    std::vector<instant> found;
    while (sign_throughout(p, low, high) == 0) {
        chain sturm = signed_remainders(p, derivative(p));
        if (sturm.back().size() > 1) {  // multiple roots become simple ones
            p = quotient(std::move(p), sturm.back());
            sturm = signed_remainders(p, derivative(p));
        }
        std::vector<instant> isolated;
        if (!hits_root(p, sturm, low, high, sign_changes(sturm, low), sign_changes(sturm, high),
                       isolated)) {
            for (instant& t : isolated) found.push_back(narrowed(std::move(t)));
            break;
        }
        found.push_back(isolated.back());
        p = without_root(p, isolated.back().low);
    }
    return found;
}

std::vector<instant> stretch::ends() const {
    std::vector<instant> all;
    if (with_low) all.push_back({{}, low, low});
    if (with_high) all.push_back({{}, high, high});
    if (all.empty()) {
        const dyadic t = middle(low, high);
        all.push_back({{}, t, t});
    }
    return all;
}

}  // namespace oracle::detail
