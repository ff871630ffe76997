// GMP's integers with operators. They do not allocate once the store has as many as are alive at a
// time.
#pragma once

#include <gmp.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

/// Uses a store of its thread, so it must not be shared between threads.
class big_integer {
  public:
    big_integer() : value_(taken()) { mpz_set_ui(value_, 0); }
    big_integer(std::int64_t x) : value_(taken()) {
        const std::uint64_t magnitude =
            x < 0 ? 0 - static_cast<std::uint64_t>(x) : static_cast<std::uint64_t>(x);
        mpz_import(value_, 1, 1, sizeof magnitude, 0, 0, &magnitude);  // long may have 32 bits
        if (x < 0) mpz_neg(value_, value_);
    }
    /// x·2^−unit, a whole number.
    big_integer(double x, int unit) : value_(taken()) {
        int exponent;
        const double fraction = std::frexp(x, &exponent);
        mpz_set_d(value_, std::ldexp(fraction, 53));
        *this <<= exponent - 53 - unit;
    }
    big_integer(const big_integer& x) : value_(taken()) { mpz_set(value_, x.value_); }
    big_integer(big_integer&& x) noexcept : value_(std::exchange(x.value_, nullptr)) {}
    big_integer& operator=(big_integer x) noexcept {
        std::swap(value_, x.value_);
        return *this;
    }
    ~big_integer() {
        if (value_ != nullptr) store().free.push_back(value_);
    }

    /// Shifts by 2^bits; downwards, only zeros may be shifted out.
    big_integer& operator<<=(int bits) {
        if (bits < 0)
            mpz_tdiv_q_2exp(value_, value_, static_cast<mp_bitcnt_t>(-bits));
        else
            mpz_mul_2exp(value_, value_, static_cast<mp_bitcnt_t>(bits));
        return *this;
    }
    friend big_integer operator+(const big_integer& a, const big_integer& b) {
        big_integer r{unset()};
        mpz_add(r.value_, a.value_, b.value_);
        return r;
    }
    friend big_integer operator-(const big_integer& a, const big_integer& b) {
        big_integer r{unset()};
        mpz_sub(r.value_, a.value_, b.value_);
        return r;
    }
    friend big_integer operator*(const big_integer& a, const big_integer& b) {
        big_integer r{unset()};
        mpz_mul(r.value_, a.value_, b.value_);
        return r;
    }
    big_integer operator-() const {
        big_integer r{unset()};
        mpz_neg(r.value_, value_);
        return r;
    }
    friend big_integer abs(big_integer x) {
        mpz_abs(x.value_, x.value_);
        return x;
    }
    friend bool operator<(const big_integer& a, const big_integer& b) {
        return mpz_cmp(a.value_, b.value_) < 0;
    }
    /// −1, 0 or 1.
    friend int sign(const big_integer& x) { return mpz_sgn(x.value_); }
    /// a/b. Precondition: b divides a.
    friend big_integer exact_quotient(const big_integer& a, const big_integer& b) {
        big_integer r{unset()};
        mpz_divexact(r.value_, a.value_, b.value_);
        return r;
    }
    /// a/b to about fifty bits. Precondition: b is not zero.
    friend double ratio(const big_integer& a, const big_integer& b) {
        long exponent_a, exponent_b;
        const double x = mpz_get_d_2exp(&exponent_a, a.value_);
        const double y = mpz_get_d_2exp(&exponent_b, b.value_);
        return std::ldexp(x / y, static_cast<int>(exponent_a - exponent_b));
    }

  private:
    struct unset {};
    explicit big_integer(unset) : value_(taken()) {}

    struct free_values {
        std::vector<mpz_ptr> free;
        ~free_values() {
            for (const mpz_ptr x : free) {
                mpz_clear(x);
                delete x;
            }
        }
    };
    static free_values& store() {
        thread_local free_values values;
        return values;
    }
    static mpz_ptr taken() {
        auto& free = store().free;
        if (free.empty()) {
            const mpz_ptr made = new __mpz_struct;
            mpz_init(made);
            return made;
        }
        const mpz_ptr last = free.back();
        free.pop_back();
        return last;
    }

    mpz_ptr value_;
};
