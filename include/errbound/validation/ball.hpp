// Real numbers enclosed by MPFR: a midpoint and a radius, |x − midpoint| <= radius.
//
// Sums and products that fit the precision are exact, with radius 0. A midpoint's rounding adds
// half a unit in its last place to the radius; radii are rounded up. So enclosures hold at every
// precision. The exponent range must be MPFR's widest (exponents::widest).
#pragma once

#include <mpfr.h>

#include <errbound/sign.hpp>
#include <errbound/validation/exact_value.hpp>
#include <errbound/validation/mpfr_functions.hpp>
#include <limits>
#include <utility>

namespace errbound::validation {

/// The largest number of operations in an expression.
inline constexpr int max_operations = 48;

/// Beyond all formats' exponents, and far below MPFR's, ±2^62 for a 64-bit long. Larger numbers are
/// unknown, smaller ones nearly zero.
inline constexpr mpfr_exp_t largest_exponent =
    mpfr_exp_t{1} << (std::numeric_limits<mpfr_exp_t>::digits > 40 ? 40 : 27);

/// Sets the thread's exponent range; restores it at the end.
class exponents {
  public:
    static exponents widest() { return {mpfr_get_emin_min(), mpfr_get_emax_max()}; }
    /// MPFR's default, which Boost's numbers need.
    static exponents initial() { return {initial_least, initial_most}; }

    ~exponents() {
        mpfr_set_emin(least_);
        mpfr_set_emax(most_);
    }
    exponents(const exponents&) = delete;
    exponents& operator=(const exponents&) = delete;

  private:
    exponents(mpfr_exp_t least, mpfr_exp_t most) : least_(mpfr_get_emin()), most_(mpfr_get_emax()) {
        mpfr_set_emin(least);
        mpfr_set_emax(most);
    }
    inline static const mpfr_exp_t initial_least = mpfr_get_emin(), initial_most = mpfr_get_emax();
    mpfr_exp_t least_, most_;
};

class mpfr_number {
  public:
    explicit mpfr_number(mpfr_prec_t precision) {
        mpfr_init2(x_, precision);
        mpfr_set_zero(x_, 1);
    }
    mpfr_number(const mpfr_number& other) {
        mpfr_init2(x_, mpfr_get_prec(other.x_));
        mpfr_set(x_, other.x_, MPFR_RNDN);
    }
    mpfr_number& operator=(const mpfr_number& other) {
        if (this != &other) {
            if (mpfr_get_prec(x_) != mpfr_get_prec(other.x_))
                mpfr_set_prec(x_, mpfr_get_prec(other.x_));
            mpfr_set(x_, other.x_, MPFR_RNDN);
        }
        return *this;
    }
    ~mpfr_number() { mpfr_clear(x_); }

    mpfr_ptr get() { return x_; }
    mpfr_srcptr get() const { return x_; }
    /// Sets x, rounded once to nearest; exact at exact_bits. Returns MPFR's ternary value.
    int set(const exact_value& x) {
        if (x.is_double()) return mpfr_set_d(x_, x.leading, MPFR_RNDN);
        MPFR_DECL_INIT(sum, exact_bits);
        mpfr_set_d(sum, x.leading, MPFR_RNDN);
        for (const double part : x.rest) mpfr_add_d(sum, sum, part, MPFR_RNDN);
        return mpfr_mul_2si(x_, sum, x.exponent, MPFR_RNDN);
    }

  private:
    mpfr_t x_;
};

class ball {
  public:
    /// Exactly zero; `precision`: bits of midpoints.
    explicit ball(mpfr_prec_t precision) : middle_(precision), radius_(radius_precision) {}

