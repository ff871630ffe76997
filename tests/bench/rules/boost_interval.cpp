#include "tests/bench/peers/boost_interval.hpp"

#include "tests/bench/rules/contestants.hpp"

namespace bench {
namespace {

struct arithmetic : by_operators<boost_interval>, composed<boost_interval, arithmetic> {
    static void root(boost_interval& r, const boost_interval& a) { r = boost::numeric::sqrt(a); }
    /// Boost.Interval has no fused operation: computes a product and a sum.
    static void fused(boost_interval& r, const boost_interval& a, const boost_interval& b,
                      const boost_interval& c) {
        r = a * b + c;
    }
    static void absolute(boost_interval& r, const boost_interval& a) { r = boost::numeric::abs(a); }
    static void lesser(boost_interval& r, const boost_interval& a, const boost_interval& b) {
        r = boost::numeric::min(a, b);
    }
    static void greater(boost_interval& r, const boost_interval& a, const boost_interval& b) {
        r = boost::numeric::max(a, b);
    }
    static void fifth_power(boost_interval& r, const boost_interval& a) {
        r = boost::numeric::pow(a, 5);
    }
    static errbound::sign_type sign(const boost_interval& a) { return sign_of_interval(a); }
};

}  // namespace

contestant boost_interval_contestant() {
    return contestant_of<boost_interval, arithmetic>("Boost.Interval");
}

}  // namespace bench
