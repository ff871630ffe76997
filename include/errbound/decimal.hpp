// Decimals as tracked numbers: 0.1 as a tenth, not as the double nearest to it.
//
//   using namespace errbound::literals;
//   const auto tenth = 0.1_tracked;                             // tracked<double>, off by 2^-56
//   errbound::from_decimal<errbound::tracked<float>>("6.02e23");
//
// What the type holds is exact: 0.5, 3, 1e2. Anything else is within the bound of the operations
// that read it: digits in, a power of ten out.
#pragma once

#include <errbound/environment.hpp>
#include <errbound/tracked.hpp>
#include <string_view>
#include <type_traits>

namespace errbound {

namespace detail {

/// A decimal's digits as a whole number and its exponent of ten, as far as they are read.
template <class Number>
struct decimal_digits {
    Number digits = 0;
    int exponent = 0;
    bool well_formed = false, negative = false;
};

/// [+-]d...[.d...][(e|E)[+-]d...], at least one digit. Separators of literals' digits are passed
/// over where they are between two.
template <class Number>
constexpr decimal_digits<Number> read_decimal(std::string_view text) {
    decimal_digits<Number> r;
    std::size_t i = 0;
    const auto sign = [&] {
        const bool minus = i < text.size() && text[i] == '-';
        if (i < text.size() && (text[i] == '-' || text[i] == '+')) ++i;
        return minus;
    };
    const auto is_digit_at = [&](std::size_t k) {
        return k < text.size() && text[k] >= '0' && text[k] <= '9';
    };
    const auto is_digit = [&] { return is_digit_at(i); };
    const auto is_separator = [&] {
        return i > 0 && i < text.size() && text[i] == '\'' && is_digit_at(i - 1) &&
               is_digit_at(i + 1);
    };
    r.negative = sign();
    bool any = false, fraction = false;
    int zeros = 0;  // at the end so far: no rounding for what does not count
    for (; is_digit() || is_separator() || (i < text.size() && text[i] == '.' && !fraction); ++i) {
        if (text[i] == '.') fraction = true;
        if (!is_digit()) continue;
        any = true;
        if (fraction) --r.exponent;
        ++zeros;
        if (text[i] == '0') continue;
        for (; zeros > 0; --zeros) r.digits = r.digits * Number(10);
        r.digits += Number(text[i] - '0');
    }
    r.exponent += zeros;
    if (any && i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
        ++i;
        const bool minus = sign();
        any = is_digit();
        int e = 0;
        for (; is_digit(); ++i) e = e < 100000 ? 10 * e + (text[i] - '0') : e;
        r.exponent += minus ? -e : e;
    }
    r.well_formed = any && i == text.size();
    return r;
}

/// Called in no program: it is no constant expression.
void tracked_is_for_decimal_literals();

/// 5^n.
template <class Number>
constexpr Number power_of_five(int n) {
    Number result = 1, power = 5;
    for (; n > 0; n /= 2) {
        if (n % 2 == 1) result *= power;
        if (n > 1) power *= power;
    }
    return result;
}

}  // namespace detail

/// The decimal number, in Number, a tracked type: exact where its value type holds it and its
/// digits and power of five, else within its error. Unknown where the text is none, where on the
/// way something overflows, and, at run time, where rounding is not to nearest. Text is as in C++:
/// [-]123.25e-2; digits are decimal ones.
///
/// Digits and power of five are exact as long as the rule `residual` says so, which sees what each
/// operation loses, rounding to nearest; the power of two is a scaling.
template <class Number>
constexpr Number from_decimal(std::string_view text) {
    using T = typename Number::value_type;
    using traits = number_traits<T>;
    using reader = tracked<T, residual>;
    const auto read = detail::read_decimal<reader>(text);
    const T unknown = traits::infinity();
    if (!read.well_formed) return Number::within(T(0), unknown);
    if (!std::is_constant_evaluated())
        if (!detail::rounds_to_nearest<double>()) return Number::within(T(0), unknown);
    const reader digits = read.negative ? -read.digits : read.digits;
    if (sign_of(digits) == sign_type::zero) return Number(T(0));
    // Beyond these the power of five overflows by itself.
    constexpr int reach = 2 * traits::max_exponent;
    if (read.exponent > reach || read.exponent < -reach) return Number::within(T(0), unknown);
    const int e = read.exponent;
    const reader power = detail::power_of_five<reader>(e < 0 ? -e : e);
    const reader x = scale(e < 0 ? digits / power : digits * power, e);
    return Number::within(x.value(), x.error());
}

/// Suffixes of numbers: using namespace errbound::literals.
namespace literals {

/// A tenth as 0.1_tracked; whole numbers too, 3_tracked. Read by the compiler; what is no decimal,
/// 0x10 or the octal 010, does not compile.
consteval tracked<double> operator""_tracked(const char* text) {
    const std::string_view decimal(text);
    const bool octal = decimal.size() > 1 && decimal[0] == '0' &&
                       decimal.find_first_of(".eE") == std::string_view::npos;
    if (octal || !detail::read_decimal<tracked<double>>(decimal).well_formed)
        detail::tracked_is_for_decimal_literals();
    return from_decimal<tracked<double>>(decimal);
}

}  // namespace literals

}  // namespace errbound
