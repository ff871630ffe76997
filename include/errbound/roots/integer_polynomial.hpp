// Polynomials with integer coefficients, of run-time degree. Coefficients ascend in the power
// basis; the last one is not zero; no coefficients mean zero. Integer is an exact type
// (is_exact_number<Integer> and numeric_limits<Integer>::is_integer are true). It has + − × / % <<
// >>, comparison, conversions from and to 64-bit integers, and abs(), gcd(), msb() and lsb() found
// by argument-dependent lookup.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <errbound/integers/dyadic.hpp>
#include <errbound/roots/nearby_value.hpp>
#include <errbound/roots/prime_field.hpp>
#include <errbound/roots/work_meter.hpp>
#include <errbound/sign.hpp>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace errbound::roots {

template <exact_number Integer>
using integer_form = std::vector<Integer>;

/// −1, 0 or 1, for counts of sign changes.
template <exact_number Integer>
int sign(const Integer& x) {
    return x == 0 ? 0 : x > 0 ? 1 : -1;
}

template <class Integer>
void trim(integer_form<Integer>& p) {
    while (!p.empty() && p.back() == 0) p.pop_back();
}

/// Divides p by the (positive) greatest common divisor of its coefficients.
template <class Integer>
void make_primitive(integer_form<Integer>& p) {
    Integer content = 0;
    for (const Integer& c : p) {
        content = gcd(content, c);
        if (content == 1) return;
    }
    if (content > 1)
        for (Integer& c : p) c /= content;
}

template <class Integer>
integer_form<Integer> derivative(const integer_form<Integer>& p) {
    integer_form<Integer> d;
    for (std::size_t i = 1; i < p.size(); ++i) d.push_back(Integer(p[i] * Integer(i)));
    return d;
}

template <class Integer>
integer_form<Integer> mirrored(integer_form<Integer> p) {
    for (std::size_t i = 1; i < p.size(); i += 2) p[i] = -p[i];
    return p;
}

/// a/b; empty if b ≠ 0 does not divide a over the integers. Proof: proofs/roots/CommonFactor.v,
/// divided_right.
template <class Integer>
integer_form<Integer> divided(integer_form<Integer> a, const integer_form<Integer>& b) {
    integer_form<Integer> quotient(a.size() < b.size() ? 0 : a.size() - b.size() + 1);
    Integer term;  // reuses its memory
    for (std::size_t k = quotient.size(); k-- > 0;) {
        Integer& factor = quotient[k];
        factor = a[k + b.size() - 1];
        if (factor == 0) continue;
        factor /= b.back();
        for (std::size_t i = b.size(); i-- > 0;) {
            term = factor;
            term *= b[i];
            a[i + k] -= term;
            if (i + 1 == b.size() && a[i + k] != 0) return {};
        }
    }
    for (const Integer& c : a)
        if (c != 0) return {};
    return quotient;
}

template <class Integer>
Integer power(Integer x, std::size_t n, work_meter& meter) {
    if (n == 1) return x;
    Integer result = 1;
    for (;; x *= x) {
        meter.poll();
        if (n % 2 == 1) result *= x;
        n /= 2;
        if (n == 0) return result;
    }
}

template <class Integer>
dyadic<Integer> value_at(const integer_form<Integer>& p, const dyadic<Integer>& x,
                         work_meter& meter) {
    if (p.empty()) return {};
    // Horner's rule for the integer p(m·2^e)·2^(−e·n), or for p if e >= 0; skips runs of zeros.
    const int e = (std::min)(x.exponent(), 0);
    const Integer m = x.in_units(e);
    Integer sum = p.back();
    Integer term;  // reuses its memory
    unsigned shift = 0;
    std::size_t done = p.size() - 1;
    for (std::size_t i = done; i-- > 0;) {
        if (p[i] == 0 && i > 0) continue;
        meter.poll();
        if (done - i == 1)
            sum *= m;
        else
            sum *= power(m, done - i, meter);
        shift += static_cast<unsigned>(done - i) * static_cast<unsigned>(-e);
        done = i;
        term = p[i];
        term <<= shift;
        sum += term;
    }
    return {std::move(sum), -static_cast<int>(shift)};
}

template <class Integer>
dyadic<Integer> value_at(const integer_form<Integer>& p, const dyadic<Integer>& x) {
    work_meter unlimited;
    return value_at(p, x, unlimited);
}

/// A number within 2^-bits of the value at x. A long exact value is computed only if approximations
/// fail.
template <class Integer>
nearby_value<Integer> value_within(const integer_form<Integer>& p, const dyadic<Integer>& x,
                                   int bits, work_meter& meter) {
    const std::int64_t exact_bits = p.empty() ? 0 : bits_of_value(p, x);
    for (std::int64_t b = std::int64_t(bits) + 128; 16 * b < exact_bits; b *= 4)
        if (auto found = value_near(p, x, static_cast<int>(b), meter); found.is_within(bits))
            return found;
    const dyadic<Integer> exact = value_at(p, x, meter);
    return {exact.numerator(), 0, exact.exponent()};
}

