// Floating-point formats of 6 to 8 bits, small enough to try every case.
//
// tiny_float<P, E> has P bits of precision and E of exponent in IEEE 754 layout, with gradual
// underflow, infinities and NaN. Its operations are MPFR's (mpfr_subnormalize), from tables, except
// fma. The calling thread sets the rounding direction (tiny_rounding).
#pragma once

#include <mpfr.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <errbound/number_traits.hpp>
#include <limits>
#include <vector>

namespace errbound::validation {

/// Flag in a result's code: in directed rounding, the operation overflowed to a finite number,
/// which no rule notices.
inline constexpr std::uint16_t unnoticed_overflow = 1U << 15;

/// Results of all operations of one format in one direction, by operand codes.
struct tiny_tables {
    static constexpr int max_scale = 64;  ///< scaling by more gives the same result

    int bits = 0;  ///< bits of a code
    mpfr_rnd_t direction = MPFR_RNDN;
    std::vector<std::uint16_t> sum, difference, product, quotient, scaled, root;

    tiny_tables(int precision, int exponent_bits, mpfr_rnd_t rounding);
    std::size_t pair(std::uint8_t a, std::uint8_t b) const { return (std::size_t{a} << bits) | b; }
    std::size_t scale(std::uint8_t a, int e) const {
        e = e < -max_scale ? -max_scale : e > max_scale ? max_scale : e;
        return std::size_t{a} * (2 * max_scale + 1) + static_cast<std::size_t>(e + max_scale);
    }
};

/// The code of ab + c, rounded once. Not in tables, which would be long for three operands.
std::uint16_t tiny_fma(double a, double b, double c, int precision, int exponent_bits,
                       mpfr_rnd_t direction);

std::vector<double> tiny_values(int precision, int exponent_bits);
/// The code of a value, rounded to nearest even.
std::uint8_t tiny_code(double value, int precision, int exponent_bits);

/// Requires a tiny_rounding on the thread.
template <int P, int E>
class tiny_float {
    static_assert(P >= 2 && E >= 2 && P + E <= 8);

  public:
    static constexpr int precision = P, exponent_bits = E, codes = 1 << (P + E);

    constexpr tiny_float() = default;
    tiny_float(double value) : code_(tiny_code(value, P, E)) {}
    tiny_float(int value)
        : code_(value >= -16 && value <= 16 ? integers_[static_cast<std::size_t>(value + 16)]
                                            : tiny_code(value, P, E)) {}
    static tiny_float from_code(int code) {
        tiny_float x;
        x.code_ = static_cast<std::uint8_t>(code);
        return x;
    }
    int code() const { return code_; }
    explicit operator double() const { return values_[code_]; }
    explicit operator long long() const { return static_cast<long long>(double(*this)); }

    friend tiny_float operator+(tiny_float a, tiny_float b) {
        return looked_up(tables_->sum[tables_->pair(a.code_, b.code_)]);
    }
    friend tiny_float operator-(tiny_float a, tiny_float b) {
        return looked_up(tables_->difference[tables_->pair(a.code_, b.code_)]);
    }
    friend tiny_float operator*(tiny_float a, tiny_float b) {
        return looked_up(tables_->product[tables_->pair(a.code_, b.code_)]);
    }
    friend tiny_float operator/(tiny_float a, tiny_float b) {
        return looked_up(tables_->quotient[tables_->pair(a.code_, b.code_)]);
    }
    tiny_float times_power(int e) const {
        return looked_up(tables_->scaled[tables_->scale(code_, e)]);
    }
    tiny_float root() const { return looked_up(tables_->root[code_]); }
    friend tiny_float fused(tiny_float a, tiny_float b, tiny_float c) {
        return looked_up(tiny_fma(double(a), double(b), double(c), P, E, tables_->direction));
    }
    tiny_float operator-() const { return from_code(code_ ^ (codes >> 1)); }
    friend bool operator==(tiny_float a, tiny_float b) { return double(a) == double(b); }
    friend auto operator<=>(tiny_float a, tiny_float b) { return double(a) <=> double(b); }

    /// True if an operation on this thread overflowed unnoticed since clear_flag().
    static bool overflowed_unnoticed() { return overflowed_; }
    static void clear_flag() { overflowed_ = false; }

  private:
    template <class>
    friend class tiny_rounding;

    static tiny_float looked_up(std::uint16_t result) {
        if ((result & unnoticed_overflow) != 0) overflowed_ = true;
        return from_code(result & 0xff);
    }
    static const tiny_tables& tables_of(mpfr_rnd_t direction) {
        static const std::array<tiny_tables, 4> all{
            tiny_tables(P, E, MPFR_RNDN), tiny_tables(P, E, MPFR_RNDZ),
            tiny_tables(P, E, MPFR_RNDU), tiny_tables(P, E, MPFR_RNDD)};
        return all[static_cast<std::size_t>(direction)];
    }

    inline static const std::vector<double> values_ = tiny_values(P, E);
    inline static const std::array<std::uint8_t, 33> integers_ = [] {
        std::array<std::uint8_t, 33> codes{};  // of -16 to 16
        for (int i = 0; i < 33; ++i) codes[static_cast<std::size_t>(i)] = tiny_code(i - 16, P, E);
        return codes;
    }();
    inline static constinit thread_local const tiny_tables* tables_ = nullptr;
    inline static constinit thread_local bool overflowed_ = false;
    std::uint8_t code_ = 0;
};

/// Sets the rounding direction of Tiny's operations on this thread: MPFR_RNDN, RNDZ, RNDU or RNDD.
/// Constants always round to nearest.
template <class Tiny>
class tiny_rounding {
  public:
    explicit tiny_rounding(mpfr_rnd_t direction) : before_(Tiny::tables_) {
        Tiny::tables_ = &Tiny::tables_of(direction);
    }
    ~tiny_rounding() { Tiny::tables_ = before_; }
    tiny_rounding(const tiny_rounding&) = delete;
    tiny_rounding& operator=(const tiny_rounding&) = delete;

  private:
    const tiny_tables* before_;
};

}  // namespace errbound::validation

namespace errbound {

template <int P, int E>
struct number_traits<validation::tiny_float<P, E>> {
    using number = validation::tiny_float<P, E>;
    static constexpr int digits = P;
    static constexpr int max_exponent = 1 << (E - 1);

    static number epsilon() { return std::ldexp(1.0, 1 - P); }
    static number unit_roundoff() { return std::ldexp(1.0, -P); }
    static number underflow_unit() { return number::from_code(1); }
    static number smallest_normal() { return number::from_code(1 << (P - 1)); }
    static number largest() { return number::from_code(number::codes / 2 - (1 << (P - 1)) - 1); }
    static number infinity() { return number::from_code(number::codes / 2 - (1 << (P - 1))); }
    static number abs(const number& x) { return x < 0 ? -x : x; }
    static number(max)(const number& x, const number& y) { return x < y ? y : x; }
    static number sqrt(const number& x) { return x.root(); }
    static number fma(const number& a, const number& b, const number& c) { return fused(a, b, c); }
    static bool is_finite(const number& x) { return std::isfinite(double(x)); }
    static number scale(const number& x, int e) { return x.times_power(e); }
    static int exponent(const number& x) { return std::ilogb(double(x)) + 1; }
};

}  // namespace errbound
