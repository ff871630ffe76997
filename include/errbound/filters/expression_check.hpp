// Whether an expression passes on what is uncertain, found at compile time.
//
// The expression is run on signs that are supposed: one for each number whose sign it asks, the
// same wherever it asks again. Then it is run once more for each of these, with that sign
// uncertain. Its answer may not depend on a sign that it does not know, so that the second answer
// must be the first, or uncertain. A right expression passes for every supposition, also for one
// that no points have: whoever returns what is uncertain at once never acts on it.
//
// Numbers are recognised by their values modulo a prime, at coordinates made of a hash: expressions
// that are equal as polynomials have equal values, others with a probability of degree/2^31.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <errbound/filters/expression_count.hpp>
#include <errbound/sign.hpp>

namespace errbound::filters {

/// Bits that look random. Source: Steele, Lea, Flood 2014, Fast splittable pseudorandom number
/// generators (SplitMix64).
constexpr std::uint64_t hashed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
    x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
    return x ^ (x >> 31);
}

/// How many are tried.
inline constexpr std::size_t suppositions = 64;

/// Signs of numbers, given as they are asked for. In every other supposition the first are zero:
/// cases where much is zero are the deepest.
struct supposed_signs {
    /// Beyond any int, so that no number of an expression is a multiple; residues' products fit.
    static constexpr std::uint64_t prime = (std::uint64_t{1} << 32) - 5;

    std::uint64_t supposition;
    std::array<std::uint64_t, counting_run::max_signs> numbers{};  ///< residues up to prime/2
    std::array<sign_type, counting_run::max_signs> signs{};
    std::size_t size = 0;
    std::size_t unknown = numbers.size();  ///< the number whose sign is uncertain
    int asked = 0;                         ///< in this run

    /// Of a residue. Opposite numbers have opposite signs.
    constexpr sign_type sign(std::uint64_t residue) {
        if (residue == 0) return sign_type::zero;
        if (asked++ == counting_run::max_signs) too_many_signs();
        const bool opposite = residue > prime / 2;
        const std::uint64_t number = opposite ? prime - residue : residue;
        std::size_t i = 0;
        while (i < size && numbers[i] != number) ++i;
        if (i == unknown) return sign_type::uncertain;
        if (i == size) {
            signs[i] = made_up(number);
            numbers[size++] = number;
        }
        return opposite ? -signs[i] : signs[i];
    }

  private:
    constexpr sign_type made_up(std::uint64_t number) const {
        const std::uint64_t zeros = supposition % 2 == 0 ? 0 : supposition / 2 % 16;
        if (size < zeros) return sign_type::zero;
        return static_cast<sign_type>(hashed(number ^ (supposition << 32)) % 3);
    }
};

/// A number of the expression: its residue.
class supposed_number {
  public:
    /// A coordinate, the one of this index among all.
    constexpr supposed_number(supposed_signs& signs, std::uint64_t index)
        : signs_(&signs), residue_(hashed(index) % prime) {}
    constexpr supposed_number(std::same_as<int> auto c)
        : residue_(static_cast<std::uint64_t>(c + std::int64_t{prime} * 2) % prime) {}

    friend constexpr supposed_number operator+(const supposed_number& x, const supposed_number& y) {
        return {x.signs_ != nullptr ? x.signs_ : y.signs_, x.residue_ + y.residue_, modulo_prime};
    }
    friend constexpr supposed_number operator-(const supposed_number& x, const supposed_number& y) {
        return x + -y;
    }
    friend constexpr supposed_number operator*(const supposed_number& x, const supposed_number& y) {
        return {x.signs_ != nullptr ? x.signs_ : y.signs_, x.residue_ * y.residue_, modulo_prime};
    }
    constexpr supposed_number operator-() const { return {signs_, prime - residue_, modulo_prime}; }
    friend constexpr sign_type sign_of(const supposed_number& x) {
        return x.signs_->sign(x.residue_);
    }

  private:
    static constexpr std::uint64_t prime = supposed_signs::prime;
    static constexpr struct reduction {
    } modulo_prime{};

    constexpr supposed_number(supposed_signs* signs, std::uint64_t value, reduction)
        : signs_(signs), residue_(value % prime) {}

    supposed_signs* signs_ = nullptr;
    std::uint64_t residue_;
};

enum class expression_fault : std::uint8_t { none, asks_nothing, gives_up, acts_on_uncertain };

/// The fault of an expression, if one supposition shows it. `run(supposed_signs&)`
/// runs the expression and returns its answer, of a number the sign.
template <class Run>
constexpr expression_fault find_fault(std::uint64_t supposition, const Run& run) {
    supposed_signs signs{supposition};
    const sign_type answer = run(signs);
    if (signs.size == 0) return expression_fault::asks_nothing;
    if (!certain(answer)) return expression_fault::gives_up;
    // Of many signs each has its turn by some supposition.
    const std::size_t stride = (signs.size + 5) / 6, last = signs.size;
    for (auto k = static_cast<std::size_t>(hashed(supposition) % stride); k < last; k += stride) {
        signs.unknown = k;
        signs.asked = 0;
        const sign_type other = run(signs);
        if (certain(other) && other != answer) return expression_fault::acts_on_uncertain;
    }
    return expression_fault::none;
}

}  // namespace errbound::filters