    /// Exactly zero, with another precision.
    void restart(mpfr_prec_t precision) {
        mpfr_set_prec(middle_.get(), precision);
        mpfr_set_zero(middle_.get(), 1);
        mpfr_set_zero(radius_.get(), 1);
    }
    void set(const exact_value& value) {
        mpfr_set_zero(radius_.get(), 1);
        rounded(middle_.set(value));
    }
    void set(const exact_value& value, const exact_value& error, int quarters) {
        mpfr_number sum(exact_bits), part(exact_bits + 3);
        sum.set(value);
        part.set(error);
        mpfr_mul_si(part.get(), part.get(), quarters, MPFR_RNDN);
        mpfr_mul_2si(part.get(), part.get(), -2, MPFR_RNDN);
        mpfr_set_zero(radius_.get(), 1);
        rounded(mpfr_add(middle_.get(), sum.get(), part.get(), MPFR_RNDN));
    }
    /// Encloses the exact number that set(to) rounds and stores in `to`. set returns MPFR's ternary
    /// value.
    template <class Set>
    void set_rounded(const Set& set) {
        mpfr_set_zero(radius_.get(), 1);
        rounded(set(middle_.get()));
    }
    void set_sum(const ball& a, const ball& b) {
        const int off = mpfr_add(middle_.get(), a.middle(), b.middle(), MPFR_RNDN);
        mpfr_add(radius_.get(), a.radius(), b.radius(), MPFR_RNDU);
        rounded(off);
    }
    void set_difference(const ball& a, const ball& b) {
        const int off = mpfr_sub(middle_.get(), a.middle(), b.middle(), MPFR_RNDN);
        mpfr_add(radius_.get(), a.radius(), b.radius(), MPFR_RNDU);
        rounded(off);
    }
    /// |xy − ab| <= |a|·rb + ra·(|b| + rb). Zero times an unknown number is zero.
    void set_product(const ball& a, const ball& b) {
        if ((a.is_zero() && b.is_defined()) || (a.is_defined() && b.is_zero())) {
            set(0);
            return;
        }
        const int off = mpfr_mul(middle_.get(), a.middle(), b.middle(), MPFR_RNDN);
        if (a.is_exact() && b.is_exact()) {
            mpfr_set_zero(radius_.get(), 1);
        } else if (a.is_unknown() || b.is_unknown()) {
            mpfr_set_inf(radius_.get(), 1);
        } else {
            MPFR_DECL_INIT(left, radius_precision);
            MPFR_DECL_INIT(right, radius_precision);
            mpfr_abs(left, a.middle(), MPFR_RNDU);
            mpfr_mul(left, left, b.radius(), MPFR_RNDU);
            mpfr_abs(right, b.middle(), MPFR_RNDU);
            mpfr_add(right, right, b.radius(), MPFR_RNDU);
            mpfr_mul(right, right, a.radius(), MPFR_RNDU);
            mpfr_add(radius_.get(), left, right, MPFR_RNDU);
        }
        rounded(off);
    }
    /// |x/y − a/b| <= (ra + |a/b|·rb)/(|b| − rb). Undefined if b is 0, unknown if b may be 0.
    void set_quotient(const ball& a, const ball& b) {
        if (b.is_zero()) {
            set_undefined();
            return;
        }
        MPFR_DECL_INIT(distance, radius_precision);
        mpfr_abs(distance, b.middle(), MPFR_RNDD);
        mpfr_sub(distance, distance, b.radius(), MPFR_RNDD);
        if (a.is_unknown() || !(mpfr_sgn(distance) > 0)) {
            if (!a.is_defined() || !b.is_defined())
                set_undefined();
            else
                set_unknown();
            return;
        }
        MPFR_DECL_INIT(size, radius_precision);
        const int off = mpfr_div(middle_.get(), a.middle(), b.middle(), MPFR_RNDN);
        mpfr_abs(size, middle_.get(), MPFR_RNDU);
        if (off != 0) mpfr_nextabove(size);  // at least |a/b| itself
        mpfr_mul(size, size, b.radius(), MPFR_RNDU);
        mpfr_add(size, size, a.radius(), MPFR_RNDU);
        mpfr_div(radius_.get(), size, distance, MPFR_RNDU);
        rounded(off);
    }
    void set_negative(const ball& a) {
        mpfr_neg(middle_.get(), a.middle(), MPFR_RNDN);
        mpfr_set(radius_.get(), a.radius(), MPFR_RNDU);
    }
    /// |√x − √m| <= r/√m. Undefined if a is below 0, unknown if it may be.
    void set_root(const ball& a) {
        MPFR_DECL_INIT(least, radius_precision);
        mpfr_sub(least, a.middle(), a.radius(), MPFR_RNDD);
        if (!a.is_defined() || a.sign() == sign_type::negative) {
            set_undefined();
            return;
        }
        if (a.is_unknown() || mpfr_sgn(least) < 0) {
            set_unknown();
            return;
        }
        mpfr_set(radius_.get(), a.radius(), MPFR_RNDU);
        if (!a.is_exact()) {
            mpfr_sqrt(least, a.middle(), MPFR_RNDD);
            mpfr_div(radius_.get(), radius_.get(), least, MPFR_RNDU);
        }
        rounded(mpfr_sqrt(middle_.get(), a.middle(), MPFR_RNDN));
    }
    /// √ of a sum of squares, which is not negative even if the enclosure is.
    void set_root_of_squares(const ball& a) {
        MPFR_DECL_INIT(most, radius_precision);
        mpfr_sub(most, a.middle(), a.radius(), MPFR_RNDD);
        if (!a.is_defined() || a.is_unknown() || mpfr_sgn(most) >= 0) return set_root(a);
        mpfr_add(most, a.middle(), a.radius(), MPFR_RNDU);
        mpfr_set_zero(middle_.get(), 1);
        mpfr_sqrt(radius_.get(), most, MPFR_RNDU);
    }
    void set_absolute(const ball& a) {
        mpfr_abs(middle_.get(), a.middle(), MPFR_RNDN);
        mpfr_set(radius_.get(), a.radius(), MPFR_RNDU);
    }
    /// |x| with b's sign; zero counts as positive. If b's sign is uncertain, encloses [−|x|, |x|].
    void set_with_sign(const ball& a, const ball& b) {
        if (!a.is_defined() || !b.is_defined()) return set_undefined();
        if (b.is_unknown()) return set_unknown();
        const sign_type sign = b.sign();
        set_absolute(a);
        if (sign == sign_type::negative) mpfr_neg(middle_.get(), middle_.get(), MPFR_RNDN);
        if (!certain(sign)) widen_about_zero();
    }
    /// The lesser or the greater: |max(x, y) − max(a, b)| <= max(ra, rb).
    void set_lesser(const ball& a, const ball& b) { set_one(a, b, mpfr_lessequal_p); }
    void set_greater(const ball& a, const ball& b) { set_one(a, b, mpfr_greaterequal_p); }
    void set_fused(const ball& a, const ball& b, const ball& c) {
        ball product(mpfr_get_prec(middle_.get()));
        product.set_product(a, b);
        set_sum(product, c);
    }
    /// f over a, and b if it has two arguments. Undefined if it has no value there, unknown if it
    /// may have none or the precision is too small.
    void set_function(elementary_function f, const ball& a, const ball& b);
    void set_scaled(const ball& a, int e) {
        mpfr_mul_2si(middle_.get(), a.middle(), e, MPFR_RNDN);
        mpfr_mul_2si(radius_.get(), a.radius(), e, MPFR_RNDU);
    }

