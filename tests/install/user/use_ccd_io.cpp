// The installed readers: prints the number of colliding pairs of two frames, or an error.
#include <ccd/io/mesh_file.hpp>
#include <ccd/io/query_file.hpp>
#include <ccd/step.hpp>
#include <cstdio>
#include <errbound/support/error.hpp>

int main(int argc, char** argv) try {
    if (argc != 3 || ccd::io::kind_from_path("vf/1.csv") != ccd::kind::vertex_face) return 1;
    const ccd::mesh before = ccd::io::read_mesh(argv[1]), after = ccd::io::read_mesh(argv[2]);
    ccd::io::require_same_topology(before, argv[1], after, argv[2]);
    const ccd::step_result found = ccd::step(before, after);
    std::printf("%zu pairs\n", found.pairs.vertex_face.size() + found.pairs.edge_edge.size());
    return found.pairs.vertex_face.empty();
} catch (const errbound::support::file_error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
