// Intervals of Boost.Interval. Source files that use them are compiled for changes of the rounding
// mode.
#pragma once

#include <boost/numeric/interval.hpp>
#include <errbound/sign.hpp>

namespace bench {

using boost_interval = boost::numeric::interval<double>;

/// The sign is uncertain after an overflow, which leaves NaN or infinity.
inline errbound::sign_type sign_of_interval(const boost_interval& x) {
    if (x.lower() > 0) return errbound::sign_type::positive;
    if (x.upper() < 0) return errbound::sign_type::negative;
    return x.lower() == 0 && x.upper() == 0 ? errbound::sign_type::zero
                                            : errbound::sign_type::uncertain;
}

}  // namespace bench
