// Real roots isolated by arb, for benchmarks.
#pragma once

#include <arb_fmpz_poly.h>

#include <cstddef>

#include "tests/errbound/roots/flint_polynomial.hpp"

/// The number of distinct real roots, of which all are enclosed to 32 bits, as are the complex
/// ones: arb isolates no others alone.
inline std::size_t isolate_by_arb(const flint_polynomial& p) {
    fmpz_poly_t f;
    fmpz_poly_init(f);
    p.squarefree(f);
    const slong degree = fmpz_poly_degree(f);
    const acb_ptr roots = _acb_vec_init(degree);
    arb_fmpz_poly_complex_roots(roots, f, 0, 32);
    std::size_t real = 0;
    for (slong i = 0; i < degree; ++i) real += arb_is_zero(acb_imagref(roots + i)) != 0;
    _acb_vec_clear(roots, degree);
    fmpz_poly_clear(f);
    return real;
}
