#include "tests/bench/peers/boost_interval.hpp"
#include "tests/bench/predicates/predicate_peers.hpp"

namespace bench {

template <class Form>
void decide_by_boost_interval(const set_of<Form>& set, std::size_t count, signs& out) {
    decide_over<Form>(
        set, count, out, [](double x) { return boost_interval(x); },
        [](const boost_interval& x) { return sign_of_interval(x); });
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
