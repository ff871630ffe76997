// For simulation authors: one query, and one whole step of a mesh.
#include <ccd/exact.hpp>
#include <ccd/method.hpp>
#include <ccd/step.hpp>
#include <cstdio>

int main() {
    // A vertex falls from z = 1 to z = -1 through a resting triangle; it hits edge f0 f1 exactly.
    const ccd::vertex_face<double> query{.v = {{0.5, 0, 1}, {0.5, 0, -1}},
                                         .f0 = {{0, 0, 0}, {0, 0, 0}},
                                         .f1 = {{1, 0, 0}, {1, 0, 0}},
                                         .f2 = {{0, 1, 0}, {0, 1, 0}}};
    for (const ccd::method_info& m : ccd::methods()) {
        const ccd::verdict v = ccd::decide(m.method, query);
        std::printf("%s: %s\n", m.name.data(), ccd::name(v.outcome).data());
    }
    std::printf("touching already at t = 0: %s\n",
                ccd::may_collide(ccd::touches_at_start(query)) ? "yes" : "no");

    // Two triangles as one mesh; the second falls through the first.
    ccd::mesh before{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, 1}, {0.4, 0.2, 1}, {0.2, 0.4, 1}},
                     {{0, 1, 2}, {3, 4, 5}}};
    ccd::mesh after = before;
    for (std::size_t i = 3; i < 6; ++i) after.vertices[i].z = -1;
    const ccd::step_result result = ccd::step(before, after, {.method = ccd::method::exact});
    for (const auto& [v, f0, f1, f2] : result.pairs.vertex_face)
        std::printf("vertex %u hits face %u %u %u\n", v, f0, f1, f2);
    for (const auto& [a0, a1, b0, b1] : result.pairs.edge_edge)
        std::printf("edge %u %u hits edge %u %u\n", a0, a1, b0, b1);
}
