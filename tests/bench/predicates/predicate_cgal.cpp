#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "tests/bench/predicates/predicate_peers.hpp"

namespace bench {
namespace {

using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// CGAL's signs are −1, 0 and 1.
errbound::sign_type ours(int sign) {
    return static_cast<errbound::sign_type>(sign + 1);
}
auto converted(const std::array<double, 2>& p) {
    return kernel::Point_2(p[0], p[1]);
}
auto converted(const std::array<double, 3>& p) {
    return kernel::Point_3(p[0], p[1], p[2]);
}

int decide(const orient2d_form&, const auto&... p) {
    return CGAL::orientation(p...);
}
/// The opposite sign: errbound/predicates.hpp.
int decide(const orient3d_form&, const auto&... p) {
    return -CGAL::orientation(p...);
}
int decide(const incircle_form&, const auto&... p) {
    return CGAL::side_of_oriented_circle(p...);
}
int decide(const insphere_form&, const auto&... p) {
    return -CGAL::side_of_oriented_sphere(p...);
}

}  // namespace

template <class Form>
void decide_by_cgal(const set_of<Form>& set, std::size_t count, signs& out) {
    for (std::size_t i = 0; i < count; ++i)
        out[i] =
            set.with(i, [](const auto&... p) { return ours(decide(Form(), converted(p)...)); });
}
template void decide_by_cgal<orient2d_form>(const set_of<orient2d_form>&, std::size_t, signs&);
template void decide_by_cgal<orient3d_form>(const set_of<orient3d_form>&, std::size_t, signs&);
template void decide_by_cgal<incircle_form>(const set_of<incircle_form>&, std::size_t, signs&);
template void decide_by_cgal<insphere_form>(const set_of<insphere_form>&, std::size_t, signs&);

}  // namespace bench
