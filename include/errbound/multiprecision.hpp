// Boost.Multiprecision's exact numbers as errbound scalars (optional header; needs Boost).
//
// Floating-point numbers of fixed precision (cpp_bin_float, mpfr_float with a number of digits)
// need no header: tracked<cpp_bin_float_100>. They must round to nearest, MPFR's in the default
// exponent range. Without subnormal numbers, use the rule `tight`; sqrt and fma do not compile.
#pragma once

#include <boost/multiprecision/number.hpp>
#include <errbound/sign.hpp>
#include <limits>

namespace errbound {

/// Integers and rationals of unbounded size are exact. Fixed-size integers wrap around and
/// floating-point numbers round, so they are not.
template <class Backend, boost::multiprecision::expression_template_option Et>
inline constexpr bool is_exact_number<boost::multiprecision::number<Backend, Et>> =
    !std::numeric_limits<boost::multiprecision::number<Backend, Et>>::is_bounded &&
    (boost::multiprecision::number_category<Backend>::value ==
         boost::multiprecision::number_kind_integer ||
     boost::multiprecision::number_category<Backend>::value ==
         boost::multiprecision::number_kind_rational);

}  // namespace errbound
