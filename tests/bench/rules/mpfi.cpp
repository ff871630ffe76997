#include "tests/bench/peers/mpfi_interval.hpp"
#include "tests/bench/rules/contestants.hpp"

namespace bench {
namespace {

/// Operations in place, which avoid the operators' copies.
struct arithmetic : composed<mpfi_interval, arithmetic> {
    using number = mpfi_interval;
    static number made(double x, double y) { return number(x) * number(y); }
    static void add(number& r, const number& a, const number& b) {
        mpfi_add(r.get(), a.get(), b.get());
    }
    static void subtract(number& r, const number& a, const number& b) {
        mpfi_sub(r.get(), a.get(), b.get());
    }
    static void multiply(number& r, const number& a, const number& b) {
        mpfi_mul(r.get(), a.get(), b.get());
    }
    static void divide(number& r, const number& a, const number& b) {
        mpfi_div(r.get(), a.get(), b.get());
    }
    static void root(number& r, const number& a) { mpfi_sqrt(r.get(), a.get()); }
    /// MPFI has no fused operation: computes a product and a sum.
    static void fused(number& r, const number& a, const number& b, const number& c) {
        mpfi_mul(r.get(), a.get(), b.get());
        mpfi_add(r.get(), r.get(), c.get());
    }
    static void absolute(number& r, const number& a) { mpfi_abs(r.get(), a.get()); }
    /// MPFI has no minimum or maximum, either.
    static void lesser(number& r, const number& a, const number& b) {
        mpfr_min(&r.get()->left, &a.get()->left, &b.get()->left, MPFR_RNDD);
        mpfr_min(&r.get()->right, &a.get()->right, &b.get()->right, MPFR_RNDU);
    }
    static void greater(number& r, const number& a, const number& b) {
        mpfr_max(&r.get()->left, &a.get()->left, &b.get()->left, MPFR_RNDD);
        mpfr_max(&r.get()->right, &a.get()->right, &b.get()->right, MPFR_RNDU);
    }
    static void length(number& r, const number& a, const number& b) {
        mpfi_hypot(r.get(), a.get(), b.get());
    }
    static errbound::sign_type sign(const number& a) { return sign_of(a); }
};

}  // namespace

contestant mpfi_contestant() {
    return contestant_of<mpfi_interval, arithmetic>("MPFI");
}

}  // namespace bench
