// A simulation's loop: repeated steps of one mesh with a cloth, a thread and two beads.
#include <ccd/intersections.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace {

using positions = std::vector<ccd::point<double>>;

template <ccd::kind K>
void print(const ccd::step_result& result) {
    for (const auto& pair : result.pairs.of<K>()) {
        std::printf("  %s", K == ccd::kind::vertex_face   ? "vertex/face"
                            : K == ccd::kind::edge_edge   ? "edge/edge"
                            : K == ccd::kind::vertex_edge ? "vertex/edge"
                                                          : "vertex/vertex");
        for (const ccd::vertex_index v : vertices_of(pair)) std::printf(" %u", v);
        std::printf("\n");
    }
}

/// Returns true if elements of the mesh cross, and prints them.
bool has_crossing_pairs(const ccd::mesh& mesh) {
    const ccd::intersection_result at_rest = ccd::intersections(mesh);
    bool crosses = false;
    for (const auto& [a, b, relation, segment] : at_rest.pairs) {
        if (relation != errbound::relation::crossing) continue;
        crosses = true;
        std::printf("%s of vertex %u and %u: common segment from x = %g\n",
                    ccd::short_name(ccd::kind_of_sizes(a.size, b.size)).data(), a.indices[0],
                    b.indices[0], (*segment)[0].position[0]);
    }
    return crosses;
}

}  // namespace

int main() {
    // Vertices 0 to 3: a cloth of two triangles. 4 and 5: a thread above it, a separate edge.
    // 6 and 7: beads, vertices without edges, one above the thread and one above the other.
    const std::vector<ccd::face> faces{{0, 1, 2}, {0, 2, 3}};
    const std::vector<ccd::edge> edges{{4, 5}};
    positions now{{0, 0, 0},      {4, 0, 0},      {4, 4, 0},   {0, 4, 0},
                  {1, 1.5, 0.75}, {3, 1.5, 0.75}, {2, 1.5, 2}, {2, 1.5, 3}};

    // A separate solver handles pairs within the cloth. Its corners are pinned.
    const std::vector<int> bodies{0, 0, 0, 0, 1, 1, 2, 3};
    const std::vector<std::uint8_t> pinned{1, 1, 1, 1, 0, 0, 0, 0};
    const ccd::step_options options{.initial_contact = true,
                                    .filter = {.groups = bodies, .pinned = pinned}};

    if (has_crossing_pairs({now, faces, edges})) return 1;  // no step would find them

    ccd::mesh_steps steps(faces, edges, now.size());  // keeps data that steps share
    std::size_t found = 0;
    for (int step = 1; step <= 3; ++step) {
        positions next = now;
        for (const std::size_t v : {4, 5}) next[v].z -= 0.5;  // the thread falls on the cloth
        next[6].z -= 1;                                       // a bead on the thread
        next[7].z -= 1.5;                                     // and a bead on that bead
        const ccd::step_result result = steps.run({now, next}, options);
        std::printf("step %d: %zu pairs\n", step, number_of(result.pairs));
        ccd::for_each_kind([&]<ccd::kind K>() {
            print<K>(result);
            found += result.pairs.of<K>().size();
        });
        now = next;
    }
    return found > 0 ? 0 : 1;
}
