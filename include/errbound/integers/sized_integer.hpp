// Exact integers whose types carry their largest width and so grow through an expression: no
// overflow, no allocation. A number stands for value·2^(unit·degree); all coordinates are multiples
// of 2^unit. To add terms of different degree, the lower one is multiplied by 1 = 2^−unit units.
// This needs unit <= 0 and a 1 no wider than coordinates.
#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <errbound/integers/fixed_integer.hpp>
#include <errbound/integers/long_integer.hpp>
#include <errbound/sign.hpp>
#include <type_traits>

namespace errbound::integers {

/// Storage: integers in doubles, in words, or in words of run-time length.
enum class integer_kind : std::uint8_t { floating, words, any_length };

/// Coordinates are below 2^CoordinateBits in size. If Mixed, terms of different degree may be
/// added. If Called, operations wider than the compiler's integers are calls.
template <integer_kind Kind, int CoordinateBits, bool Mixed, bool Called = false>
struct integer_level {
    static constexpr integer_kind kind = Kind;
    static constexpr int coordinate_bits = CoordinateBits;
    static constexpr bool mixed = Mixed, called = Called;
};

template <integer_kind Kind, int Bits>
constexpr auto integer_of() {
    constexpr int word_count = Bits / 64 + 1;
    if constexpr (Kind == integer_kind::floating) {
        static_assert(Bits <= 53, "errbound: an integer has more bits than were counted");
        return double();
    } else if constexpr (Kind == integer_kind::any_length) {
        return long_integer<word_count>(0);
    } else if constexpr (word_count == 1) {
        return std::int64_t();
#ifdef __SIZEOF_INT128__
    } else if constexpr (word_count == 2) {
        return words::signed_double_word();
#endif
    } else {
        return fixed_integer<word_count>();
    }
}

constexpr fixed_integer<1> as_fixed(std::int64_t x) {
    return x;
}
#ifdef __SIZEOF_INT128__
constexpr fixed_integer<2> as_fixed(words::signed_double_word x) {
    return fixed_integer<2>::from_words(
        {static_cast<words::word>(x), static_cast<words::word>(x >> 64)});
}
#endif
template <int Words>
constexpr const fixed_integer<Words>& as_fixed(const fixed_integer<Words>& x) {
    return x;
}
template <int Words, int Wider>
constexpr fixed_integer<Words> narrowed(const fixed_integer<Wider>& x) {
    std::array<words::word, std::size_t{Words}> low;
    for (int i = 0; i < Words; ++i) low[static_cast<std::size_t>(i)] = x[i];
    return fixed_integer<Words>::from_words(low);
}

/// A number x with |x| < 2^Bits units of its degree. Proof: proofs/integers/Widths.v, sized_exact,
/// sized_fits.
template <class Level, int Bits, int Degree>
struct sized_integer {
    static constexpr int bits = Bits, degree = Degree;
    using level = Level;
    using storage = decltype(integer_of<Level::kind, Bits>());
    static constexpr bool is_native =
        Level::kind == integer_kind::floating ||
        (Level::kind == integer_kind::words && Bits < words::native_bits);

    storage value;
    int unit;  ///< coordinates are multiples of 2^unit

