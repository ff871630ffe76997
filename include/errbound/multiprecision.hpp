// Boost.Multiprecision's exact numbers as errbound scalars (needs Boost). Its floating-point
// numbers of fixed precision (cpp_bin_float, mpfr_float with a number of digits) need no header, as
// in tracked<cpp_bin_float_100>. They must round to nearest, MPFR's in the default exponent range.
// They have no subnormal numbers: use the rule `tight`; sqrt and fma do not compile.
#pragma once

#include <boost/multiprecision/number.hpp>
#include <errbound/sign.hpp>
#include <limits>

namespace errbound {

/// Unbounded integers and rationals are exact. Fixed-size integers wrap around.
template <class Backend, boost::multiprecision::expression_template_option Et>
inline constexpr bool is_exact_number<boost::multiprecision::number<Backend, Et>> =
    !std::numeric_limits<boost::multiprecision::number<Backend, Et>>::is_bounded &&
    (boost::multiprecision::number_category<Backend>::value ==
         boost::multiprecision::number_kind_integer ||
     boost::multiprecision::number_category<Backend>::value ==
         boost::multiprecision::number_kind_rational);

}  // namespace errbound
