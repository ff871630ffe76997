// Arithmetic and greatest common divisors of polynomials modulo a prime of 62 bits. Montgomery's
// form: a residue a is stored as a·R modulo p, R = 2^64. (P. L. Montgomery, Modular multiplication
// without trial division, Math. Comp. 44, 1985.)
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <errbound/integers/double_word.hpp>
#include <errbound/roots/work_meter.hpp>
#include <utility>
#include <vector>

namespace errbound::roots {

inline constexpr std::uint64_t operations_of_product = 4;  ///< modulo a prime

class prime_field {
  public:
    using word = std::uint64_t;
    using double_word = integers::words::double_word;

    /// Precondition: p < 2^62 odd, above 2. Proof: proofs/roots/PrimeField.v,
    /// negative_inverse_right, constants_right.
    explicit constexpr prime_field(word p) : p_(p) {
        word inverse = p;  // right modulo 2^3; each step doubles the correct bits
        for (int i = 0; i < 5; ++i) inverse *= 2 - p * inverse;
        negative_inverse_ = 0 - inverse;
        one_ = (0 - p) % p;
        square_ = static_cast<word>(double_word(one_) * one_ % p);
    }

    // Proof: proofs/roots/PrimeField.v, nonzero_form, field_add, field_subtract, field_forms.
    constexpr word modulus() const { return p_; }
    constexpr word one() const { return one_; }
    constexpr word add(word a, word b) const { return a + b >= p_ ? a + b - p_ : a + b; }
    constexpr word subtract(word a, word b) const { return a >= b ? a - b : a + p_ - b; }
    /// a·b/R. Proof: proofs/roots/PrimeField.v, field_multiply.
    constexpr word multiply(word a, word b) const {
        const double_word t = double_word(a) * b;
        const word m = static_cast<word>(t) * negative_inverse_;
        const word r = static_cast<word>((t + double_word(m) * p_) >> 64);
        return r >= p_ ? r - p_ : r;
    }
    /// (a·b − c·d)/R. Proof: proofs/roots/PrimeField.v, field_multiply_and_subtract.
    constexpr word multiply_and_subtract(word a, word b, word c, word d) const {
        // t is below 2p², so t + m·p is below 2p² + pR and r below 3p/2.
        const double_word t = double_word(a) * b + double_word(c) * (p_ - d);
        const word m = static_cast<word>(t) * negative_inverse_;
        const word r = static_cast<word>((t + double_word(m) * p_) >> 64);
        return r >= p_ ? r - p_ : r;
    }
    constexpr word to_form(word a) const { return multiply(a, square_); }
    constexpr word from_form(word a) const { return multiply(a, 1); }
    /// Proof: proofs/roots/PrimeField.v, power_right.
    constexpr word power(word a, word n) const {
        word result = one_;
        for (; n > 0; n >>= 1) {
            if (n & 1) result = multiply(result, a);
            a = multiply(a, a);
        }
        return result;
    }
    /// 1/a. Precondition: a is not 0.
    constexpr word inverse(word a) const { return power(a, p_ - 2); }

  private:
    word p_, negative_inverse_ = 0, one_ = 0, square_ = 0;
};

/// Miller–Rabin. Precondition: n odd, 37 < n < 2^62; then these bases are a proof (J. Sorenson, J.
/// Webster, Strong pseudoprimes to twelve prime bases, Math. Comp. 86, 2017).
constexpr bool is_prime(std::uint64_t n) {
    const prime_field field(n);
    const std::uint64_t minus_one = field.subtract(0, field.one());
    std::uint64_t odd = n - 1;
    int twos = 0;
    for (; odd % 2 == 0; odd /= 2) ++twos;
    for (const unsigned base : {2U, 3U, 5U, 7U, 11U, 13U, 17U, 19U, 23U, 29U, 31U, 37U}) {
        std::uint64_t x = field.power(field.to_form(base), odd);
        bool passed = x == field.one() || x == minus_one;
        for (int i = 1; i < twos && !passed; ++i) {
            x = field.multiply(x, x);
            passed = x == minus_one;
        }
        if (!passed) return false;
    }
    return true;
}

/// The largest primes below 2^62, descending.
inline constexpr std::array large_primes = [] {
    std::array<std::uint64_t, 4> primes{57, 87, 117, 143};
    for (auto& p : primes) p = (std::uint64_t(1) << 62) - p;
    return primes;
}();
static_assert(std::all_of(large_primes.begin(), large_primes.end(), is_prime));

/// The largest prime below p. Precondition: as is_prime, for the result.
constexpr std::uint64_t prime_before(std::uint64_t p) {
    do p -= 2;
    while (!is_prime(p));
    return p;
}

inline std::vector<std::uint64_t> derivative(const prime_field& field,
                                             const std::vector<std::uint64_t>& p) {
    std::vector<std::uint64_t> d;
    if (p.size() > 1) d.reserve(p.size() - 1);
    std::uint64_t power = 0;
    for (std::size_t i = 1; i < p.size(); ++i) {
        power = field.add(power, field.one());
        d.push_back(field.multiply(p[i], power));
    }
    while (!d.empty() && d.back() == 0) d.pop_back();
    return d;
}

/// A nonzero multiple of the greatest common divisor modulo p, in the power basis and Montgomery's
/// form. Precondition: last coefficients are not 0. Proof: proofs/roots/CommonFactor.v,
/// images_in_ideal.
inline std::vector<std::uint64_t> common_factor(const prime_field& field,
                                                std::vector<std::uint64_t> a,
                                                std::vector<std::uint64_t> b, work_meter& meter) {
    if (a.size() < b.size()) std::swap(a, b);
    while (!b.empty()) {
        if (b.size() == 1) return b;
        // There is a division step for each degree. If b is monic, a step scales no other
        // coefficients.
        if (a.size() > b.size() + 64) {
            const std::uint64_t inverse = field.inverse(b.back());
            for (std::uint64_t& c : b) c = field.multiply(c, inverse);
        }
        while (a.size() >= b.size()) {
            const std::uint64_t lead = b.back(), factor = a.back();
            const std::size_t shift = a.size() - b.size();
            a.pop_back();
            meter.spend(operations_of_product * (b.size() + (lead == field.one() ? 0 : shift)));
            if (lead != field.one())
                for (std::size_t i = 0; i < shift; ++i) a[i] = field.multiply(a[i], lead);
            for (std::size_t i = 0; i + 1 < b.size(); ++i)
                a[i + shift] = field.multiply_and_subtract(a[i + shift], lead, factor, b[i]);
            while (!a.empty() && a.back() == 0) a.pop_back();
        }
        std::swap(a, b);
    }
    return a;
}

}  // namespace errbound::roots
