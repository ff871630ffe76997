// A polynomial on an interval: truncated Taylor coefficients, and signs of its Bernstein
// coefficients. The shorter the interval, the fewer coefficients matter, and the less it costs.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <errbound/integers/dyadic.hpp>
#include <errbound/roots/integer_polynomial.hpp>
#include <utility>
#include <vector>

namespace errbound::roots {

/// mantissa·2^exponent, truncated towards zero.
template <class Integer>
struct cut_number {
    Integer mantissa;
    int exponent = 0;

    void cut(int bits) {
        const int excess = floor_log2(mantissa) + 1 - bits;
        if (excess <= 0) return;
        mantissa = shifted(mantissa, -excess);
        exponent += excess;
    }
};

/// Numbers, each within `error` of the exact one.
template <class Integer>
struct approximate_row {
    integer_form<Integer> values;
    Integer error;
};

/// p(low + width·u) = c·Σ a_j u^j for a positive c. Stores the first a_j, as integers within
/// `error`; the others are within `error` of 0.
template <exact_number Integer>
class local_form {
  public:
    using form = integer_form<Integer>;
    using point = dyadic<Integer>;

    /// The error is about 2^(−bits) of p's largest term at `low`. Precondition: 0 < low, 0 < width.
    /// Cost: degree multiplications of numbers of `bits` bits, and degree additions per coefficient
    /// kept. `meter` is polled for each row of these, also in later calls, and must outlive this.
    /// Proof: proofs/roots/TaylorCoefficients.v, taylor_right.
    local_form(const form& p, const point& low, const point& width, int bits,
               work_meter* meter = nullptr)
        : degree_(static_cast<int>(p.size()) - 1), bits_(bits), meter_(meter) {
        const int count_bits = bits_of_count(p.size()), ratio = ratio_exponent(low, width);
        const int lost = static_cast<int>(error_bits(p.size(), ratio)), precision = bits + lost;
        a_ = terms(p, low, precision, count_bits);
        const std::size_t kept = kept_terms(p.size(), precision, ratio);
        for (std::size_t i = 0; i < kept; ++i) {
            poll();
            for (std::size_t k = p.size() - 1; k-- > i;) a_[k] += a_[k + 1];
        }
        a_.resize(kept);
        scale(low, width, precision + count_bits + 3);
        error_ = Integer(4) << static_cast<unsigned>(lost);
    }

    /// Bits of the largest numbers in the constructor.
    static std::int64_t precision(std::size_t size, const point& low, const point& width,
                                  int bits) {
        return bits + error_bits(size, ratio_exponent(low, width));
    }

    /// On u = (from + length·v)/2^depth, v in [0, 1]. Precondition: 0 <= from, 0 < length, from +
    /// length <= 2^depth. Proof: proofs/roots/LocalForm.v, part_right, dropped_right.
    local_form part(const Integer& from, const Integer& length, int depth) const {
        local_form result = *this;
        form& a = result.a_;
        Integer term;  // reuses its memory
        if (from != 0)
            for (std::size_t i = 0; i + 1 < a.size(); ++i) {
                poll();
                for (std::size_t j = a.size() - 1; j-- > i;) {
                    term = a[j + 1];
                    term *= from;
                    a[j] += shifted(term, -depth);
                }
            }
        Integer power = 1;
        for (std::size_t j = 1; j < a.size(); ++j) {
            power *= length;
            a[j] = shifted(Integer(a[j] * power), -depth * static_cast<int>(j));
        }
        // An error e in a_i adds at most e to each coefficient, since from + length <= 2^depth.
        // Each truncation adds at most 1.
        result.error_ = error_ * Integer(degree_ + 1) + Integer(a.size() * a.size());
        result.drop_small_terms();
        return result;
    }

