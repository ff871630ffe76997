// A scalar without values. Its name is the operation that made it and the names of its operands,
// and its sign is a random function of its name. If an algorithm over symbols returns the results
// of the proofs' definition, it computes the same expressions and evaluates the same signs.
#pragma once

#include <cstdint>
#include <errbound/bernstein.hpp>
#include <errbound/sign.hpp>

namespace tie {

/// The rates of zero and of uncertain signs, in 64ths, and of positive ones among the others.
struct sign_rates {
    std::uint64_t zero, uncertain, positive;
    std::uint64_t of_difference;  ///< rate of uncertain signs of differences
};

class symbol {
  public:
    symbol() = default;
    explicit symbol(int n) : symbol(by::whole, static_cast<std::uint64_t>(n), 0) {}
    /// Input number `index` of a case.
    static symbol given(std::uint64_t index) { return {by::given, seed, index}; }

    friend symbol operator+(const symbol& a, const symbol& b) {
        return {by::sum, a.name_, b.name_};
    }
    friend symbol operator-(const symbol& a, const symbol& b) {
        return {by::difference, a.name_, b.name_};
    }
    friend symbol operator*(const symbol& a, const symbol& b) {
        return {by::product, a.name_, b.name_};
    }
    friend symbol operator-(const symbol& a) { return {by::opposite, a.name_, 0}; }
    friend symbol scale(const symbol& a, int e) {
        return {by::scale, a.name_, static_cast<std::uint64_t>(e)};
    }
    template <int N>
    friend errbound::bernstein<symbol, N> normalized(const errbound::bernstein<symbol, N>& p) {
        errbound::bernstein<symbol, N> r;
        for (int i = 0; i <= N; ++i) r[i] = symbol(by::normalized, p[i].name_, 0);
        return r;
    }
    friend errbound::sign_type sign_of(const symbol& x) {
        using errbound::sign_type;
        const std::uint64_t drawn = mixed(x.name_, seed, 9) >> 20;
        const bool difference = (x.name_ & 7) == std::uint64_t(by::difference);
        const std::uint64_t uncertain = difference ? rates.of_difference : rates.uncertain;
        const std::uint64_t first = drawn & 63, second = drawn >> 6 & 63;
        if (first < rates.zero) return sign_type::zero;
        if (first < rates.zero + uncertain) return sign_type::uncertain;
        return second < rates.positive ? sign_type::positive : sign_type::negative;
    }
    std::uint64_t name() const { return name_; }

    /// The case's seed of names and signs.
    inline static std::uint64_t seed = 0;
    inline static sign_rates rates{};

  private:
    enum class by { sum, difference, product, opposite, whole, scale, normalized, given };
    symbol(by operation, std::uint64_t a, std::uint64_t b)
        : name_((mixed(a, b, std::uint64_t(operation)) & ~std::uint64_t{7}) |
                std::uint64_t(operation)) {}

    /// A hash modulo 2^62.
    static std::uint64_t mixed(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
        constexpr std::uint64_t modulus = (std::uint64_t{1} << 62) - 1;
        std::uint64_t h =
            (a * 3935559000370003845U + b * 2691343689449507681U + c * 2177342782468422677U + 1) &
            modulus;
        h ^= h >> 31;
        h = h * 3935559000370003845U & modulus;
        return h ^ h >> 30;
    }

    std::uint64_t name_ = 0;
};

}  // namespace tie