    mpfr_srcptr middle() const { return middle_.get(); }
    mpfr_srcptr radius() const { return radius_.get(); }
    bool is_exact() const { return mpfr_zero_p(radius_.get()) != 0; }
    bool is_zero() const { return is_exact() && mpfr_zero_p(middle_.get()) != 0; }
    /// True if the precision was too small, such as to separate a divisor from zero.
    bool is_unknown() const { return mpfr_inf_p(radius_.get()) != 0; }
    /// False after a division by exactly zero.
    bool is_defined() const { return mpfr_nan_p(middle_.get()) == 0; }
    /// The sign of all numbers in the ball, or `uncertain`.
    sign_type sign() const {
        if (!is_defined()) return sign_type::uncertain;
        if (mpfr_cmpabs(middle_.get(), radius_.get()) <= 0)
            return is_zero() ? sign_type::zero : sign_type::uncertain;
        return mpfr_sgn(middle_.get()) > 0 ? sign_type::positive : sign_type::negative;
    }

  private:
    static constexpr mpfr_prec_t radius_precision = 64;

    void set_undefined() { mpfr_set_nan(middle_.get()); }
    void set_unknown() {
        mpfr_set_zero(middle_.get(), 1);
        mpfr_set_inf(radius_.get(), 1);
    }
    void set_function_of_one(elementary_function f, const ball& a);
    void set_function_of_two(elementary_function f, const ball& a, const ball& b);
    void set_power(const ball& a, const ball& b);
    void set_angle(const ball& a, const ball& b);
    /// Encloses [lower, upper]; unknown unless both are finite.
    void set_between(mpfr_srcptr lower, mpfr_srcptr upper);
    /// Call after setting the midpoint to a function's rounded value.
    void set_computed(int off);
    /// Widens to all numbers no larger in size.
    void widen_about_zero() {
        MPFR_DECL_INIT(size, radius_precision);
        mpfr_abs(size, middle_.get(), MPFR_RNDU);
        mpfr_add(radius_.get(), radius_.get(), size, MPFR_RNDU);
        mpfr_set_zero(middle_.get(), 1);
    }
    /// Replaces a midpoint whose exponent is beyond `largest`.
    void confine(mpfr_exp_t largest);

