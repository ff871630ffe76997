// Checks at compile time that an expression returns `uncertain` where it must. The expression runs
// on *suppositions*, which are signs of all numbers whose signs it evaluates. With each, it runs
// again for at most six of these numbers, with that sign uncertain: the answer must be the same, or
// uncertain. Correct expressions pass for every supposition, even one that no points realise.
//
// Numbers are identified by their values modulo a prime, at hashed coordinates. Equal polynomials
// have equal values, others with probability degree/2^31.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <errbound/filters/expression_count.hpp>
#include <errbound/sign.hpp>

namespace errbound::filters {

/// Pseudorandom bits. Source: Steele, Lea, Flood 2014 (SplitMix64).
constexpr std::uint64_t hashed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
    x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
    return x ^ (x >> 31);
}

/// The number of suppositions of an expression that branches; at least find_fault's largest stride.
inline constexpr std::size_t suppositions = 64;
static_assert((counting_run::max_signs + 5) / 6 <= suppositions);

/// The signs of one run. In odd suppositions the first 0 to 15 different numbers are zero, since
/// degenerate cases branch deepest. All other signs are hashes of the number and the supposition.
struct supposed_signs {
    /// Beyond any int, so no constant of an expression is a multiple. Products of residues fit.
    static constexpr std::uint64_t prime = (std::uint64_t{1} << 32) - 5;

    std::uint64_t supposition;
    /// Residues up to prime/2 in evaluation order, with repetitions, from the first run.
    std::array<std::uint64_t, counting_run::max_signs> numbers{};
    std::size_t size = 0;
    std::uint64_t unknown = 0;  ///< the number with uncertain sign; 0 in the first run: none
    int evaluated = 0;          ///< signs evaluated in this run
    /// The numbers supposed to be zero, each in the first free slot from its last bits on.
    std::array<std::uint64_t, 32> zeros{};
    std::size_t zero_count = 0;

    /// The sign of a residue. Opposite numbers have opposite signs.
    constexpr sign_type sign(std::uint64_t residue) {
        if (residue == 0) return sign_type::zero;
        if (evaluated++ == counting_run::max_signs) too_many_signs();
        const bool opposite = residue > prime / 2;
        const std::uint64_t number = opposite ? prime - residue : residue;
        if (number == unknown) return sign_type::uncertain;
        if (unknown == 0) numbers[size++] = number;
        if (is_zero(number)) return sign_type::zero;
        const auto s = static_cast<sign_type>(hashed(number ^ (supposition << 32)) % 3);
        return opposite ? -s : s;
    }

  private:
    constexpr bool is_zero(std::uint64_t number) {
        if (supposition % 2 == 0) return false;
        std::size_t slot = number % 32;
        for (; zeros[slot] != 0; slot = (slot + 1) % 32)
            if (zeros[slot] == number) return true;
        if (zero_count == supposition / 2 % 16) return false;
        ++zero_count;
        zeros[slot] = number;
        return true;
    }
};

/// A residue. An aggregate: in constant evaluation constructors cost as much as operations.
struct supposed_number {
    static constexpr std::uint64_t prime = supposed_signs::prime;

    supposed_signs* signs;
    std::uint64_t residue;

    static constexpr std::uint64_t residue_of(int c) {
        return static_cast<std::uint64_t>(c + std::int64_t{prime} * 2) % prime;
    }

    friend constexpr supposed_number operator+(const supposed_number& x, const supposed_number& y) {
        return {x.signs, (x.residue + y.residue) % prime};
    }
    friend constexpr supposed_number operator-(const supposed_number& x, const supposed_number& y) {
        return {x.signs, (x.residue + (prime - y.residue)) % prime};
    }
    friend constexpr supposed_number operator*(const supposed_number& x, const supposed_number& y) {
        return {x.signs, x.residue * y.residue % prime};
    }
    friend constexpr supposed_number operator+(const supposed_number& x, std::same_as<int> auto c) {
        return x + supposed_number{x.signs, residue_of(c)};
    }
    friend constexpr supposed_number operator+(std::same_as<int> auto c, const supposed_number& x) {
        return x + c;
    }
    friend constexpr supposed_number operator-(const supposed_number& x, std::same_as<int> auto c) {
        return x - supposed_number{x.signs, residue_of(c)};
    }
    friend constexpr supposed_number operator-(std::same_as<int> auto c, const supposed_number& x) {
        return supposed_number{x.signs, residue_of(c)} - x;
    }
    friend constexpr supposed_number operator*(const supposed_number& x, std::same_as<int> auto c) {
        return x * supposed_number{x.signs, residue_of(c)};
    }
    friend constexpr supposed_number operator*(std::same_as<int> auto c, const supposed_number& x) {
        return x * c;
    }
    constexpr supposed_number operator-() const { return {signs, (prime - residue) % prime}; }
    friend constexpr sign_type sign_of(const supposed_number& x) {
        return x.signs->sign(x.residue);
    }
};

enum class expression_fault : std::uint8_t { none, asks_nothing, gives_up, acts_on_uncertain };

/// The fault that one supposition shows, if any. `run(supposed_signs&)` returns the answer's sign.
template <class Run>
constexpr expression_fault find_fault(std::uint64_t supposition, const Run& run) {
    supposed_signs signs{supposition};
    const sign_type answer = run(signs);
    if (signs.size == 0) return expression_fault::asks_nothing;
    if (!certain(answer)) return expression_fault::gives_up;
    // Makes every stride-th sign uncertain, at most six. `first` takes each value below 64 once, so
    // each sign is uncertain in some supposition, if all evaluate the same signs. Even suppositions
    // have the values below 32; odd ones, with zeros, have the others.
    const std::size_t stride = (signs.size + 5) / 6;
    const std::uint64_t first = supposition % 2 * 32 + supposition / 2 % 16 * 2 + supposition / 32;
    for (auto k = static_cast<std::size_t>(first % stride); k < signs.size; k += stride) {
        signs.unknown = signs.numbers[k];
        signs.evaluated = 0;
        const sign_type other = run(signs);
        if (certain(other) && other != answer) return expression_fault::acts_on_uncertain;
    }
    return expression_fault::none;
}

}  // namespace errbound::filters
