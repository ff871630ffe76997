// The part of the soak that counts and isolates roots, where FLINT is installed.
#pragma once

#include "tests/soak/long_run.hpp"

namespace soak {

/// Polynomials of every family of tests/errbound/roots, and with roots that nearly coincide:
/// isolate_roots and count_roots by errbound's own integers and by GMP's, on the line and on its
/// positive half, against FLINT's counts.
part polynomial_part();

}  // namespace soak
