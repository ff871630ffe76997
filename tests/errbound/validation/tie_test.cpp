// The rules and functions by them in float and double, and integers of words, against the proofs'
// table: tie.hpp.
#include "tests/errbound/validation/tie.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <errbound/integers/fixed_integer.hpp>
#include <errbound/integers/long_integer.hpp>
#include <string>
#include <vector>

#include "tests/errbound/validation/tie_functions.hpp"

namespace {

using tie::hash;
using tie::read_table;
using tie::sequence;
using tie::table;

TEST(Tie, Float) {
    tie::expect_the_proofs_results<float>();
    tie::expect_the_proofs_functions<float>();
}
TEST(Tie, Double) {
    tie::expect_the_proofs_results<double>();
    tie::expect_the_proofs_functions<double>();
}

/// Integers of words, and what their operations make of them.
template <int Words>
class integer_cases {
    using integer = errbound::integers::fixed_integer<Words>;

  public:
    explicit integer_cases(const table& expected) : expected_(expected) {
        sequence numbers(Words);
        for (int i = 0; i < 24; ++i) {
            std::array<std::uint64_t, Words> words;
            for (auto& w : words) w = word(numbers);
            values_.push_back(integer::from_words(words));
        }
    }
    void expect_the_proofs_results() {
        of_two("sum", [](hash& h, const integer& x, const integer& y) { put(h, x + y); });
        of_two("difference", [](hash& h, const integer& x, const integer& y) { put(h, x - y); });
        of_two("product", [](hash& h, const integer& x, const integer& y) { put(h, x * y); });
        of_two("sparse_product", [](hash& h, const integer& x, const integer& y) {
            if (y == integer()) return;
            std::array<std::uint64_t, 2 * Words> r{};
            const auto a = words_of(x), b = words_of(y);
            errbound::integers::words::multiply_sparse(r.data(), a.data(), Words, b.data(), Words);
            put(h, errbound::integers::fixed_integer<2 * Words>::from_words(r));
        });
        of_two("compare", [](hash& h, const integer& x, const integer& y) {
            h.put(x < y ? 0 : x == y ? 1 : 2);
        });
        of_bits("bit_length", 0, [](hash& h, const integer& x, int) {
            h.put(static_cast<std::uint32_t>(x.bit_length()));
        });
        of_bits("shift", 63, [](hash& h, const integer& x, int bits) { put(h, x << bits); });
        of_bits("from_bit", 64 * Words + 70, [](hash& h, const integer& x, int bits) {
            put(h, x.template from_bit<Words>(bits));
            put(h, x.template from_bit<1>(bits));
        });
        of_bits("shifted", 64 * Words + 70,
                [](hash& h, const integer& x, int bits) { put(h, integer::shifted(x[0], bits)); });
    }

  private:
    static std::uint64_t word(sequence& numbers) {
        const std::uint64_t kind = numbers.draw(8);
        const std::uint64_t upper = numbers.draw(std::uint64_t{1} << 32);
        const std::uint64_t lower = numbers.draw(std::uint64_t{1} << 32);
        switch (kind) {
            case 0:
            case 1:
                return 0;
            case 2:
            case 3:
                return ~std::uint64_t{0};
            case 4:
                return 1;
            case 5:
                return std::uint64_t{1} << 63;
            default:
                return upper << 32 | lower;
        }
    }
    static std::array<std::uint64_t, Words> words_of(const integer& x) {
        std::array<std::uint64_t, Words> all;
        for (int i = 0; i < Words; ++i) all[static_cast<std::size_t>(i)] = x[i];
        return all;
    }
    template <int N>
    static void put(hash& h, const errbound::integers::fixed_integer<N>& x) {
        for (int i = 0; i < N; ++i) {
            h.put(static_cast<std::uint32_t>(x[i] >> 32));
            h.put(static_cast<std::uint32_t>(x[i]));
        }
    }
    template <class Case>
    void of_two(const std::string& name, Case run) const {
        hash h;
        for (const integer& x : values_)
            for (const integer& y : values_) run(h, x, y);
        compare(name, values_.size() * values_.size(), h);
    }
    /// Of every number of bits up to `most`.
    template <class Case>
    void of_bits(const std::string& name, int most, Case run) const {
        hash h;
        for (const integer& x : values_)
            for (int bits = 0; bits <= most; ++bits) run(h, x, bits);
        compare(name, values_.size() * static_cast<std::size_t>(most + 1), h);
    }
    void compare(const std::string& name, std::uint64_t cases, const hash& h) const {
        const auto line = expected_.find("fixed_integer<" + std::to_string(Words) + "> " + name);
        ASSERT_NE(line, expected_.end()) << name;
        EXPECT_EQ(line->second.cases, cases) << name;
        EXPECT_EQ(line->second.hash, h.value()) << Words << " words, " << name;
    }

    const table& expected_;
    std::vector<integer> values_;
};

TEST(Tie, IntegersOfWords) {
    const table expected = read_table();
    integer_cases<1>(expected).expect_the_proofs_results();
    integer_cases<2>(expected).expect_the_proofs_results();
    integer_cases<3>(expected).expect_the_proofs_results();
    integer_cases<4>(expected).expect_the_proofs_results();
}

}  // namespace