    /// Sets the number that `first` chooses, with its own radius if the choice is certain.
    void set_one(const ball& a, const ball& b, int (*first)(mpfr_srcptr, mpfr_srcptr)) {
        if (!a.is_defined() || !b.is_defined()) {
            set_undefined();
            return;
        }
        MPFR_DECL_INIT(apart, radius_precision);
        MPFR_DECL_INIT(radii, radius_precision);
        mpfr_sub(apart, a.middle(), b.middle(), MPFR_RNDZ);
        mpfr_add(radii, a.radius(), b.radius(), MPFR_RNDU);
        const bool certain = mpfr_cmpabs(apart, radii) > 0;
        const ball& chosen = first(a.middle(), b.middle()) != 0 ? a : b;
        mpfr_max(radii, a.radius(), b.radius(), MPFR_RNDU);
        const mpfr_number radius = chosen.radius_;
        mpfr_set(middle_.get(), chosen.middle(), MPFR_RNDN);
        mpfr_set(radius_.get(), certain ? radius.get() : static_cast<mpfr_srcptr>(radii),
                 MPFR_RNDU);
    }

    /// Adds half a unit in the last place for a rounded midpoint.
    void rounded(int off) {
        if (mpfr_regular_p(middle_.get()) == 0) return;
        const mpfr_exp_t e = mpfr_get_exp(middle_.get());
        if (off != 0) {
            MPFR_DECL_INIT(half, radius_precision);
            mpfr_set_ui_2exp(half, 1, e - mpfr_get_prec(middle_.get()) - 1, MPFR_RNDU);
            mpfr_add(radius_.get(), radius_.get(), half, MPFR_RNDU);
        }
        if (e > largest_exponent || e < -largest_exponent) confine(largest_exponent);
    }

    mpfr_number middle_, radius_;
};

/// The verdict on a claim.
enum class judgement { holds, violated, undetermined };

/// Bounds of |value − x| for a finite value and x in a ball.
class deviation {
  public:
    deviation() : lower_(precision), upper_(precision), value_(exact_bits) {}

    void compute(const exact_value& value, const ball& x) {
        value_.set(value);
        const int off = mpfr_sub(lower_.get(), value_.get(), x.middle(), MPFR_RNDZ);
        mpfr_abs(lower_.get(), lower_.get(), MPFR_RNDN);
        mpfr_set(upper_.get(), lower_.get(), MPFR_RNDN);
        if (off != 0) mpfr_nextabove(upper_.get());
        if (x.is_exact()) return;
        mpfr_add(upper_.get(), upper_.get(), x.radius(), MPFR_RNDU);
        mpfr_sub(lower_.get(), lower_.get(), x.radius(), MPFR_RNDD);
    }
    /// error·quarters/4.
    void set(const exact_value& error, int quarters) {
        value_.set(error);
        // Exact: formats have fewer bits.
        mpfr_mul_si(upper_.get(), value_.get(), quarters, MPFR_RNDN);
        mpfr_mul_2si(upper_.get(), upper_.get(), -2, MPFR_RNDN);
        mpfr_abs(upper_.get(), upper_.get(), MPFR_RNDN);
        mpfr_set(lower_.get(), upper_.get(), MPFR_RNDN);
    }
    judgement at_most(const exact_value& bound) const {
        mpfr_number most(exact_bits);
        most.set(bound);
        if (mpfr_lessequal_p(upper_.get(), most.get())) return judgement::holds;
        return mpfr_greater_p(lower_.get(), most.get()) ? judgement::violated
                                                        : judgement::undetermined;
    }
    bool is_zero() const { return mpfr_zero_p(upper_.get()) != 0; }
    /// True if zero, or if the enclosure is too wide for its size.
    bool is_negligible() const {
        return is_zero() || mpfr_sgn(lower_.get()) <= 0 ||
               mpfr_get_exp(upper_.get()) > mpfr_get_exp(lower_.get()) + 1;
    }
    /// Precondition: not negligible.
    double log10() const { return log10_of(upper_.get()); }
    mpfr_srcptr upper() const { return upper_.get(); }
    double lower() const { return mpfr_get_d(lower_.get(), MPFR_RNDD); }

    /// Precondition: x > 0.
    static double log10_of(mpfr_srcptr x);

  private:
    static constexpr mpfr_prec_t precision = exact_bits;
    mpfr_number lower_, upper_, value_;
};

}  // namespace errbound::validation