template <class Integer>
sign_type sign_at(const integer_form<Integer>& p, const dyadic<Integer>& x, work_meter& meter) {
    if (x.is_zero()) return p.empty() ? sign_type::zero : sign_of(p[0]);
    return value_within(p, x, 0, meter).sign();
}
template <class Integer>
sign_type sign_at(const integer_form<Integer>& p, const dyadic<Integer>& x) {
    work_meter unlimited;
    return sign_at(p, x, unlimited);
}

/// 1/C(n, i) times the least common multiple of the C(n, i), which is lcm(1, ..., n + 1)/(n + 1)
/// and fits 64 bits for n <= 40. Proof: proofs/roots/ControlValues.v, weights_right, weights_fit.
template <class Number>
std::vector<Number> inverse_binomials(std::size_t n) {
    using std::gcd;
    std::vector<Number> binomials{Number(1)};
    Number multiple = 1;
    for (std::size_t i = 1; i <= n; ++i) {
        binomials.push_back(Number(binomials.back() * Number(n - i + 1) / Number(i)));
        multiple *= binomials[i] / Number(gcd(multiple, binomials[i]));
    }
    for (Number& b : binomials) b = multiple / b;
    return binomials;
}

/// A positive multiple of p's control values (Bernstein coefficients) on [low, high], all integers.
/// Proof: proofs/roots/ControlValues.v, control_values_on_right.
template <class Integer>
integer_form<Integer> control_values_on(integer_form<Integer> p, const dyadic<Integer>& low,
                                        const dyadic<Integer>& high, work_meter& meter) {
    const std::size_t n = p.size() - 1;
    const dyadic<Integer> width = high - low;
    const int e = (std::min)(low.is_zero() ? width.exponent() : low.exponent(), width.exponent());
    // x = 2^e·(start + length·u) with u in [0, 1]: first a multiple of p(2^e·y).
    const Integer start = low.in_units(e), length = width.in_units(e);
    for (std::size_t i = 0; i <= n; ++i) {
        const std::size_t power = e >= 0 ? i : n - i;
        p[i] <<= static_cast<unsigned>(power) * static_cast<unsigned>(e >= 0 ? e : -e);
    }
    Integer term;  // reuses its memory
    if (start != 0)
        for (std::size_t i = 0; i < n; ++i) {
            meter.poll();
            for (std::size_t j = n; j-- > i;) {
                term = p[j + 1];
                term *= start;
                p[j] += term;
            }
        }
    // Control values are Σ_j C(i, j)/C(n, j)·a_j for power-basis coefficients a_j in u.
    const auto weigh = [&](const auto& weights) {
        Integer power = 1;
        for (std::size_t i = 0; i <= n; ++i) {
            p[i] *= Integer(weights[i]);
            if (length == 1) continue;
            p[i] *= power;
            power *= length;
        }
    };
    if (n <= 40)
        weigh(inverse_binomials<std::uint64_t>(n));
    else
        weigh(inverse_binomials<Integer>(n));
    for (std::size_t i = 1; i <= n; ++i) {
        meter.poll();
        for (std::size_t j = n; j >= i; --j) p[j] += p[j - 1];
    }
    return p;
}
template <class Integer>
integer_form<Integer> control_values_on(integer_form<Integer> p, const dyadic<Integer>& low,
                                        const dyadic<Integer>& high) {
    work_meter unlimited;
    return control_values_on(std::move(p), low, high, unlimited);
}

template <class Integer>
std::uint64_t residue(const Integer& x, const prime_field& field) {
    const auto p = static_cast<std::int64_t>(field.modulus());
    std::int64_t rest = 0;
    if (x < p && -p < x)
        rest = static_cast<std::int64_t>(x);
    else
        rest = static_cast<std::int64_t>(Integer(x % Integer(p)));
    return static_cast<std::uint64_t>(rest < 0 ? rest + p : rest);
}

/// The coefficients' residues divided by R, which are a multiple of p in Montgomery's form.
template <class Integer>
std::vector<std::uint64_t> residues(const integer_form<Integer>& p, const prime_field& field) {
    std::vector<std::uint64_t> r;
    r.reserve(p.size());
    for (const Integer& c : p) r.push_back(residue(c, field));
    return r;
}

/// The residue of the value at x, times 2^(−e·n) for e < 0, where x has the exponent e. If nonzero,
/// the value is not zero. Proof: proofs/roots/PrimeField.v, value_modulo_right.
template <class Integer>
std::uint64_t value_at(const std::vector<std::uint64_t>& residues, const prime_field& field,
                       const dyadic<Integer>& x) {
    const int e = x.exponent();
    const std::uint64_t two = field.add(field.one(), field.one());
    const std::uint64_t power = field.power(two, static_cast<std::uint64_t>(e < 0 ? -e : e));
    std::uint64_t m = field.to_form(residue(x.numerator(), field)), scale = field.one(), sum = 0;
    if (e >= 0) m = field.multiply(m, power);
    for (std::size_t i = residues.size(); i-- > 0;) {
        sum = field.add(field.multiply(sum, m), field.multiply(residues[i], scale));
        if (e < 0) scale = field.multiply(scale, power);
    }
    return sum;
}

