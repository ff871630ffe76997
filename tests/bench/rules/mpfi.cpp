#include <mpfi.h>

#include "tests/bench/rules/contestants.hpp"

namespace bench {
namespace {

/// An interval at the precision of doubles.
class interval {
  public:
    interval() { mpfi_init2(value_, 53); }
    explicit interval(double x) : interval() { mpfi_set_d(value_, x); }
    interval(const interval& x) : interval() { mpfi_set(value_, x.value_); }
    interval& operator=(const interval& x) {
        mpfi_set(value_, x.value_);
        return *this;
    }
    ~interval() { mpfi_clear(value_); }
    mpfi_ptr get() { return value_; }
    mpfi_srcptr get() const { return value_; }

  private:
    mpfi_t value_;
};

struct arithmetic : composed<interval, arithmetic> {
    static void add(interval& r, const interval& a, const interval& b) {
        mpfi_add(r.get(), a.get(), b.get());
    }
    static void multiply(interval& r, const interval& a, const interval& b) {
        mpfi_mul(r.get(), a.get(), b.get());
    }
    static void divide(interval& r, const interval& a, const interval& b) {
        mpfi_div(r.get(), a.get(), b.get());
    }
    static void root(interval& r, const interval& a) { mpfi_sqrt(r.get(), a.get()); }
    /// MPFI has no fused operation: computes a product and a sum.
    static void fused(interval& r, const interval& a, const interval& b, const interval& c) {
        multiply(r, a, b);
        add(r, r, c);
    }
    static void length(interval& r, const interval& a, const interval& b) {
        mpfi_hypot(r.get(), a.get(), b.get());
    }
    static errbound::sign_type sign(const interval& a) {
        using enum errbound::sign_type;
        if (mpfi_is_strictly_pos(a.get()) > 0) return positive;
        if (mpfi_is_strictly_neg(a.get()) > 0) return negative;
        return mpfi_is_zero(a.get()) > 0 ? zero : uncertain;
    }
};

}  // namespace

contestant mpfi_contestant() {
    return contestant_of<interval, arithmetic>("MPFI");
}

}  // namespace bench
