// Operations on integers of one to four words, whose words are often all zeros or all ones,
// compared with the proofs' table.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <errbound/integers/fixed_integer.hpp>
#include <errbound/integers/long_integer.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/proofs/table.hpp"

namespace tie {

template <int Words>
class word_cases {
    using integer = errbound::integers::fixed_integer<Words>;

  public:
    word_cases() {
        sequence numbers(Words);
        for (int i = 0; i < 24; ++i) {
            std::array<std::uint64_t, Words> words;
            for (auto& w : words) w = word(numbers);
            values_->push_back(integer::from_words(words));
        }
    }
    std::vector<line> lines() {
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
        return std::move(lines_);
    }

  private:
    static std::uint64_t word(sequence& numbers) {
        const std::uint64_t kind = numbers.draw(8);
        const std::uint64_t upper = numbers.draw(std::uint64_t{1} << 32);
        const std::uint64_t lower = numbers.draw(std::uint64_t{1} << 32);
        return kind < 2    ? 0
               : kind < 4  ? ~std::uint64_t{0}
               : kind == 4 ? 1
               : kind == 5 ? std::uint64_t{1} << 63
                           : upper << 32 | lower;
    }
    static std::array<std::uint64_t, Words> words_of(const integer& x) {
        std::array<std::uint64_t, Words> all;
        for (int i = 0; i < Words; ++i) all[static_cast<std::size_t>(i)] = x[i];
        return all;
    }
    template <int N>
    static void put(hash& h, const errbound::integers::fixed_integer<N>& x) {
        for (int i = 0; i < N; ++i) h.put_both(x[i]);
    }
    template <class Case>
    void of_two(const std::string& name, Case run) {
        add(name, values_->size(), [values = values_, run](hash& h, std::uint64_t i) {
            run(h, (*values)[i / values->size()], (*values)[i % values->size()]);
        });
    }
    /// Adds the cases of each value with each number of bits up to `most`.
    template <class Case>
    void of_bits(const std::string& name, int most, Case run) {
        const auto counts = static_cast<std::uint64_t>(most) + 1;
        add(name, counts, [values = values_, run, counts](hash& h, std::uint64_t i) {
            run(h, (*values)[i / counts], static_cast<int>(i % counts));
        });
    }
    /// `each` is the number of cases of each value.
    template <class Case>
    void add(const std::string& name, std::uint64_t each, Case put_case) {
        lines_.push_back({"fixed_integer<" + std::to_string(Words) + "> " + name,
                          values_->size() * each, std::move(put_case)});
    }

    std::shared_ptr<std::vector<integer>> values_ = std::make_shared<std::vector<integer>>();
    std::vector<line> lines_;
};

inline std::vector<line> lines_of_words() {
    std::vector<line> all;
    for (auto& some : {word_cases<1>().lines(), word_cases<2>().lines(), word_cases<3>().lines(),
                       word_cases<4>().lines()})
        all.insert(all.end(), some.begin(), some.end());
    return all;
}

}  // namespace tie
