// FLINT's count of real roots, for tests and benchmarks.
#pragma once

#include <flint/fmpz_poly.h>

#include <cstddef>
#include <vector>

#include "tests/errbound/roots/polynomial_families.hpp"

class flint_polynomial {
  public:
    explicit flint_polynomial(const std::vector<polynomial_families::integer>& coefficients) {
        fmpz_poly_init(p_);
        fmpz_t c;
        fmpz_init(c);
        for (std::size_t i = 0; i < coefficients.size(); ++i) {
            fmpz_set_mpz(c, coefficients[i].backend().data());
            fmpz_poly_set_coeff_fmpz(p_, static_cast<slong>(i), c);
        }
        fmpz_clear(c);
    }
    flint_polynomial(const flint_polynomial&) = delete;
    flint_polynomial& operator=(const flint_polynomial&) = delete;
    ~flint_polynomial() { fmpz_poly_clear(p_); }

    /// On the whole line. (FLINT requires a polynomial without multiple roots.)
    std::size_t distinct_real_roots() const {
        fmpz_poly_t f;
        fmpz_poly_init(f);
        squarefree(f);
        const slong count = fmpz_poly_num_real_roots(f);
        fmpz_poly_clear(f);
        return static_cast<std::size_t>(count);
    }
    /// In [0, ∞).
    std::size_t distinct_nonnegative_roots() const {
        fmpz_poly_t f;
        fmpz_poly_init(f);
        squarefree(f);
        std::size_t count = 0;
        if (fmpz_is_zero(fmpz_poly_get_coeff_ptr(f, 0))) {
            ++count;
            fmpz_poly_shift_right(f, f, 1);
        }
        slong negative = 0, positive = 0;
        if (fmpz_poly_degree(f) > 0)
            _fmpz_poly_num_real_roots_sturm(&negative, &positive, f->coeffs, f->length);
        fmpz_poly_clear(f);
        return count + static_cast<std::size_t>(positive);
    }

    /// f = p without its factors' multiplicities.
    void squarefree(fmpz_poly_t f) const {
        fmpz_poly_t slope, common;
        fmpz_poly_init(slope);
        fmpz_poly_init(common);
        fmpz_poly_derivative(slope, p_);
        fmpz_poly_gcd(common, p_, slope);
        fmpz_poly_div(f, p_, common);
        fmpz_poly_clear(slope);
        fmpz_poly_clear(common);
    }

  private:
    fmpz_poly_t p_;
};
