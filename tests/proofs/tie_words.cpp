// Compares integers of variable length, whose words are often all zeros or all ones, with the
// proofs' definitions on the same numbers (proofs/tie/tie_words.ml).
#include <array>
#include <cstddef>
#include <cstdint>
#include <errbound/integers/fixed_integer.hpp>
#include <errbound/integers/long_integer.hpp>
#include <errbound/sign.hpp>
#include <vector>

#include "tests/proofs/table.hpp"

namespace {

using tie::hash;
using word = std::uint64_t;

constexpr int capacity = 12;
using number = errbound::integers::long_integer<capacity>;
/// A width that every result fits.
using wide_number = errbound::integers::long_integer<2 * capacity>;

void put_int(hash& h, int n) {
    h.put(static_cast<std::uint32_t>(n));
}
template <int Words>
void put(hash& h, const errbound::integers::long_integer<Words>& x) {
    put_int(h, x.size());
    for (int i = 0; i < x.size(); ++i) h.put_both(x[i]);
}

int draw(tie::sequence& s, int n) {
    return static_cast<int>(s.draw(static_cast<std::uint64_t>(n)));
}
word drawn_word(tie::sequence& s, int seldom) {
    if (draw(s, seldom) > 0) return draw(s, 2) == 0 ? 0 : ~word{0};
    const int kind = draw(s, 4);
    if (kind < 2) return kind == 0 ? 1 : word{1} << 63;
    const word upper = s.draw(word{1} << 32), lower = s.draw(word{1} << 32);
    return upper << 32 | lower;
}
number drawn_number(tie::sequence& s) {
    const int seldom = 1 + draw(s, 6), size = 1 + draw(s, capacity);
    std::array<word, capacity> all;
    for (int i = 0; i < capacity; ++i) {
        word& w = all[static_cast<std::size_t>(i)];
        w = i < size                                     ? drawn_word(s, seldom)
            : all[static_cast<std::size_t>(i - 1)] >> 63 ? ~word{0}
                                                         : 0;
    }
    return errbound::integers::fixed_integer<capacity>::from_words(all);
}

/// Also in a number that it just fits.
void put_fitting(hash& h, const wide_number& wide, const number& narrow) {
    put(h, wide);
    if (wide.size() <= capacity) put(h, narrow);
}

void put_case(hash& h, tie::sequence& s) {
    const number a = drawn_number(s), b = drawn_number(s);
    put(h, a);
    put(h, b);
    put_fitting(h, wide_number(a) + wide_number(b), a + b);
    put_fitting(h, wide_number(a) - wide_number(b), a - b);
    put(h, -wide_number(a));
    put_fitting(h, a * b, number::product(a, b));
    put_int(h, static_cast<int>(sign_of(a)));
    h.put(a == b);
    h.put(wide_number(a) + wide_number(b) - wide_number(b) == wide_number(a));
    put_int(h, a.bit_length());
    h.put(1);
    h.put_both(static_cast<word>(a.word_from_bit(draw(s, 64 * (capacity + 1)))));
    put(h, scale(wide_number(a), draw(s, 64 * 9)));
    std::vector<word> words;
    for (int i = 0; i < a.size(); ++i) words.push_back(a[i]);
    put_int(h, errbound::integers::words::count_filled(words.data(), a.size()));
    errbound::integers::words::for_signed_words(words.data(), a.size(),
                                                [&h](int i, word magnitude, bool negative) {
                                                    put_int(h, i);
                                                    h.put_both(magnitude);
                                                    h.put(negative);
                                                });
    const word magnitude = drawn_word(s, 2);
    const int shift = draw(s, 64 * capacity);
    const bool negative = draw(s, 2) == 1;
    const wide_number wide(magnitude, shift, negative);
    put(h, wide);
    if (wide.size() <= capacity) put(h, number(magnitude, shift, negative));
}

std::vector<tie::line> all_lines() {
    static tie::sequence numbers;
    return {{"long_integer all", 30000, [](hash& h, std::uint64_t) { put_case(h, numbers); }}};
}

}  // namespace

int main(int argc, char**) {
    return tie::compare(all_lines(), argc);
}
