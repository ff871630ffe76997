// Shewchuk's code (1997, Adaptive Precision Floating-Point Arithmetic), as TetGen's library has it.
#include "tests/bench/predicates/predicate_peers.hpp"

// tetgen.h declares only some of these.
void exactinit(int verbose, int no_exact, int no_filter, double x, double y, double z);
double orient2d(double*, double*, double*);
double orient3d(double*, double*, double*, double*);
double incircle(double*, double*, double*, double*);
double insphere(double*, double*, double*, double*, double*);

namespace bench {
namespace {

double decide(const orient2d_form&, auto*... p) {
    return orient2d(p...);
}
double decide(const orient3d_form&, auto*... p) {
    return orient3d(p...);
}
double decide(const incircle_form&, auto*... p) {
    return incircle(p...);
}
double decide(const insphere_form&, auto*... p) {
    return insphere(p...);
}

}  // namespace

template <class Form>
void decide_by_shewchuk(const set_of<Form>& set, std::size_t count, signs& out) {
    // Without TetGen's own filter, which needs the largest coordinates.
    static const bool initialised = (exactinit(0, 0, 1, 1, 1, 1), true);
    (void)initialised;
    for (std::size_t i = 0; i < count; ++i)
        out[i] = plain_sign(set.with(i, [](const auto&... p) {
            return decide(Form(), const_cast<double*>(p.data())...);  // only read
        }));
}
template void decide_by_shewchuk<orient2d_form>(const set_of<orient2d_form>&, std::size_t, signs&);
template void decide_by_shewchuk<orient3d_form>(const set_of<orient3d_form>&, std::size_t, signs&);
template void decide_by_shewchuk<incircle_form>(const set_of<incircle_form>&, std::size_t, signs&);
template void decide_by_shewchuk<insphere_form>(const set_of<insphere_form>&, std::size_t, signs&);

}  // namespace bench