    /// The Bernstein coefficients times C(n, i), up to a positive factor, from the a_j truncated to
    /// this many bits of the largest. The i-th is within its margin, error·C(n + 1, i), since the
    /// error of a_j counts C(n − j, i − j) times. Proof: proofs/roots/LocalForm.v, cut_right.
    approximate_row<Integer> scaled_coefficients(int bits) const {
        int excess = 0;
        for (const Integer& a : a_) excess = (std::max)(excess, bits_of(a) - bits);
        return {scaled_coefficients(static_cast<std::size_t>(degree_), excess),
                excess > 0 ? Integer(shifted(error_, -excess) + 2) : error_};
    }
    /// The Bernstein coefficients, up to a positive factor. Proof: proofs/roots/LocalForm.v,
    /// coefficients_right, row_signs_of_coefficients.
    approximate_row<Integer> coefficients(int bits) const {
        auto row = scaled_coefficients(bits);
        Integer binomial = 1;
        for (std::size_t i = 0; i < row.values.size(); ++i) {
            row.values[i] /= binomial;
            binomial *= Integer(row.values.size() - 1 - i);
            binomial /= Integer(i + 1);
        }
        row.error = row.error * Integer(row.values.size()) + 1;
        return row;
    }
    /// Signs of scaled_coefficients(bits), 0 if uncertain. Proof: proofs/roots/LocalForm.v,
    /// signs_right.
    std::vector<signed char> signs(int bits) const {
        const auto h = scaled_coefficients(bits);
        std::vector<signed char> result;
        result.reserve(h.values.size());
        Integer margin = h.error;
        for (std::size_t i = 0; i < h.values.size(); ++i) {
            const Integer& x = h.values[i];
            result.push_back(x > margin ? 1 : -x > margin ? -1 : 0);
            margin *= Integer(h.values.size() - i);
            margin /= Integer(i + 1);
        }
        return result;
    }

    /// True if all values on [0, 1] certainly exceed the error, by the Bernstein coefficients of
    /// the stored terms. Cheap if few are stored. Proof: proofs/roots/LocalForm.v,
    /// surely_rootless_right.
    bool surely_rootless() const {
        const form h = scaled_coefficients(a_.size() - 1, 0);
        Integer margin = error_ * Integer(degree_ + 1);
        const bool negative = h[0] < 0;
        for (std::size_t i = 0; i < h.size(); ++i) {
            if ((negative ? Integer(-h[i]) : h[i]) <= margin) return false;
            margin *= Integer(h.size() - 1 - i);
            margin /= Integer(i + 1);
        }
        return true;
    }

    /// Bits by which both end values exceed the error; at least 0.
    int certain_bits() const {
        const int least = (std::min)(bits_of(a_[0]), bits_of(value_at_end()));
        return (std::max)(0, least - bits_of(error_));
    }

    int degree() const { return degree_; }
    int bits() const { return bits_; }
    /// True if the error takes less than half of the requested bits: terms have similar sizes at
    /// both ends.
    bool ends_are_alike() const { return bits_of(error_) < bits_ / 2; }
    /// Proof: proofs/roots/LocalForm.v, low_end_right, high_end_right.
    bool low_end_is_certain() const { return abs(a_[0]) > error_; }
    bool high_end_is_certain() const { return abs(value_at_end()) > error_ * Integer(degree_ + 1); }
    const Integer& value_at_start() const { return a_[0]; }
    Integer slope_at_start() const { return a_.size() > 1 ? a_[1] : Integer(0); }
    Integer value_at_end() const {
        Integer sum = 0;
        for (const Integer& a : a_) sum += a;
        return sum;
    }
    Integer slope_at_end() const {
        Integer sum = 0;
        for (std::size_t j = 1; j < a_.size(); ++j) sum += a_[j] * Integer(j);
        return sum;
    }

