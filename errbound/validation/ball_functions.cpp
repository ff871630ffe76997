// Elementary functions of enclosures: at the ends of monotone pieces, or by the slope.
#include <errbound/validation/ball.hpp>

namespace errbound::validation {
namespace {

/// For arguments of sin, cos and tan: MPFR needs as many bits of π as the exponent.
constexpr mpfr_exp_t largest_exponent_of_angles = 20000;

/// Results above 2^this are unknown, those below 2^-this nearly zero. Every format with elementary
/// functions overflows and underflows there, too.
constexpr mpfr_exp_t largest_exponent_of_results = 1 << 15;

bool is_wave(elementary_function f) {
    return f == elementary_function::sin || f == elementary_function::cos ||
           f == elementary_function::tan;
}

struct ends {
    mpfr_number lower, upper;

    explicit ends(const ball& x)
        : lower(mpfr_get_prec(x.middle()) + 64), upper(mpfr_get_prec(x.middle()) + 64) {
        mpfr_sub(lower.get(), x.middle(), x.radius(), MPFR_RNDD);
        mpfr_add(upper.get(), x.middle(), x.radius(), MPFR_RNDU);
    }
    bool are_of_one_sign() const { return mpfr_sgn(lower.get()) * mpfr_sgn(upper.get()) > 0; }
    bool have_zero_between() const {
        return mpfr_sgn(lower.get()) <= 0 && mpfr_sgn(upper.get()) >= 0;
    }
};

/// Encloses numbers, each rounded outwards.
class hull {
  public:
    explicit hull(mpfr_prec_t precision) : lower_(precision), upper_(precision), one_(precision) {}

    template <class Compute>
    void add(const Compute& compute) {
        compute(one_.get(), MPFR_RNDD);
        if (empty_ || mpfr_less_p(one_.get(), lower_.get()) || mpfr_nan_p(one_.get()))
            mpfr_set(lower_.get(), one_.get(), MPFR_RNDD);
        compute(one_.get(), MPFR_RNDU);
        if (empty_ || mpfr_greater_p(one_.get(), upper_.get()) || mpfr_nan_p(one_.get()))
            mpfr_set(upper_.get(), one_.get(), MPFR_RNDU);
        empty_ = false;
    }
    void add_corners(elementary_function f, const ends& a, const ends& b) {
        for (const mpfr_srcptr first : {a.lower.get(), a.upper.get()})
            for (const mpfr_srcptr second : {b.lower.get(), b.upper.get()})
                add([&](mpfr_ptr to, mpfr_rnd_t direction) {
                    mpfr_of_two(f, to, first, second, direction);
                });
    }
    mpfr_srcptr lower() const { return lower_.get(); }
    mpfr_srcptr upper() const { return upper_.get(); }

