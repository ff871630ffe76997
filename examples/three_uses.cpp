// The README's three uses in one program: a predicate, a step of a mesh, a number with its error.
#include <ccd/step.hpp>
#include <cstdio>
#include <errbound/predicate.hpp>
#include <errbound/tracked.hpp>

inline constexpr auto orient2d =
    errbound::predicate<errbound::points<2, 2, 2>>([](const auto& a, const auto& b, const auto& c) {
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    });

namespace {

void a_predicate() {
    const double a[] = {0.1, 0.1}, b[] = {0.9, 0.9}, c[] = {0.5, 0.5 + 0x1p-53};
    if (orient2d(a, b, c) == errbound::sign_type::positive) std::puts("they turn left");
}

void a_simulation_step() {
    // Vertex 3 falls through the triangle of the vertices 0, 1 and 2.
    const ccd::mesh before{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25, 0.25, 1}, {2, 0, 1}, {0, 2, 1}},
                           {{0, 1, 2}, {3, 4, 5}}};
    ccd::mesh after = before;
    for (std::size_t v = 3; v < 6; ++v) after.vertices[v].z = -1;

    const ccd::step_result result = ccd::step(before, after, {.method = ccd::method::exact});
    for (const auto& [v, f0, f1, f2] : result.pairs.vertex_face)
        std::printf("vertex %u hits face %u %u %u\n", v, f0, f1, f2);
    for (const auto& [a0, a1, b0, b1] : result.pairs.edge_edge)
        std::printf("edge %u %u hits edge %u %u\n", a0, a1, b0, b1);
}

void a_number_that_knows_its_error() {
    using number = errbound::tracked<double>;  // value + certified bound, rule `tight`
    const number x = number(0.1) * 0.1 - number(0.3) * 0.7;
    std::printf("%g +- %g\n", x.value(), x.error());
    if (sign_of(x) == errbound::sign_type::uncertain) std::puts("use exact arithmetic");
}

}  // namespace

int main() {
    a_predicate();
    a_simulation_step();
    a_number_that_knows_its_error();
}
