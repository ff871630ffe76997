#include <arb.h>

#include "tests/bench/rules/contestants.hpp"

namespace bench {
namespace {

/// A ball. Consecutive ones are an array for arb.
class ball {
  public:
    ball() { arb_init(value_); }
    explicit ball(double x) : ball() { arb_set_d(value_, x); }
    ball(const ball& x) : ball() { arb_set(value_, x.value_); }
    ball& operator=(const ball& x) {
        arb_set(value_, x.value_);
        return *this;
    }
    ~ball() { arb_clear(value_); }
    arb_ptr get() { return value_; }
    arb_srcptr get() const { return value_; }

  private:
    arb_t value_;
};

struct arithmetic : composed<ball, arithmetic> {
    static constexpr slong precision = 53;
    static void add(ball& r, const ball& a, const ball& b) {
        arb_add(r.get(), a.get(), b.get(), precision);
    }
    static void multiply(ball& r, const ball& a, const ball& b) {
        arb_mul(r.get(), a.get(), b.get(), precision);
    }
    static void divide(ball& r, const ball& a, const ball& b) {
        arb_div(r.get(), a.get(), b.get(), precision);
    }
    static void root(ball& r, const ball& a) { arb_sqrt(r.get(), a.get(), precision); }
    static void fused(ball& r, const ball& a, const ball& b, const ball& c) {
        arb_fma(r.get(), a.get(), b.get(), c.get(), precision);
    }
    static void length(ball& r, const ball& a, const ball& b) {
        arb_hypot(r.get(), a.get(), b.get(), precision);
    }
    static void fifth_power(ball& r, const ball& a) { arb_pow_ui(r.get(), a.get(), 5, precision); }
    static void dot(ball& r, const ball* a, const ball* b) {
        arb_dot(r.get(), nullptr, 0, a->get(), 1, b->get(), 1, term_count, precision);
    }
    static errbound::sign_type sign(const ball& a) {
        using enum errbound::sign_type;
        if (arb_is_positive(a.get()) != 0) return positive;
        if (arb_is_negative(a.get()) != 0) return negative;
        return arb_is_zero(a.get()) != 0 ? zero : uncertain;
    }
};

}  // namespace

contestant arb_contestant() {
    return contestant_of<ball, arithmetic>("arb");
}

}  // namespace bench
