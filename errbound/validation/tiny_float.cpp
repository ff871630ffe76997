// The tables of tiny formats, by MPFR.

#include <algorithm>
#include <errbound/validation/tiny_float.hpp>

namespace errbound::validation {
namespace {

int bias(int exponent_bits) {
    return (1 << (exponent_bits - 1)) - 1;
}

/// Sets MPFR's exponent range to a format's; restores it at the end.
class exponent_range {
  public:
    exponent_range(int precision, int exponent_bits)
        : precision_(precision), exponent_bits_(exponent_bits) {
        // MPFR's mantissas are in [1/2, 1): the smallest number is 2^(emin − 1).
        mpfr_set_emin(3 - bias(exponent_bits) - precision);
        mpfr_set_emax(bias(exponent_bits) + 1);
    }
    ~exponent_range() {
        mpfr_set_emin(emin_);
        mpfr_set_emax(emax_);
    }
    exponent_range(const exponent_range&) = delete;
    exponent_range& operator=(const exponent_range&) = delete;

    /// A result's code; `off` is MPFR's ternary value. Precondition: flags were cleared.
    std::uint16_t code(mpfr_t result, int off, mpfr_rnd_t direction) const {
        off = mpfr_check_range(result, off, direction);
        mpfr_subnormalize(result, off, direction);
        const auto code = tiny_code(mpfr_get_d(result, MPFR_RNDN), precision_, exponent_bits_);
        const bool unnoticed = mpfr_overflow_p() != 0 && mpfr_number_p(result) != 0;
        return static_cast<std::uint16_t>(code | (unnoticed ? unnoticed_overflow : 0));
    }

  private:
    int precision_, exponent_bits_;
    mpfr_exp_t emin_ = mpfr_get_emin(), emax_ = mpfr_get_emax();
};

}  // namespace

std::vector<double> tiny_values(int precision, int exponent_bits) {
    const int fractions = 1 << (precision - 1), exponents = 1 << exponent_bits;
    std::vector<double> values;
    for (const int sign : {1, -1})
        for (int e = 0; e < exponents; ++e)
            for (int fraction = 0; fraction < fractions; ++fraction) {
                const int exponent = (e == 0 ? 1 : e) - bias(exponent_bits) - (precision - 1);
                const double size = std::ldexp(e == 0 ? fraction : fractions + fraction, exponent);
                const double special = fraction == 0 ? std::numeric_limits<double>::infinity()
                                                     : std::numeric_limits<double>::quiet_NaN();
                values.push_back(sign * (e == exponents - 1 ? special : size));
            }
    return values;
}

std::uint8_t tiny_code(double value, int precision, int exponent_bits) {
    const int fractions = 1 << (precision - 1), exponents = 1 << exponent_bits;
    const int infinity = (exponents - 1) * fractions;
    if (std::isnan(value)) return static_cast<std::uint8_t>(infinity + 1);
    const int sign = std::signbit(value) ? exponents * fractions : 0;
    const double size = std::abs(value);
    const int least = 1 - bias(exponent_bits);
    int code = 0;
    if (std::isinf(size)) {
        code = infinity;
    } else if (size > 0) {
        // Units in the last place; 2·fractions of them carry into the exponent.
        const int e = std::max(std::ilogb(size), least);
        const double units = std::nearbyint(std::ldexp(size, precision - 1 - e));
        code = static_cast<int>(std::min<double>((e - least) * fractions + units, infinity));
    }
    return static_cast<std::uint8_t>(sign + code);
}

tiny_tables::tiny_tables(int precision, int exponent_bits, mpfr_rnd_t rounding)
    : bits(precision + exponent_bits), direction(rounding) {
    const std::vector<double> values = tiny_values(precision, exponent_bits);
    const exponent_range range(precision, exponent_bits);
    mpfr_t a, b, r;
    mpfr_inits2(precision, a, b, r, static_cast<mpfr_ptr>(nullptr));
    const auto result = [&](int off) { return range.code(r, off, direction); };
    for (const double x : values) {
        mpfr_set_d(a, x, MPFR_RNDN);
        for (const double y : values) {
            mpfr_set_d(b, y, MPFR_RNDN);
            const auto add_to = [&](std::vector<std::uint16_t>& table, auto operation) {
                mpfr_clear_flags();
                table.push_back(result(operation(r, a, b, direction)));
            };
            add_to(sum, mpfr_add);
            add_to(difference, mpfr_sub);
            add_to(product, mpfr_mul);
            add_to(quotient, mpfr_div);
        }
        mpfr_clear_flags();
        root.push_back(result(mpfr_sqrt(r, a, direction)));
        for (int e = -max_scale; e <= max_scale; ++e) {
            mpfr_clear_flags();
            scaled.push_back(result(mpfr_mul_2si(r, a, e, direction)));
        }
    }
    mpfr_clears(a, b, r, static_cast<mpfr_ptr>(nullptr));
}

std::uint16_t tiny_fma(double a, double b, double c, int precision, int exponent_bits,
                       mpfr_rnd_t direction) {
    const exponent_range range(precision, exponent_bits);
    mpfr_t x, y, z;
    mpfr_inits2(precision, x, y, z, static_cast<mpfr_ptr>(nullptr));
    mpfr_set_d(x, a, MPFR_RNDN);
    mpfr_set_d(y, b, MPFR_RNDN);
    mpfr_set_d(z, c, MPFR_RNDN);
    mpfr_clear_flags();
    const std::uint16_t code = range.code(z, mpfr_fma(z, x, y, z, direction), direction);
    mpfr_clears(x, y, z, static_cast<mpfr_ptr>(nullptr));
    return code;
}

}  // namespace errbound::validation
