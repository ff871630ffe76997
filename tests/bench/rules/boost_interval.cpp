#include <boost/numeric/interval.hpp>

#include "tests/bench/rules/contestants.hpp"

namespace bench {
namespace {

using interval = boost::numeric::interval<double>;

struct arithmetic : composed<interval, arithmetic>, by_operators<interval> {
    using by_operators::made;
    static void root(interval& r, const interval& a) { r = boost::numeric::sqrt(a); }
    /// Boost.Interval has no fused operation: computes a product and a sum.
    static void fused(interval& r, const interval& a, const interval& b, const interval& c) {
        r = a * b + c;
    }
    static void fifth_power(interval& r, const interval& a) { r = boost::numeric::pow(a, 5); }
    /// The sign is uncertain after an overflow, which leaves NaN or infinity.
    static errbound::sign_type sign(const interval& x) {
        using enum errbound::sign_type;
        if (x.lower() > 0) return positive;
        if (x.upper() < 0) return negative;
        return x.lower() == 0 && x.upper() == 0 ? zero : uncertain;
    }
};

}  // namespace

contestant boost_interval_contestant() {
    return contestant_of<interval, arithmetic>("Boost.Interval");
}

}  // namespace bench
