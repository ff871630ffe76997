// Bound rule `stochastic`: stochastic arithmetic, which estimates errors and promises nothing. A
// number carries samples, computed with every operation randomly rounded up or down; their scatter
// estimates the rounding error. Use it to compare with bounds, or if bounds are too wide. Signs
// follow the estimate and may be wrong, so no predicate takes this rule. The estimate misses
// truncation errors and branches that samples do not take. `errbound validate` measures how often
// estimates are too small.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <errbound/error_free.hpp>
#include <errbound/rules/rule.hpp>
#include <utility>

namespace errbound {

/// Stochastic arithmetic with 2 to 8 samples. Cost: an error-free operation and a hash per sample.
/// A sample's operation is rounded to a neighbour of the exact result, at random and without bias
/// (Croci, Fasi, Higham, Mary, Mikaitis 2022; Parker's Monte Carlo arithmetic, 1997). The random
/// bits are a hash of the operands, the sample's index and Seed. So results are reproducible, a + b
/// and b + a agree, and b − a is −(a − b), as in Verrou's _det modes.
template <std::size_t Samples, std::uint64_t Seed = 0>
struct stochastic_of {
    static_assert(Samples >= 2 && Samples <= 8, "errbound: stochastic takes 2 to 8 samples");
    static constexpr const char* name = "stochastic";
    static constexpr error_meaning error_is = error_meaning::estimate;
    static constexpr double claimed_rate = 0.95;

    template <class T>
    struct bound {
        std::array<T, Samples> samples;
    };
    template <class T>
    using operand = rule_operand<T, stochastic_of>;

    template <class T>
    static constexpr bound<T> exact(const T& value) {
        return by_sample<T>([&](std::size_t) { return value; });
    }
    /// Spread evenly over value ± error; equal arguments give equal samples.
    template <class T>
    static constexpr bound<T> within(const T& value, const T& error) {
        return by_sample<T>([&](std::size_t k) {
            if (!(error >= 0)) return number_traits<T>::infinity();
            const double share = 2 * chance(hash<T>(value, error, k)) - 1;
            return T(value + detail::rounded_product(error, static_cast<T>(share)));
        });
    }
    /// CESTAC's estimate (Vignes 1993), |m| + τs/√N, for N samples: the mean m and standard
    /// deviation s of their deviations from the value, and Student's τ for 95 %. (CESTAC returns
    /// the mean instead of the value.)
    template <class T>
    static constexpr T error(const T& value, const bound<T>& b) {
        using traits = number_traits<T>;
        T largest(0);
        for (const T& sample : b.samples) {
            const T off = traits::abs(sample - value);
            if (!traits::is_finite(off)) return traits::infinity();
            largest = (traits::max)(largest, off);
        }
        if (largest == 0) return T(0);
        double sum = 0, squares = 0;
        for (const T& sample : b.samples) sum += static_cast<double>(T((sample - value) / largest));
        const double mean = sum / Samples;
        for (const T& sample : b.samples) {
            const double off = static_cast<double>(T((sample - value) / largest)) - mean;
            squares += detail::rounded_product(off, off);
        }
        const double spread =
            detail::rounded_product(students_t[Samples - 2],
                                    number_traits<double>::sqrt(squares / (Samples - 1) / Samples));
        return detail::rounded_product(largest, static_cast<T>((mean < 0 ? -mean : mean) + spread));
    }
    template <class T>
    static constexpr bound<T> negate(const bound<T>& b) {
        return by_sample<T>([&](std::size_t k) { return T(-b.samples[k]); });
    }

