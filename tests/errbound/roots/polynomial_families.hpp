// Families of polynomials that are hard for root isolation, for tests and benchmarks.
#pragma once

#include <array>
#include <boost/multiprecision/gmp.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <errbound/integers/integer.hpp>
#include <errbound/multiprecision.hpp>
#include <errbound/roots/integer_polynomial.hpp>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

namespace polynomial_families {

using integer =
    boost::multiprecision::number<boost::multiprecision::gmp_int, boost::multiprecision::et_off>;

/// Coefficients ascend. `whole` is a positive multiple of `doubles`, which may be empty.
struct sample {
    std::vector<integer> whole;
    std::vector<double> doubles = {};
};

/// The same coefficients in another type of integers.
template <class Integer>
std::vector<Integer> in(const std::vector<integer>& whole) {
    std::vector<Integer> c;
    for (const integer& x : whole) {
        if constexpr (std::is_same_v<Integer, errbound::integer>)
            c.push_back(Integer::from_string(x.str()));
        else
            c.emplace_back(x);
    }
    return c;
}

enum class family {
    random,     ///< uniform coefficients
    wide,       ///< exponents of any double
    separated,  ///< rounded products of random linear and quadratic factors
    clustered,  ///< dyadic roots, some closer than the others by up to 2^40
    multiple,   ///< small rational and quadratic irrational roots, most of them multiple
    bernstein,  ///< few-valued Bernstein coefficients on [0, 1], ill-conditioned elsewhere
    wilkinson,  ///< Π (x − k), or with one coefficient changed in its last place
    chebyshev,  ///< all roots in (−1, 1), and shifted by less than an extremum's size
    mignotte,   ///< x^n − 2(ax − 1)²: two roots very close to 1/a
};
inline constexpr std::array all{family::random,    family::wide,      family::separated,
                                family::clustered, family::multiple,  family::bernstein,
                                family::wilkinson, family::chebyshev, family::mignotte};
inline constexpr const char* names[] = {"random",    "wide",      "separated",
                                        "clustered", "multiple",  "bernstein",
                                        "wilkinson", "chebyshev", "mignotte"};

/// Degrees from 1 up to `most`, or up to 8 where integers have thousands of bits.
constexpr int degree_of_sample(family f, int k, int most) {
    return 1 + k % (f == family::wide && most > 8 ? 8 : most);
}

/// (ax − 1)(x^n − (ax − 1)), n >= 3: its roots 1/a and about 1/a + a^(−n − 1).
inline std::vector<double> close_pair(std::size_t n, double a) {
    std::vector<double> c(n + 2);
    c[0] = -1;
    c[1] = 2 * a;
    c[2] = -a * a;
    c[n] -= 1;
    c[n + 1] = a;
    return c;
}

class generator {
  public:
    explicit generator(std::uint64_t seed) : random_(seed) {}

    /// From −bound to bound.
    int small(int bound) {
        return static_cast<int>(random_() % static_cast<unsigned>(2 * bound + 1)) - bound;
    }
    double uniform() { return std::ldexp(static_cast<double>(random_() >> 11), -52) - 1; }
    /// Any finite double, subnormal ones and zeros among them.
    double any_double() {
        if (random_() % 16 == 0) return 0;
        return std::ldexp(uniform(), static_cast<int>(random_() % 2098) - 1074);
    }

    /// A sample of this degree >= 1; for `multiple`, of at most this degree or 2.
    sample make(family f, int degree) {
        const auto n = static_cast<std::size_t>(degree);
        switch (f) {
            case family::random:
                return random(n);
            case family::wide:
                return wide(n);
            case family::separated:
                return separated(n);
            case family::clustered:
                return clustered(n);
            case family::multiple:
                return multiple(n);
            case family::bernstein:
                return bernstein(n);
            case family::wilkinson:
                return wilkinson(degree);
            case family::chebyshev:
                return chebyshev(degree);
            default:
                return mignotte(n);
        }
    }

    template <class C>
    static std::vector<C> product(const std::vector<C>& a, const std::vector<C>& b) {
        std::vector<C> r(a.size() + b.size() - 1);
        for (std::size_t i = 0; i < a.size(); ++i)
            for (std::size_t j = 0; j < b.size(); ++j) r[i + j] += a[i] * b[j];
        return r;
    }

