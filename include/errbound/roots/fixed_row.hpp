// Bernstein coefficients truncated to a fixed number of words. errbound/roots/root_isolation.hpp
// halves them instead of integers that grow by the degree with every halving.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <errbound/integers/fixed_integer.hpp>
#include <errbound/roots/integer_polynomial.hpp>
#include <errbound/roots/sign_variations.hpp>
#include <utility>
#include <vector>

namespace errbound::roots {

/// Multiples of one unit, each within `error` units of its coefficient.
template <int Words>
class fixed_row {
  public:
    /// From coefficients, not all zero, each given within `error`. Proof:
    /// proofs/roots/ControlValues.v, row_cut_right, row_uncertain; proofs/roots/FixedRow.v,
    /// row_fits.
    template <exact_number Integer>
    fixed_row(const integer_form<Integer>& b, const Integer& error) {
        int bits = 0;
        for (const Integer& c : b)
            if (c != 0) bits = (std::max)(bits, floor_log2(c) + 1);
        // Leaves room for the sign and a sum of two.
        const int excess = bits - (integers::fixed_integer<Words>::width - 3);
        const Integer word = Integer(1) << 64U;
        b_.reserve(b.size());
        for (const Integer& c : b) {
            Integer rest = shifted(Integer(abs(c)), -excess);
            std::array<integers::words::word, std::size_t{Words}> all{};
            for (auto& w : all) {
                w = static_cast<integers::words::word>(Integer(rest % word));
                rest >>= 64U;
                if (rest == 0) break;
            }
            const auto cut = integers::fixed_integer<Words>::from_words(all);
            b_.push_back(c < 0 ? -cut : cut);
        }
        const Integer cut_error = shifted(error, -excess) + 2;
        if (cut_error < std::int64_t(1) << 60)
            error_ = static_cast<std::int64_t>(cut_error);
        else
            std::fill(b_.begin(), b_.end(), integers::fixed_integer<Words>(0));
    }

    /// 1 or −1 for a certain sign, otherwise 0. Proof: proofs/roots/ControlValues.v,
    /// row_signs_right.
    int sign(std::size_t i) const {
        if (b_[i].negative()) return -b_[i] > integers::fixed_integer<Words>(error_) ? -1 : 0;
        return b_[i] > integers::fixed_integer<Words>(error_) ? 1 : 0;
    }
    std::size_t size() const { return b_.size(); }

    /// The values as doubles, in the row's unit.
    std::vector<double> nearby_values() const {
        std::vector<double> values;
        values.reserve(b_.size());
        for (const auto& x : b_) {
            const auto size = x.negative() ? -x : x;
            double sum = 0;
            for (int i = Words; i-- > 0;) sum = sum * 0x1p64 + static_cast<double>(size[i]);
            values.push_back(x.negative() ? -sum : sum);
        }
        return values;
    }

    /// The two halves, by de Casteljau. A midpoint inherits at most the error of its ends; rounding
    /// adds half a unit in each of the degree's steps. Proof: proofs/roots/ControlValues.v,
    /// row_halves_right; proofs/roots/FixedRow.v, row_stays.
    std::pair<fixed_row, fixed_row> halves() && {
        const std::size_t n = b_.size() - 1;
        fixed_row left;
        left.b_.resize(n + 1);
        for (std::size_t i = 0; i <= n; ++i) {
            left.b_[i] = b_[0];
            for (std::size_t j = 0; j < n - i; ++j)
                b_[j] = (b_[j] + b_[j + 1]).template from_bit<Words>(1);
        }
        error_ += static_cast<std::int64_t>(n + 1) / 2;
        left.error_ = error_;
        return {std::move(left), std::move(*this)};
    }

  private:
    fixed_row() = default;

    std::vector<integers::fixed_integer<Words>> b_;
    std::int64_t error_ = 0;
};

}  // namespace errbound::roots