  private:
    void poll() const {
        if (meter_ != nullptr) meter_->poll();
    }
    /// Σ a_j t^j (s + t)^(n − j) for truncated a_j: the coefficients of s^(n − i) t^i.
    form scaled_coefficients(std::size_t n, int cut) const {
        form h{shifted(a_[0], -cut)};
        h.reserve(n + 1);
        for (std::size_t m = 1; m <= n; ++m) {
            poll();
            h.push_back(h.back());
            for (std::size_t i = m - 1; i > 0; --i) h[i] += h[i - 1];
            if (m < a_.size()) h[m] += shifted(a_[m], -cut);
        }
        return h;
    }
    static int bits_of(const Integer& x) { return x == 0 ? 0 : floor_log2(x) + 1; }

    /// c_i·low^i in a common unit, each within 3. Proof: proofs/roots/TaylorCoefficients.v,
    /// terms_right.
    static form terms(const form& p, const point& low, int bits, int count_bits) {
        const int precision = bits + count_bits + 1;
        std::vector<cut_number<Integer>> all;
        all.reserve(p.size());
        cut_number<Integer> power{Integer(1)};
        const cut_number<Integer> base{low.numerator(), low.exponent()};
        int top = 0;
        for (std::size_t i = 0; i < p.size(); ++i) {
            if (i > 0) {
                power.mantissa *= base.mantissa;
                power.exponent += base.exponent;
                power.cut(precision);
            }
            all.push_back(
                {Integer(p[i] == 0 ? p[i] : Integer(p[i] * power.mantissa)), power.exponent});
            if (p[i] == 0) continue;
            const int high = floor_log2(all[i].mantissa) + 1 + all[i].exponent;
            top = i == 0 ? high : (std::max)(top, high);
        }
        form result;
        result.reserve(p.size());
        for (const auto& x : all) result.push_back(shifted(x.mantissa, x.exponent - (top - bits)));
        return result;
    }

    static int bits_of_count(std::size_t size) { return static_cast<int>(std::bit_width(size)); }
    /// width < low·2^(result).
    static int ratio_exponent(const point& low, const point& width) {
        return floor_log2(width) - floor_log2(low) + 1;
    }
    /// At most this many of `size` coefficients exceed the error.
    static std::size_t kept_terms(std::size_t size, int precision, int ratio) {
        const int falling = -(ratio + bits_of_count(size));
        if (falling <= 0) return size;
        return (std::min)(
            size, static_cast<std::size_t>((precision + bits_of_count(size)) / falling + 2));
    }

    void scale(const point& low, const point& width, int precision) {
        const int shift = precision + floor_log2(low.numerator()) - floor_log2(width.numerator());
        cut_number<Integer> ratio{shifted(width.numerator(), shift),
                                  width.exponent() - low.exponent() - shift};
        ratio.mantissa /= low.numerator();
        cut_number<Integer> power = ratio;
        for (std::size_t j = 1; j < a_.size(); ++j) {
            a_[j] *= power.mantissa;
            a_[j] = shifted(a_[j], power.exponent);
            power.mantissa *= ratio.mantissa;
            power.exponent += ratio.exponent;
            power.cut(precision);
        }
    }

    /// log2 of a bound of C(n + 1, j + 1)·(width/low)^j. Proof: proofs/roots/TaylorCoefficients.v,
    /// error_bits_right.
    static std::int64_t error_bits(std::size_t size, int ratio) {
        if (ratio + bits_of_count(size) <= 0) return bits_of_count(size);
        const auto count = static_cast<std::int64_t>(size);
        if (ratio >= 0) return count * (ratio + 1);
        // (1 + x)^(n + 1)/x with x = 2^ratio, and 1 + x <= 2^(3x/2).
        return (3 * count >> (1 - ratio)) + 1 - ratio;
    }

    void drop_small_terms() {
        const std::size_t before = a_.size();
        while (a_.size() > 2 && abs(a_.back()) <= error_) a_.pop_back();
        if (a_.size() < before) error_ *= 2;
    }

    int degree_, bits_;
    work_meter* meter_;
    form a_;
    Integer error_;
};

}  // namespace errbound::roots