    static sample of_doubles(std::vector<double> c) {
        if (c.back() == 0) c.back() = 1;
        int unit = std::numeric_limits<int>::max();
        for (const double x : c)
            unit = std::min(unit, errbound::integers::binary_double(x).last_bit());
        std::vector<integer> whole;
        for (const double x : c) whole.push_back(errbound::dyadic<integer>::from(x).in_units(unit));
        return {whole, std::move(c)};
    }

  private:
    sample random(std::size_t n) {
        std::vector<double> c(n + 1);
        for (double& x : c) x = uniform();
        return of_doubles(c);
    }
    sample wide(std::size_t n) {
        std::vector<double> c(n + 1);
        for (double& x : c) x = any_double();
        return of_doubles(c);
    }
    sample separated(std::size_t n) {
        std::vector<double> c{1};
        while (c.size() <= n) {
            const double r = 4 * uniform();
            const bool pair = c.size() < n && random_() % 3 == 0;
            c = pair ? product(c, {r * r + 1 + uniform(), -2 * r, 1}) : product(c, {-r, 1});
        }
        return of_doubles(c);
    }
    sample clustered(std::size_t n) {
        std::vector<integer> c{1};
        integer near = small(100);
        int bits = 4;
        while (c.size() <= n) {
            // The root near/2^bits.
            c = product(c, {integer(-near), integer(1) << static_cast<unsigned>(bits)});
            const int closer = static_cast<int>(random_() % 3) * 10;
            if (closer == 0 || bits + closer > 44) {
                near = small(100);
                bits = 4;
            } else {
                near = (near << static_cast<unsigned>(closer)) + small(3);
                bits += closer;
            }
        }
        return {c};
    }
    sample multiple(std::size_t n) {
        std::vector<integer> c{1};
        while (c.size() <= n) {
            const std::vector<integer> factor =
                random_() % 3 == 0
                    ? std::vector<integer>{small(6), small(6), 1 + small(1)}
                    : std::vector<integer>{small(8), 1 + static_cast<int>(random_() % 4)};
            for (std::uint64_t m = 1 + random_() % 3; m > 0 && c.size() + factor.size() <= n + 2;
                 --m)
                c = product(c, factor);
            if (c.size() + 2 > n + 1) break;
        }
        errbound::roots::trim(c);
        return c.empty() ? sample{{1, 2, 1}} : sample{c};
    }
    sample bernstein(std::size_t n) {
        std::vector<integer> b(n + 1);
        for (integer& x : b) x = small(2);
        return {from_control_values(b)};
    }
    sample wilkinson(int degree) {
        std::vector<integer> c{1};
        for (int k = 1; k <= degree; ++k) c = product(c, {integer(-k), 1});
        if (random_() % 2 == 0) c[random_() % c.size()] += small(1);
        return {c};
    }
    sample chebyshev(int degree) {
        std::vector<integer> before{1}, c{0, 1};
        for (int k = 1; k < degree; ++k) {
            std::vector<integer> next = product(c, {0, 2});
            for (std::size_t i = 0; i < before.size(); ++i) next[i] -= before[i];
            before = std::move(c);
            c = std::move(next);
        }
        for (integer& x : c) x <<= 20U;
        c[0] += small(1 << 20);  // ±2^20 makes extrema double roots
        if (random_() % 4 == 0) c[0] = c[0] > 0 ? 1 << 20 : -(1 << 20);
        return {c};
    }
    sample mignotte(std::size_t n) {
        const integer a = 2 + static_cast<int>(random_() % 1000);
        std::vector<integer> c(std::max<std::size_t>(n, 3) + 1);
        c.back() = 1;
        c[0] = -2;
        c[1] = 4 * a;
        c[2] -= 2 * a * a;
        return {c};
    }

    /// Σ b_i C(n, i) x^i (1 − x)^(n−i)
    static std::vector<integer> from_control_values(const std::vector<integer>& b) {
        const int n = static_cast<int>(b.size()) - 1;
        std::vector<integer> sum(b.size());
        integer binomial = 1;
        for (int i = 0; i <= n; ++i) {
            std::vector<integer> term(static_cast<std::size_t>(i) + 1);
            term.back() = b[static_cast<std::size_t>(i)] * binomial;
            for (int k = i; k < n; ++k) term = product(term, {1, -1});
            for (std::size_t j = 0; j < term.size(); ++j) sum[j] += term[j];
            binomial = binomial * (n - i) / (i + 1);
        }
        if (sum.back() == 0) sum.back() = 1;
        return sum;
    }

    std::mt19937_64 random_;
};

}  // namespace polynomial_families
