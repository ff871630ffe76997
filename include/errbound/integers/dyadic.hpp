// Dyadic numbers n·2^e: all finite doubles, and all points reached by halving between them.
#pragma once

#include <cmath>
#include <compare>
#include <cstdint>
#include <errbound/integers/binary_double.hpp>
#include <errbound/sign.hpp>
#include <utility>

namespace errbound {

template <exact_number Integer>
int floor_log2(const Integer& x) {
    return static_cast<int>(x < 0 ? msb(Integer(-x)) : msb(x));
}

/// x·2^shift, truncated. (By magnitudes: Boost 1.74 loses the sign of some negative numbers.)
template <exact_number Integer>
Integer shifted(const Integer& x, int shift) {
    if (shift >= 0) return Integer(x << static_cast<unsigned>(shift));
    const auto bits = static_cast<unsigned>(-shift);
    return x < 0 ? Integer(-Integer(Integer(-x) >> bits)) : Integer(x >> bits);
}

/// A double within one ulp of n·2^e; infinite beyond the range of doubles.
template <exact_number Integer>
double nearby_double(const Integer& n, int e) {
    if (n == 0) return 0;
    Integer head = abs(n);  // the dropped bits are below an ulp
    const int excess = floor_log2(head) - 62;
    if (excess > 0) head >>= static_cast<unsigned>(excess);
    const double x = std::ldexp(static_cast<double>(static_cast<std::int64_t>(head)),
                                excess > 0 ? e + excess : e);
    return n < 0 ? -x : x;
}

/// numerator·2^exponent with an odd numerator, or both zero. Proof: proofs/integers/Dyadic.v,
/// dyadic_sum, dyadic_difference, dyadic_product, dyadic_scale.
template <exact_number Integer>
class dyadic {
  public:
    dyadic() : numerator_(0) {}
    dyadic(Integer numerator, int exponent)
        : numerator_(std::move(numerator)), exponent_(exponent) {
        if (numerator_ == 0) {
            exponent_ = 0;
        } else if (const auto zeros = lsb(Integer(abs(numerator_))); zeros > 0) {
            numerator_ >>= zeros;
            exponent_ += static_cast<int>(zeros);
        }
    }
    dyadic(const dyadic&) = default;
    dyadic(dyadic&&) = default;
    /// Copies first: if memory runs out, Boost's integers lose their value.
    dyadic& operator=(const dyadic& other) { return *this = dyadic(other); }
    dyadic& operator=(dyadic&&) = default;
    ~dyadic() = default;

    /// Precondition: x is finite.
    static dyadic from(double x) {
        if (x == 0) return {};
        const integers::binary_double d(x);
        dyadic exact;
        exact.numerator_ = Integer(d.odd_part());
        exact.exponent_ = d.last_bit();
        return exact;
    }
    static dyadic power_of_two(int exponent) { return {Integer(1), exponent}; }

    const Integer& numerator() const { return numerator_; }
    int exponent() const { return exponent_; }
    bool is_zero() const { return numerator_ == 0; }
    double to_double() const { return nearby_double(numerator_, exponent_); }

    friend dyadic operator+(const dyadic& a, const dyadic& b) {
        const int e = a.exponent_ < b.exponent_ ? a.exponent_ : b.exponent_;
        return {Integer(a.in_units(e) + b.in_units(e)), e};
    }
    friend dyadic operator-(const dyadic& a, const dyadic& b) { return a + -b; }
    friend dyadic operator*(const dyadic& a, const dyadic& b) {
        return {Integer(a.numerator_ * b.numerator_), a.exponent_ + b.exponent_};
    }
    dyadic operator-() const { return {Integer(-numerator_), exponent_}; }
    friend dyadic scale(const dyadic& x, int e) { return {x.numerator_, x.exponent_ + e}; }

    /// Proof: proofs/integers/Dyadic.v, dyadic_equal, dyadic_order.
    friend bool operator==(const dyadic& a, const dyadic& b) {
        return a.exponent_ == b.exponent_ && a.numerator_ == b.numerator_;
    }
    friend std::strong_ordering operator<=>(const dyadic& a, const dyadic& b) {
        const sign_type s = sign_of(a - b);
        return s == sign_type::zero       ? std::strong_ordering::equal
               : s == sign_type::negative ? std::strong_ordering::less
                                          : std::strong_ordering::greater;
    }
    friend sign_type sign_of(const dyadic& x) { return sign_of(x.numerator_); }
    friend dyadic magnitude(const dyadic& x) { return x.numerator_ < 0 ? -x : x; }
    /// ⌊log2 |x|⌋. Precondition: x is not zero. Proof: proofs/integers/Dyadic.v, dyadic_floor_log2.
    friend int floor_log2(const dyadic& x) { return floor_log2(x.numerator_) + x.exponent_; }

    /// x/2^unit. Precondition: unit <= exponent(). Proof: proofs/integers/Dyadic.v,
    /// dyadic_in_units.
    Integer in_units(int unit) const {
        return Integer(numerator_ << static_cast<unsigned>(is_zero() ? 0 : exponent_ - unit));
    }

  private:
    Integer numerator_;
    int exponent_ = 0;
};

/// a/b, rounded to about this many bits. Precondition: neither is zero.
template <exact_number Integer>
dyadic<Integer> quotient(const dyadic<Integer>& a, const dyadic<Integer>& b, int bits) {
    const int shift = bits + floor_log2(b.numerator()) - floor_log2(a.numerator());
    return {Integer(shifted(a.numerator(), shift) / b.numerator()),
            a.exponent() - b.exponent() - shift};
}

template <exact_number Integer>
dyadic<Integer> middle(const dyadic<Integer>& a, const dyadic<Integer>& b) {
    return scale(a + b, -1);
}

}  // namespace errbound