/// A polynomial modulo a product of primes (Chinese remainders), with coefficients of the least
/// size.
template <class Integer>
struct remainders {
    integer_form<Integer> p;
    Integer modulus = 1;

    void add(const std::vector<std::uint64_t>& r, const prime_field& field) {
        const auto inverse = field.inverse(field.to_form(residue(modulus, field)));
        const Integer next = modulus * Integer(field.modulus()), half = next / 2;
        p.resize(r.size());
        for (std::size_t i = 0; i < r.size(); ++i) {
            const auto missing =
                field.multiply(field.subtract(r[i], residue(p[i], field)), inverse);
            if (missing == 0) continue;
            p[i] += modulus * Integer(missing);
            if (p[i] > half) p[i] -= next;
        }
        modulus = next;
    }
    /// True if the modulus is probably large enough: all coefficients are far below it.
    bool decided() const {
        const Integer bound = modulus >> 12U;
        return std::all_of(p.begin(), p.end(),
                           [&](const Integer& c) { return c < bound && -bound < c; });
    }
};

/// True if p, primitive, certainly has no multiple roots.
template <class Integer>
bool surely_squarefree(const integer_form<Integer>& p, work_meter& meter) {
    const prime_field field(large_primes[0]);
    auto image = residues(p, field);
    if (image.back() == 0) return false;
    auto slope = derivative(field, image);
    return slope.size() + 1 == p.size() &&
           common_factor(field, std::move(image), std::move(slope), meter).size() == 1;
}

/// The greatest common divisor, primitive; empty only if both are identically zero. Uses images
/// modulo primes (W. S. Brown, On Euclid's algorithm and the computation of polynomial greatest
/// common divisors, JACM 18, 1971). Their degree is at least the divisor's, so one prime detects
/// coprime polynomials. Division verifies a divisor combined from several primes. Proof:
/// proofs/roots/CommonFactor.v, common_factor_right, common_factor_divides.
template <exact_number Integer>
integer_form<Integer> common_factor(integer_form<Integer> a, integer_form<Integer> b,
                                    work_meter& meter) {
    trim(a);
    trim(b);
    make_primitive(a);
    make_primitive(b);
    if (b.empty()) return a;
    if (a.empty()) return b;
    const Integer lead = gcd(a.back(), b.back());
    remainders<Integer> found;
    std::uint64_t prime = 0;
    for (std::size_t k = 0;; ++k) {
        prime = k < large_primes.size() ? large_primes[k] : prime_before(prime);
        const prime_field field(prime);
        auto a_image = residues(a, field), b_image = residues(b, field);
        if (a_image.back() == 0 || b_image.back() == 0) continue;
        auto image = common_factor(field, std::move(a_image), std::move(b_image), meter);
        if (image.size() == 1) return {Integer(1)};
        if (!found.p.empty() && image.size() > found.p.size()) continue;
        if (image.size() < found.p.size()) found = {};
        // Makes the image's last coefficient `lead`, a multiple of the divisor's last one.
        const std::uint64_t factor =
            field.multiply(residue(lead, field), field.inverse(image.back()));
        for (auto& c : image) c = field.multiply(c, factor);
        found.add(image, field);
        meter.spend(image.size() * (k + 1));
        if (!found.decided()) continue;
        integer_form<Integer> divisor = found.p;
        make_primitive(divisor);
        meter.spend(a.size() * divisor.size() * (k + 1));
        if (!divided(a, divisor).empty() && !divided(b, divisor).empty()) return divisor;
    }
}
template <exact_number Integer>
integer_form<Integer> common_factor(integer_form<Integer> a, integer_form<Integer> b) {
    work_meter unlimited;
    return common_factor(std::move(a), std::move(b), unlimited);
}

/// Square-free polynomials f_1, f_2, ..., each dividing the one before: a root of multiplicity m of
/// p is a root of exactly f_1 to f_m. Returns at most `most`. Precondition: p is not constant. Cost
/// without multiple roots: Euclid's algorithm modulo one prime. Proof: proofs/roots/CommonFactor.v,
/// chain_multiplicities, cofactors_rootless; proofs/roots/RootIsolation.v, squarefree_part_roots.
template <exact_number Integer>
std::vector<integer_form<Integer>> squarefree_chain(integer_form<Integer> p, std::size_t most,
                                                    work_meter& meter) {
    make_primitive(p);
    std::vector<integer_form<Integer>> chain;
    while (p.size() > 1 && chain.size() < most) {
        if (surely_squarefree(p, meter)) {
            chain.push_back(std::move(p));
            break;
        }
        auto multiple = common_factor(p, derivative(p), meter);
        chain.push_back(multiple.size() > 1 ? divided(p, multiple) : std::move(p));
        p = std::move(multiple);
    }
    return chain;
}

}  // namespace errbound::roots