    constexpr sized_integer operator-() const {
        if constexpr (is_native)
            return {-value, unit};
        else
            return {storage(0) - value, unit};
    }
    friend constexpr sign_type sign_of(const sized_integer& x) {
        if constexpr (is_native) {
            if (x.value == 0) return sign_type::zero;
            return x.value < 0 ? sign_type::negative : sign_type::positive;
        } else {
            return sign_of(x.value);
        }
    }
};

template <class>
inline constexpr bool is_sized_integer = false;
template <class Level, int Bits, int Degree>
inline constexpr bool is_sized_integer<sized_integer<Level, Bits, Degree>> = true;
template <class X>
concept sized_operand = is_sized_integer<X>;

template <class Level>
constexpr sized_integer<Level, 32, 0> sized_constant(int c, int unit) {
    using storage = typename sized_integer<Level, 32, 0>::storage;
    return {static_cast<storage>(c), unit};
}

// Operators are always inlined: most are a few instructions, and the others call long operations.

/// A product, not inlined so that its scratch words are on the stack only while it runs.
template <class Storage, class X, class Y>
[[gnu::noinline]] constexpr Storage long_product(const X& x, const Y& y) {
    return Storage::product(x, y);
}
/// This and called_sum are not inlined: they would be most of a long expression's code, which few
/// inputs reach.
template <class Storage, class X, class Y>
[[gnu::noinline]] constexpr Storage called_product(const X& x, const Y& y) {
    return narrowed<Storage::width / 64>(x * y);
}
template <bool Subtract, class Storage>
[[gnu::noinline]] constexpr Storage called_sum(const Storage& x, const Storage& y) {
    return Subtract ? x - y : x + y;
}

template <sized_operand X, sized_operand Y>
[[gnu::always_inline]] constexpr auto operator*(const X& x, const Y& y) {
    using result = sized_integer<typename X::level, X::bits + Y::bits, X::degree + Y::degree>;
    using storage = typename result::storage;
    if constexpr (X::level::kind == integer_kind::any_length) {
        return result{long_product<storage>(x.value, y.value), x.unit};
    } else if constexpr (result::is_native) {
        return result{static_cast<storage>(x.value) * static_cast<storage>(y.value), x.unit};
    } else if constexpr (X::level::called) {
        return result{called_product<storage>(as_fixed(x.value), as_fixed(y.value)), x.unit};
    } else {
        return result{narrowed<storage::width / 64>(as_fixed(x.value) * as_fixed(y.value)), x.unit};
    }
}

/// magnitude·2^n, which fits; n >= 0.
template <class Storage>
constexpr Storage shifted_word(words::word magnitude, int n) {
    if constexpr (std::is_same_v<Storage, double>)
        return static_cast<double>(magnitude << n);
    else if constexpr (requires { Storage::shifted(magnitude, n); })
        return Storage::shifted(magnitude, n);
    else if constexpr (std::is_constructible_v<Storage, words::word, int, bool>)
        return Storage(magnitude, n, false);
    else
        return static_cast<Storage>(static_cast<Storage>(magnitude) << n);
}

template <int Degree, class X>
[[gnu::always_inline]] constexpr decltype(auto) raised(const X& x) {
    using level = typename X::level;
    if constexpr (X::degree >= Degree) {
        return (x);
    } else {
        static_assert(level::mixed, "errbound: the expression is not homogeneous as declared");
        using one_type = sized_integer<level, level::coordinate_bits, 1>;
        using storage = typename one_type::storage;
        const one_type one{shifted_word<storage>(1, -x.unit), x.unit};
        if constexpr (X::degree + 1 == Degree)
            return x * one;
        else
            return raised<Degree>(x * one);
    }
}

template <bool Subtract, class X, class Y>
[[gnu::always_inline]] constexpr auto sum_of_raised(const X& x, const Y& y) {
    using result =
        sized_integer<typename X::level, (X::bits > Y::bits ? X::bits : Y::bits) + 1, X::degree>;
    using storage = typename result::storage;
    if constexpr (X::level::kind == integer_kind::any_length) {
        return result{
            Subtract ? storage::difference(x.value, y.value) : storage::sum(x.value, y.value),
            x.unit};
    } else if constexpr (result::is_native) {
        const auto a = static_cast<storage>(x.value), b = static_cast<storage>(y.value);
        return result{Subtract ? a - b : a + b, x.unit};
    } else if constexpr (X::level::called) {
        return result{called_sum<Subtract, storage>(as_fixed(x.value), as_fixed(y.value)), x.unit};
    } else {
        const storage a = as_fixed(x.value), b = as_fixed(y.value);
        return result{Subtract ? a - b : a + b, x.unit};
    }
}
template <bool Subtract, class X, class Y>
[[gnu::always_inline]] constexpr auto sum_of(const X& x, const Y& y) {
    return sum_of_raised<Subtract>(raised<Y::degree>(x), raised<X::degree>(y));
}

template <sized_operand X, sized_operand Y>
[[gnu::always_inline]] constexpr auto operator+(const X& x, const Y& y) {
    return sum_of<false>(x, y);
}
template <sized_operand X, sized_operand Y>
[[gnu::always_inline]] constexpr auto operator-(const X& x, const Y& y) {
    return sum_of<true>(x, y);
}
template <sized_operand X>
[[gnu::always_inline]] constexpr auto operator+(const X& x, std::same_as<int> auto c) {
    return x + sized_constant<typename X::level>(c, x.unit);
}
template <sized_operand X>
[[gnu::always_inline]] constexpr auto operator+(std::same_as<int> auto c, const X& x) {
    return x + c;
}
template <sized_operand X>
[[gnu::always_inline]] constexpr auto operator-(const X& x, std::same_as<int> auto c) {
    return x - sized_constant<typename X::level>(c, x.unit);
}
template <sized_operand X>
[[gnu::always_inline]] constexpr auto operator-(std::same_as<int> auto c, const X& x) {
    return sized_constant<typename X::level>(c, x.unit) - x;
}
template <sized_operand X>
[[gnu::always_inline]] constexpr auto operator*(const X& x, std::same_as<int> auto c) {
    return x * sized_constant<typename X::level>(c, x.unit);
}
template <sized_operand X>
[[gnu::always_inline]] constexpr auto operator*(std::same_as<int> auto c, const X& x) {
    return x * c;
}

}  // namespace errbound::integers
