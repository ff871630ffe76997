// Intervals of Boost.Interval, for benchmarks beside it: in source files that are compiled for
// changes of the rounding mode.
#pragma once

#include <boost/numeric/interval.hpp>
#include <errbound/sign.hpp>

namespace bench {

using boost_interval = boost::numeric::interval<double>;

/// Overflow leaves NaN or infinity, and everything open.
inline errbound::sign_type sign_of_interval(const boost_interval& x) {
    if (x.lower() > 0) return errbound::sign_type::positive;
    if (x.upper() < 0) return errbound::sign_type::negative;
    return x.lower() == 0 && x.upper() == 0 ? errbound::sign_type::zero
                                            : errbound::sign_type::uncertain;
}

}  // namespace bench