    template <class T>
    static constexpr bound<T> add(const T&, operand<T> a, operand<T> b) {
        return by_sample<T>(
            [&](std::size_t k) { return sum<T>(a.bound.samples[k], b.bound.samples[k], k); });
    }
    template <class T>
    static constexpr bound<T> subtract(const T&, operand<T> a, operand<T> b) {
        return by_sample<T>(
            [&](std::size_t k) { return sum<T>(a.bound.samples[k], T(-b.bound.samples[k]), k); });
    }
    template <class T>
    static constexpr bound<T> multiply(const T&, operand<T> a, operand<T> b) {
        return by_sample<T>([&](std::size_t k) {
            const T &x = a.bound.samples[k], &y = b.bound.samples[k];
            const with_error<T> product = two_product<T>(x, y);
            const std::uint64_t random = symmetric_hash<T>(x, y, k | of_product);
            return product_error_is_exact<T>(x, y, product)
                       ? at_random<T>(product.value, product.error, random)
                       : disturbed<T>(product.value, random);
        });
    }
    template <class T>
    static constexpr bound<T> divide(const T&, operand<T> a, operand<T> b) {
        return by_sample<T>([&](std::size_t k) {
            const T &x = a.bound.samples[k], &y = b.bound.samples[k];
            const T q = x / y;
            const division_remainder<T> division = remainder_of_division<T>(x, y, q);
            const std::uint64_t random =
                hash<T>(number_traits<T>::abs(x), number_traits<T>::abs(y), k | of_quotient);
            return division.exact ? at_random<T>(q, T(division.value / y), random)
                                  : disturbed<T>(q, random);
        });
    }
    template <class T>
    static constexpr bound<T> scale(const T&, operand<T> a, int e) {
        using traits = number_traits<T>;
        return by_sample<T>([&](std::size_t k) {
            const T& x = a.bound.samples[k];
            const T v = traits::scale(x, e);
            return e >= 0 || traits::scale(v, -e) == x
                       ? v
                       : disturbed<T>(v, hash<T>(traits::abs(x), T(0), k | of_scaling));
        });
    }

  private:
    /// Student's τ: two-sided 95 %, one to seven degrees of freedom.
    static constexpr std::array<double, 7> students_t{12.706, 4.303, 3.182, 2.776,
                                                      2.571,  2.447, 2.365};

    template <class T, class F>
    static constexpr bound<T> by_sample(const F& f) {
        return [&]<std::size_t... K>(std::index_sequence<K...>) {
            return bound<T>{{f(K)...}};
        }
        (std::make_index_sequence<Samples>());
    }

    template <class T>
    static constexpr T sum(const T& a, const T& b, std::size_t k) {
        const with_error<T> r = two_sum<T>(a, b);
        return at_random<T>(r.value, r.error, symmetric_hash<T>(a, b, k | of_sum));
    }
    /// More than half an ulp of v, so that v ± step rounds to v's neighbour.
    template <class T>
    static constexpr T step(const T& v) {
        using traits = number_traits<T>;
        return detail::rounded_product(T(traits::abs(v) * traits::unit_roundoff()), T(1.25)) +
               traits::underflow_unit();
    }
    /// v + error, rounded to v or its neighbour on that side.
    template <class T>
    static constexpr T at_random(const T& v, const T& error, std::uint64_t random) {
        if (error == 0 || !number_traits<T>::is_finite(error)) return v;
        const T neighbour = error > 0 ? v + step<T>(v) : v - step<T>(v);
        const T share = error / (neighbour - v);
        return share > static_cast<T>(chance(random)) ? neighbour : v;
    }
    /// v or, half the time, a neighbour; for errors unknown near underflow.
    template <class T>
    static constexpr T disturbed(const T& v, std::uint64_t random) {
        const T off = random >> 63 == 0 ? T(0) : step<T>(v);
        return (random >> 62 & 1) == 0 ? v - off : v + off;
    }

    /// Uniform in [0, 1).
    static constexpr double chance(std::uint64_t random) {
        return static_cast<double>(random >> 11) * 0x1p-53;
    }
    enum operation : std::uint64_t {
        of_sum = 0,
        of_product = 8,
        of_quotient = 16,
        of_scaling = 24
    };

    /// Independent of the operands' order and signs.
    template <class T>
    static constexpr std::uint64_t symmetric_hash(const T& a, const T& b, std::uint64_t which) {
        const T x = number_traits<T>::abs(a), y = number_traits<T>::abs(b);
        return x < y ? hash<T>(x, y, which) : hash<T>(y, x, which);
    }
    template <class T>
    static constexpr std::uint64_t hash(const T& a, const T& b, std::uint64_t which) {
        std::uint64_t h = mixed(Seed + 0x9e3779b97f4a7c15U * (which + 1));
        for (const T& x : {a, b}) {
            T left = x;
            for (int bits = 0; bits < number_traits<T>::digits; bits += 53) {
                const double part = static_cast<double>(left);
                h = mixed(h ^ std::bit_cast<std::uint64_t>(part));
                if constexpr (number_traits<T>::digits > 53) left = left - static_cast<T>(part);
            }
        }
        return h;
    }
    /// The last step of SplitMix64 (Steele, Lea, Flood 2014), a bijection.
    static constexpr std::uint64_t mixed(std::uint64_t z) {
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
        return z ^ (z >> 31);
    }
};

using stochastic = stochastic_of<3>;  ///< three samples, as CADNA uses

}  // namespace errbound
