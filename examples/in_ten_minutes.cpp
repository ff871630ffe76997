// From arrays of a simulation to a step without collisions, and to its contacts.
#include <ccd/advance.hpp>
#include <ccd/contact.hpp>
#include <cstddef>
#include <cstdio>
#include <vector>

namespace {

// Arrays of a simulation: x y z of each vertex, three vertices of each face.
using numbers = std::vector<double>;

std::vector<ccd::face> faces_of(const std::vector<int>& triangles) {
    std::vector<ccd::face> faces;
    for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
        const auto vertex = [&](std::size_t k) {
            return static_cast<ccd::vertex_index>(triangles[i + k]);
        };
        faces.push_back({vertex(0), vertex(1), vertex(2)});
    }
    return faces;
}

}  // namespace

int main() {
    // A table of two triangles, and a small triangle that falls on it.
    const std::vector<int> triangles{0, 1, 2, 0, 2, 3, 4, 5, 6};
    const numbers x{0, 0, 0, 4, 0, 0, 4, 4, 0, 0, 4, 0, 2, 1, 1, 3, 1, 2, 1, 3, 2};
    numbers wanted = x;
    for (std::size_t i = 14; i < wanted.size(); i += 3) wanted[i] -= 4;

    ccd::mesh_steps steps(faces_of(triangles), {}, x.size() / 3);
    const ccd::vertex_rows step{x.data(), wanted.data(), x.size() / 3};

    // Contacts: pairs, first times and normals.
    const ccd::step_result found = steps.run(step, {.times = true});
    const auto& pairs = found.pairs.vertex_face;
    const auto contacts = ccd::first_contacts(step, pairs, found.times.vertex_face);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const auto& [v, f0, f1, f2] = pairs[i];
        const auto& c = contacts[i];
        std::printf("vertex %u meets face %u %u %u at t = %.3f, normal %g %g %g\n", v, f0, f1, f2,
                    c.time.low, c.normal.x, c.normal.y, c.normal.z);
    }

    // The free step: the step from x to these positions certainly has no contact.
    const ccd::advance_result free = ccd::advance(steps, step, {});
    std::printf("free for %.3f of the step\n", free.fraction);
    return pairs.size() == 3 && free.fraction > 0.24 ? 0 : 1;
}
