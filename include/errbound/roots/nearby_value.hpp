// Values of polynomials with error bounds, for signs at points where exact values have millions of
// bits. Cost: a product of numbers of `bits` bits per nonzero coefficient, and one per gap between
// these.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <errbound/integers/dyadic.hpp>
#include <errbound/roots/work_meter.hpp>
#include <errbound/sign.hpp>
#include <utility>
#include <vector>

namespace errbound::roots {

/// A number x with |x − value·2^exponent| <= error·2^exponent. Proof: proofs/roots/NearbyValue.v,
/// near_exact, near_product, near_sum, near_shifted, near_cut, near_widened, near_sign.
template <exact_number Integer>
struct nearby_value {
    Integer value = 0, error = 0;
    std::int64_t exponent = 0;

    bool is_within(int bits) const {
        return error == 0 || Integer(error << static_cast<unsigned>(bits)) < Integer(abs(value));
    }
    sign_type sign() const { return is_within(0) ? sign_of(value) : sign_type::uncertain; }
    std::int64_t log2() const { return floor_log2(value) + exponent; }

    /// Keeps about this many leading bits of the larger of value and error. Each cut adds a unit of
    /// error.
    void cut(int bits) {
        const int excess =
            (std::max)(value == 0 ? 0 : floor_log2(value), error == 0 ? 0 : floor_log2(error)) -
            bits;
        if (excess > 0) drop(excess);
    }
    void drop(int count) {
        value = shifted(value, -count);
        error = shifted(error, -count) + 2;
        exponent += count;
    }

    friend nearby_value operator*(const nearby_value& a, const nearby_value& b) {
        nearby_value product{Integer(a.value * b.value), 0, a.exponent + b.exponent};
        if (a.error != 0) product.error = a.error * Integer(abs(b.value) + b.error);
        if (b.error != 0) product.error += Integer(abs(a.value)) * b.error;
        return product;
    }
};

/// a + b, each first cut to about this many bits of the larger one.
template <exact_number Integer>
nearby_value<Integer> sum(nearby_value<Integer> a, nearby_value<Integer> b, int bits) {
    if (a.value == 0 && a.error == 0) return b;
    if (b.value == 0 && b.error == 0) return a;
    if (a.exponent < b.exponent) std::swap(a, b);
    // Shift a, of the higher exponent, up as far as there is room.
    const int size =
        (std::max)(a.value == 0 ? 0 : floor_log2(a.value), a.error == 0 ? 0 : floor_log2(a.error));
    const std::int64_t distance = a.exponent - b.exponent,
                       up = std::min<std::int64_t>(distance, (std::max)(0, 2 * bits - size));
    a.value <<= static_cast<unsigned>(up);
    a.error <<= static_cast<unsigned>(up);
    a.exponent -= up;
    if (const std::int64_t down = distance - up; down > 0) {
        const std::int64_t all = (std::max)(b.value == 0 ? 0 : floor_log2(b.value),
                                            b.error == 0 ? 0 : floor_log2(b.error)) +
                                 1;
        b.drop(static_cast<int>((std::min)(down, all)));
        b.exponent = a.exponent;  // if fewer bits were dropped, only the error is left
    }
    a.value += b.value;
    a.error += b.error;
    return a;
}

/// p(x) by Horner's rule with values of about this many bits.
template <exact_number Integer>
nearby_value<Integer> value_near(const std::vector<Integer>& p, const dyadic<Integer>& x, int bits,
                                 work_meter& meter) {
    using number = nearby_value<Integer>;
    const auto product = [&](const number& a, const number& b) {
        meter.poll();
        number made = a * b;
        made.cut(bits);
        return made;
    };
    number at{x.numerator(), 0, x.exponent()}, result{p.back(), 0, 0}, gap_power = at;
    at.cut(bits);
    result.cut(bits);
    std::size_t done = p.size() - 1, last_gap = 1;
    gap_power = at;
    for (std::size_t i = done; i-- > 0;) {
        if (p[i] == 0 && i > 0) continue;
        const std::size_t gap = done - i;
        if (gap != last_gap) {
            number square = at;
            bool first = true;
            for (std::size_t n = gap; n > 0; n /= 2) {
                if (n % 2 == 1) gap_power = first ? square : product(gap_power, square);
                if (n % 2 == 1) first = false;
                if (n > 1) square = product(square, square);
            }
            last_gap = gap;
        }
        result = sum(product(result, gap_power), number{p[i], 0, 0}, bits);
        result.cut(bits);
        done = i;
    }
    return result;
}

/// Approximate bits of the numerator of p(x) in Horner's rule.
template <exact_number Integer>
std::int64_t bits_of_value(const std::vector<Integer>& p, const dyadic<Integer>& x) {
    if (x.is_zero()) return 0;
    const auto of_x = static_cast<std::int64_t>(floor_log2(x.numerator())) + 1;
    const std::int64_t e = x.exponent();
    return static_cast<std::int64_t>(p.size()) * (e >= 0 ? of_x + e : (std::max)(of_x, -e));
}

}  // namespace errbound::roots
