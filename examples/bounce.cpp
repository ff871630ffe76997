// A vertex bounces off a face that gives way. In the plane, a bead falls on an edge; a query and a
// list of pairs give the same time.
#include <array>
#include <ccd/contact.hpp>
#include <ccd/plane.hpp>
#include <cmath>
#include <cstdio>
#include <vector>

namespace {

/// Returns the velocity change of each point by an impulse along the normal, which returns a share
/// `restitution` of the normal velocity. The first feature moves up, the second down.
std::array<double, 4> changes_of(const ccd::first_contact& contact, std::size_t first_points,
                                 const std::array<double, 4>& masses, double restitution) {
    std::array<double, 4> change{};
    double compliance = 0;
    for (std::size_t i = 0; i < 4; ++i)
        compliance += contact.weights[i] * contact.weights[i] / masses[i];
    if (!(compliance > 0)) return change;  // no contact
    const double impulse = -(1 + restitution) * contact.normal_velocity / compliance;
    for (std::size_t i = 0; i < 4; ++i)
        change[i] = (i < first_points ? impulse : -impulse) * contact.weights[i] / masses[i];
    return change;
}

}  // namespace

int main() {
    const ccd::vertex_face<double> query{.v = {{0.25, 0.25, 1}, {0.25, 0.5, -1}},
                                         .f0 = {{0, 0, 0}, {0, 0, 0}},
                                         .f1 = {{1, 0, 0}, {1, 0, 0}},
                                         .f2 = {{0, 1, 0}, {0, 1, 0}}};
    const ccd::first_contact contact = ccd::find_first_contact(query);
    const auto [x, y, z] = contact.normal;
    std::printf("at %.17g to %.17g, weights %g %g %g, normal (%g, %g, %g), velocity %g\n",
                contact.time.low, contact.time.high, contact.weights[1], contact.weights[2],
                contact.weights[3], x, y, z, contact.normal_velocity);
    const auto change = changes_of(contact, 1, {1, 2, 2, 2}, 0.5);
    std::printf("along the normal the vertex gains %g, the face's points %g %g %g\n", change[0],
                change[1], change[2], change[3]);

    const ccd::plane::vertex_edge falling{{{0, 1}, {0, -1}}, {{-1, 0}, {-1, 0}}, {{1, 0}, {1, 0}}};
    const ccd::first_time touch = time_of_impact(falling);
    const std::vector<ccd::point<double>> before{{0, 1, 0}, {5, 1, 0}, {-1, 0, 0}, {1, 0, 0}};
    const std::vector<ccd::point<double>> after{{0, -1, 0}, {5, -1, 0}, {-1, 0, 0}, {1, 0, 0}};
    const std::vector<ccd::vertex_edge_pair> pairs{{0, 2, 3}, {1, 2, 3}};
    for (const auto& [pair, time] : ccd::timed_contacts({before, after}, pairs))
        std::printf("pair %zu touches at %g, as the one query at %g\n", pair, time.low, touch.low);
    return std::abs(change[0] + 2 * (change[1] + change[2] + change[3])) < 1e-12 ? 0 : 1;
}