  private:
    mpfr_number lower_, upper_, one_;
    bool empty_ = true;
};

/// True if the tangent may have a pole between the ends. Within a period, it has one if and only if
/// it falls from one end to the other (in 64 bits).
bool has_pole(const ends& x) {
    MPFR_DECL_INIT(width, 64);
    mpfr_sub(width, x.upper.get(), x.lower.get(), MPFR_RNDU);
    if (mpfr_cmp_ui(width, 3) > 0) return true;
    mpfr_number left(64), right(64);
    mpfr_tan(left.get(), x.lower.get(), MPFR_RNDN);
    mpfr_tan(right.get(), x.upper.get(), MPFR_RNDN);
    return mpfr_lessequal_p(left.get(), right.get()) == 0;
}

/// True if the corners and x = 0 have the extrema of x^y: for x > 0, and for whole y if x < 0 or
/// y > 0.
bool has_monotone_power(const ends& x, const ball& y) {
    const bool is_whole = y.is_exact() && mpfr_integer_p(y.middle()) != 0;
    return mpfr_sgn(x.lower.get()) > 0 ||
           (is_whole && (mpfr_sgn(x.upper.get()) < 0 || mpfr_sgn(y.middle()) > 0));
}

/// True if the angle is monotone: away from the origin and the lower side of the negative x axis.
bool has_monotone_angle(const ends& y, const ends& x) {
    if (mpfr_sgn(y.lower.get()) >= 0) return !(y.have_zero_between() && x.have_zero_between());
    return mpfr_sgn(y.upper.get()) < 0 || mpfr_sgn(x.lower.get()) > 0;
}

}  // namespace

void ball::set_between(mpfr_srcptr lower, mpfr_srcptr upper) {
    if (mpfr_number_p(lower) == 0 || mpfr_number_p(upper) == 0) {
        set_unknown();
        return;
    }
    mpfr_number twice(mpfr_get_prec(middle_.get()) + 64);
    mpfr_add(twice.get(), lower, upper, MPFR_RNDN);
    mpfr_div_2ui(middle_.get(), twice.get(), 1, MPFR_RNDN);
    MPFR_DECL_INIT(below, radius_precision);
    mpfr_sub(radius_.get(), upper, middle_.get(), MPFR_RNDU);
    mpfr_sub(below, middle_.get(), lower, MPFR_RNDU);
    mpfr_max(radius_.get(), radius_.get(), below, MPFR_RNDU);
    confine(largest_exponent_of_results);
}

void ball::set_computed(int off) {
    if (off != 0 && mpfr_zero_p(middle_.get())) mpfr_nextabove(radius_.get());
    rounded(off);
    confine(largest_exponent_of_results);
}

void ball::confine(mpfr_exp_t largest) {
    if (mpfr_zero_p(middle_.get())) return;
    if (mpfr_number_p(middle_.get()) == 0 || mpfr_get_exp(middle_.get()) > largest) {
        set_unknown();
    } else if (mpfr_get_exp(middle_.get()) < -largest) {
        widen_about_zero();
    }
}

void ball::set_function(elementary_function f, const ball& a, const ball& b) {
    if (has_two_arguments(f))
        set_function_of_two(f, a, b);
    else
        set_function_of_one(f, a);
}

void ball::set_function_of_one(elementary_function f, const ball& a) {
    if (!a.is_defined()) return set_undefined();
    if (a.is_unknown()) return set_unknown();
    if (is_wave(f) && mpfr_regular_p(a.middle()) != 0 &&
        mpfr_get_exp(a.middle()) > largest_exponent_of_angles)
        return set_unknown();
    const mpfr_function compute = mpfr_function_of(f);
    if (a.is_exact()) {
        if (!has_value(f, a.middle())) return set_undefined();
        mpfr_set_zero(radius_.get(), 1);
        return set_computed(compute(middle_.get(), a.middle(), MPFR_RNDN));
    }
    if (f == elementary_function::sin || f == elementary_function::cos) {
        mpfr_set(radius_.get(), a.radius(), MPFR_RNDU);
        return set_computed(compute(middle_.get(), a.middle(), MPFR_RNDN));
    }
    const ends x(a);
    const bool low = has_value(f, x.lower.get()), high = has_value(f, x.upper.get());
    if (!low && !high && x.are_of_one_sign()) return set_undefined();
    if (!low || !high || (f == elementary_function::tan && has_pole(x))) return set_unknown();
    hull all(mpfr_get_prec(middle_.get()) + 64);
    for (const mpfr_srcptr end : {x.lower.get(), x.upper.get()})
        all.add([&](mpfr_ptr to, mpfr_rnd_t direction) { compute(to, end, direction); });
    if (f == elementary_function::cosh && x.have_zero_between())
        all.add([&](mpfr_ptr to, mpfr_rnd_t) { mpfr_set_ui(to, 1, MPFR_RNDN); });
    set_between(all.lower(), all.upper());
}

void ball::set_function_of_two(elementary_function f, const ball& a, const ball& b) {
    if (!a.is_defined() || !b.is_defined()) return set_undefined();
    if (a.is_unknown() || b.is_unknown()) return set_unknown();
    if (a.is_exact() && b.is_exact()) {
        if (!has_value(f, a.middle(), b.middle())) return set_undefined();
        mpfr_set_zero(radius_.get(), 1);
        return set_computed(mpfr_of_two(f, middle_.get(), a.middle(), b.middle(), MPFR_RNDN));
    }
    if (f == elementary_function::pow)
        set_power(a, b);
    else
        set_angle(a, b);
}

void ball::set_power(const ball& a, const ball& b) {
    const ends x(a), y(b);
    if (a.is_zero() && mpfr_sgn(y.lower.get()) > 0) return set(0);
    if (b.is_zero()) return set(1);
    if (b.is_exact() && mpfr_cmp_ui(b.middle(), 1) == 0) {
        mpfr_set(radius_.get(), a.radius(), MPFR_RNDU);
        return set_computed(mpfr_set(middle_.get(), a.middle(), MPFR_RNDN));
    }
    if (!has_monotone_power(x, b)) return set_unknown();
    hull all(mpfr_get_prec(middle_.get()) + 64);
    all.add_corners(elementary_function::pow, x, y);
    if (x.have_zero_between()) all.add([](mpfr_ptr to, mpfr_rnd_t) { mpfr_set_zero(to, 1); });
    set_between(all.lower(), all.upper());
}

void ball::set_angle(const ball& a, const ball& b) {
    const ends y(a), x(b);
    if (y.have_zero_between() && x.have_zero_between()) return set_unknown();
    hull all(mpfr_get_prec(middle_.get()) + 64);
    if (has_monotone_angle(y, x)) {
        all.add_corners(elementary_function::atan2, y, x);
    } else {  // on either side of the cut
        all.add([](mpfr_ptr to, mpfr_rnd_t direction) { mpfr_const_pi(to, direction); });
        all.add([](mpfr_ptr to, mpfr_rnd_t direction) {
            mpfr_const_pi(to, direction == MPFR_RNDD ? MPFR_RNDU : MPFR_RNDD);
            mpfr_neg(to, to, MPFR_RNDN);
        });
    }
    set_between(all.lower(), all.upper());
}

}  // namespace errbound::validation
