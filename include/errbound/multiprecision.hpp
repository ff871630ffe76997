// Boost.Multiprecision's numbers as errbound scalars (optional header; needs Boost): which are
// exact.
//
// Its floating-point numbers of a fixed precision that round to nearest, cpp_bin_float and
// mpfr_float with a number of digits, are number types as they are, tracked<cpp_bin_float_100>,
// without this header. They have no subnormal numbers: the rule is `tight`, and sqrt and fma do not
// compile. MPFR's range of exponents must be the one that it starts with.
#pragma once

#include <boost/multiprecision/number.hpp>
#include <errbound/sign.hpp>
#include <limits>

namespace errbound {

/// Integers and rationals of unbounded size are exact; fixed-size ones, which wrap around,
/// and floating-point ones are not.
template <class Backend, boost::multiprecision::expression_template_option Et>
inline constexpr bool is_exact_number<boost::multiprecision::number<Backend, Et>> =
    !std::numeric_limits<boost::multiprecision::number<Backend, Et>>::is_bounded &&
    (boost::multiprecision::number_category<Backend>::value ==
         boost::multiprecision::number_kind_integer ||
     boost::multiprecision::number_category<Backend>::value ==
         boost::multiprecision::number_kind_rational);

}  // namespace errbound
