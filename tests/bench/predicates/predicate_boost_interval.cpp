#include <boost/numeric/interval.hpp>

#include "tests/bench/predicates/predicate_peers.hpp"

namespace bench {

template <class Form>
void decide_by_boost_interval(const set_of<Form>& set, std::size_t count, signs& out) {
    using interval = boost::numeric::interval<double>;
    decide_over<Form>(
        set, count, out, [](double x) { return interval(x); },
        [](const interval& x) {
            // Overflow leaves NaN or infinity, and everything open.
            if (x.lower() > 0) return errbound::sign_type::positive;
            if (x.upper() < 0) return errbound::sign_type::negative;
            return x.lower() == 0 && x.upper() == 0 ? errbound::sign_type::zero
                                                    : errbound::sign_type::uncertain;
        });
}
template void decide_by_boost_interval<orient2d_form>(const set_of<orient2d_form>&, std::size_t,
                                                      signs&);
template void decide_by_boost_interval<orient3d_form>(const set_of<orient3d_form>&, std::size_t,
                                                      signs&);
template void decide_by_boost_interval<incircle_form>(const set_of<incircle_form>&, std::size_t,
                                                      signs&);
template void decide_by_boost_interval<insphere_form>(const set_of<insphere_form>&, std::size_t,
                                                      signs&);

}  // namespace bench
