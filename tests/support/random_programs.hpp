// Random programs of tracked numbers compared with exact rationals: after each operation the bound
// must hold, and a certain sign must be right.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <errbound/functions.hpp>
#include <errbound/multiprecision.hpp>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "tests/support/long_double.hpp"
#include "tests/support/special_values.hpp"

namespace support {

/// A tracked number and the exact number that it represents.
template <class Number>
struct sample {
    Number number;
    rational exact;
};

/// v with the bound `error`, and an exact number in that range, often at its end.
template <class Number>
sample<Number> sample_within(const typename Number::value_type& v,
                             const typename Number::value_type& error, std::mt19937_64& random) {
    const int quarters = random() % 2 ? 4 : static_cast<int>(random() % 9) - 4;
    return {Number::within(v, error), exactly(v) + exactly(error) * quarters / 4};
}

template <class Number>
bool claims_nothing(const Number& x) {
    using traits = errbound::number_traits<typename Number::value_type>;
    return !traits::is_finite(x.value()) || !traits::is_finite(x.error());
}

template <class Number>
void check(const sample<Number>& s, const std::string& context) {
    using T = typename Number::value_type;
    using errbound::sign_type;
    const sign_type sign = sign_of(s.number);
    ASSERT_TRUE(sign == sign_type::uncertain || sign == errbound::sign_of(s.exact)) << context;
    if (claims_nothing(s.number)) {
        // Bounds in a wider type can determine the sign even if the error overflows T.
        if (!errbound::detail::bounds_are_wider<T, typename Number::rule_type> ||
            !errbound::number_traits<T>::is_finite(s.number.value())) {
            ASSERT_EQ(sign, sign_type::uncertain) << context;
        }
        return;
    }
    ASSERT_GE(exactly(s.number.error()), 0) << context;
    const rational off = exactly(s.number.value()) - s.exact;
    ASSERT_LE(boost::multiprecision::abs(off), exactly(s.number.error()))
        << context << " value " << static_cast<double>(s.number.value()) << " error "
        << static_cast<double>(s.number.error());
}

/// `root` is the tracked root of a number that represents `square`.
template <class Number>
void check_root(const Number& root, const rational& square, const std::string& context) {
    if (claims_nothing(root)) return;
    const rational v = exactly(root.value()), e = exactly(root.error());
    ASSERT_GE(square, 0) << context;
    ASSERT_TRUE(v - e <= 0 || (v - e) * (v - e) <= square) << context;
    ASSERT_GE((v + e) * (v + e), square) << context;
}

/// Each step combines two earlier numbers. `draw(random)` makes a finite input.
template <class T, class Rule, class Draw>
class random_programs {
    using number = errbound::tracked<T, Rule>;
    using traits = errbound::number_traits<T>;
    using one = sample<number>;

  public:
    random_programs(std::uint64_t seed, Draw draw) : random_(seed), draw_(draw), seed_(seed) {}

    /// Skips roots, and ends each program before its numbers reach `most`.
    void stay_below(const T& most) { most_ = most; }

    void run(int programs) {
        for (int k = 0; k < programs && !testing::Test::HasFatalFailure(); ++k) {
            std::vector<one> pool;
            for (int i = 0; i < 4; ++i) pool.push_back(input());
            for (int step = 0; step < 7; ++step) {
                what_ = std::string(Rule::name) + " seed " + std::to_string(seed_) + " program " +
                        std::to_string(k) + " step " + std::to_string(step);
                const auto next =
                    combined(pool[random_() % pool.size()], pool[random_() % pool.size()]);
                if (!next) continue;
                if (most_ &&
                    !(traits::abs(next->number.value()) < *most_ && next->number.error() < *most_))
                    break;
                check(*next, what_);
                if (testing::Test::HasFatalFailure()) return;
                pool.push_back(*next);
            }
        }
    }

  private:
    one input() {
        const T v = draw_(random_);
        if (random_() % 2) return {number(v), exactly(v)};
        const T relative = traits::scale(traits::abs(v), -static_cast<int>(random_() % 150));
        return sample_within<number>(v, random_() % 4 ? relative : traits::abs(draw_(random_)),
                                     random_);
    }
    /// Empty for a division by zero, and for operations that T or the rule lacks.
    std::optional<one> combined(const one& a, const one& b) {
        switch (random_() % 8) {
            case 0:
                return one{a.number + b.number, a.exact + b.exact};
            case 1:
                return one{a.number - b.number, a.exact - b.exact};
            case 2:
            case 3:
                return one{a.number * b.number, a.exact * b.exact};
            case 4: {
                const int e = static_cast<int>(random_() % 200) - 100;
                return one{scale(-a.number, e), -a.exact * power_of(2, e)};
            }
            case 5:
                if constexpr (errbound::has_subnormals<T> && fuses<T>) {
                    const one& c = random_() % 2 ? a : b;
                    return one{fma(a.number, b.number, -c.number), a.exact * b.exact - c.exact};
                }
                break;
            case 6:
                if constexpr (errbound::has_subnormals<T>)
                    if (!most_) check_root(sqrt(a.number), a.exact, what_);
                break;
            default:
                if constexpr (errbound::detail::rule_divides<Rule, T>)
                    if (b.exact != 0) return one{a.number / b.number, a.exact / b.exact};
        }
        return std::nullopt;
    }

    std::mt19937_64 random_;
    Draw draw_;
    std::uint64_t seed_;
    std::optional<T> most_;
    std::string what_;
};

}  // namespace support
