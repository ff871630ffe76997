#include "tests/bench/peers/mpfi_interval.hpp"
#include "tests/bench/predicates/predicate_peers.hpp"

namespace bench {

template <class Form>
void decide_by_mpfi(const set_of<Form>& set, std::size_t count, signs& out) {
    decide_over<Form>(
        set, count, out, [](double x) { return mpfi_interval(x); },
        [](const mpfi_interval& x) { return sign_of(x); });
}
template void decide_by_mpfi<orient2d_form>(const set_of<orient2d_form>&, std::size_t, signs&);
template void decide_by_mpfi<orient3d_form>(const set_of<orient3d_form>&, std::size_t, signs&);
template void decide_by_mpfi<incircle_form>(const set_of<incircle_form>&, std::size_t, signs&);
template void decide_by_mpfi<insphere_form>(const set_of<insphere_form>&, std::size_t, signs&);

}  // namespace bench
