// A line search without contacts: three beads are attracted to the other side of a fence.
#include <ccd/advance.hpp>
#include <cstddef>
#include <cstdio>
#include <vector>

namespace {

using positions = std::vector<ccd::point<double>>;

// Vertices 0 to 3 are the fence, two triangles; 4 to 6 are beads, with their targets.
const std::vector<ccd::face> faces{{0, 1, 2}, {0, 2, 3}};
const positions start{{0, -1, 0},     {0, 1, 0},   {0, 1, 1},   {0, -1, 1},
                      {-1, 0.3, 0.3}, {-1, 2, .5}, {1, -.2, .6}};
const positions wanted{start[0], start[1], start[2], start[3], {2, 1, 1}, {2, 2, 0}, {-2, .5, .5}};

// One group per part of the mesh, so that none stops the others.
const std::vector<int> bodies = ccd::connected_parts(faces, {}, start.size());

double energy(const positions& x) {
    double sum = 0;
    for (std::size_t v = 0; v < x.size(); ++v) {
        const double dx = x[v].x - wanted[v].x, dy = x[v].y - wanted[v].y,
                     dz = x[v].z - wanted[v].z;
        sum += dx * dx + dy * dy + dz * dz;
    }
    return sum;
}

ccd::point<double> middle(const ccd::point<double>& p, const ccd::point<double>& q) {
    return {0.5 * (p.x + q.x), 0.5 * (p.y + q.y), 0.5 * (p.z + q.z)};
}

/// Returns positions between x and `goal`, as far as the step is free and lowers the energy.
positions line_search(ccd::mesh_steps& steps, const positions& x, positions goal) {
    for (int halvings = 0; halvings < 50; ++halvings) {
        const ccd::advance_result free = ccd::advance(steps, {x, goal}, {.groups = bodies});
        if (energy(free.positions) < energy(x)) return free.positions;
        for (std::size_t v = 0; v < x.size(); ++v) goal[v] = middle(x[v], goal[v]);
    }
    return x;
}

}  // namespace

int main() {
    ccd::mesh_steps steps(faces, {}, start.size());
    positions x = start;
    for (int iteration = 1; iteration <= 3; ++iteration) {
        const positions next = line_search(steps, x, wanted);  // Newton's step for this energy
        if (!steps.run({x, next}).pairs.vertex_face.empty()) return 1;  // impossible
        std::printf("iteration %d: energy %.6f\n", iteration, energy(x = next));
    }
    return x[5] == wanted[5] && x[4].x < 0 ? 0 : 1;
}
