// Pairs of a mesh at rest that are too close, and repulsive forces on their vertices.
#include <ccd/nearness.hpp>
#include <cstddef>
#include <cstdio>
#include <vector>

namespace {

template <ccd::kind K>
void add_forces(const ccd::near_lists& near, double distance, std::vector<ccd::point<>>& forces) {
    constexpr std::size_t first_points = ccd::kind_traits<K>::first_vertices;
    for (std::size_t pair = 0; pair < near.pairs.of<K>().size(); ++pair) {
        const auto vertices = vertices_of(near.pairs.of<K>()[pair]);
        const ccd::nearness& data = near.data.of<K>()[pair];
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const double f =
                (i < first_points ? 1 : -1) * data.weights[i] * (distance - data.distance);
            ccd::point<>& force = forces[vertices[i]];
            force.x += f * data.normal.x;
            force.y += f * data.normal.y;
            force.z += f * data.normal.z;
        }
    }
}

}  // namespace

int main() {
    // A triangle 0.25 above another, turned.
    const ccd::mesh mesh{
        {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {2, 2, 0.25}, {2, -1, 0.25}, {-1, 2, 0.25}},
        {{0, 1, 2}, {3, 4, 5}}};
    constexpr double distance = 0.5;
    const ccd::near_lists near = ccd::near_pairs(mesh, {.all = distance});
    std::vector<ccd::point<>> forces(mesh.vertices.size());
    ccd::for_each_kind([&]<ccd::kind K>() { add_forces<K>(near, distance, forces); });

    std::printf("%zu pairs, the least distance is %g\n", number_of(near.pairs),
                ccd::least_distance(mesh).low);
    double below = 0, above = 0;
    for (std::size_t v = 0; v < 6; ++v) (v < 3 ? below : above) += forces[v].z;
    std::printf("force on the upper triangle %g, on the lower %g\n", above, below);
    return above > 0 && below < 0 ? 0 : 1;
}
