// Intervals of MPFI at the precision of doubles.
#pragma once

#include <mpfi.h>

#include <errbound/sign.hpp>
#include <utility>
#include <vector>

namespace bench {

/// An interval with operators. It does not allocate once the pool holds as many intervals as are
/// alive at a time.
class mpfi_interval {
  public:
    mpfi_interval() : value_(taken()) {}
    explicit mpfi_interval(double x) : value_(taken()) { mpfi_set_d(value_, x); }
    mpfi_interval(const mpfi_interval& x) : value_(taken()) { mpfi_set(value_, x.value_); }
    mpfi_interval(mpfi_interval&& x) noexcept : value_(std::exchange(x.value_, nullptr)) {}
    mpfi_interval& operator=(mpfi_interval x) noexcept {
        std::swap(value_, x.value_);
        return *this;
    }
    ~mpfi_interval() {
        if (value_ != nullptr) free_values().push_back(value_);
    }
    friend mpfi_interval operator+(const mpfi_interval& a, const mpfi_interval& b) {
        mpfi_interval r;
        mpfi_add(r.value_, a.value_, b.value_);
        return r;
    }
    friend mpfi_interval operator-(const mpfi_interval& a, const mpfi_interval& b) {
        mpfi_interval r;
        mpfi_sub(r.value_, a.value_, b.value_);
        return r;
    }
    friend mpfi_interval operator*(const mpfi_interval& a, const mpfi_interval& b) {
        mpfi_interval r;
        mpfi_mul(r.value_, a.value_, b.value_);
        return r;
    }
    friend errbound::sign_type sign_of(const mpfi_interval& x) {
        if (mpfi_is_strictly_pos(x.value_) > 0) return errbound::sign_type::positive;
        if (mpfi_is_strictly_neg(x.value_) > 0) return errbound::sign_type::negative;
        return mpfi_is_zero(x.value_) > 0 ? errbound::sign_type::zero
                                          : errbound::sign_type::uncertain;
    }

    mpfi_ptr get() { return value_; }
    mpfi_srcptr get() const { return value_; }

  private:
    static std::vector<mpfi_ptr>& free_values() {
        static std::vector<mpfi_ptr> values;
        return values;
    }
    static mpfi_ptr taken() {
        auto& values = free_values();
        if (values.empty()) {
            const mpfi_ptr made = new __mpfi_struct;
            mpfi_init2(made, 53);
            return made;
        }
        const mpfi_ptr last = values.back();
        values.pop_back();
        return last;
    }
    mpfi_ptr value_;
};

}  // namespace bench
