#include "tests/soak/steps/made_meshes.hpp"

#include <cstdio>

#include "tests/ccd/step/query_meshes.hpp"

namespace soak {

using brute_force::two_frames;
using ccd::vertex_index;
using query_families::kind;

two_frames mesh_of(const query_families::family& family, std::uint64_t seed, std::uint64_t index) {
    two_frames at;
    ccd::mesh& mesh = at.first;
    query_families::source random =
        query_families::source_of(family.name, {seed, index, /*of meshes*/ 4});
    for (std::uint64_t q = 0; q < 3; ++q) {
        const auto which = static_cast<kind>(random.between(0, 3));
        brute_force::add_query(at, which, query_families::make(family, which, seed, 3 * index + q));
    }
    const auto any = [&] {
        return static_cast<vertex_index>(
            random.between(0, static_cast<int>(mesh.vertices.size()) - 1));
    };
    for (int more = random.between(0, 3); more > 0; --more)
        mesh.faces.push_back({any(), any(), any()});
    for (int more = random.between(0, 2); more > 0; --more) mesh.edges.push_back({any(), any()});
    if (random.one_in(4) && !mesh.faces.empty()) {
        const ccd::face f = mesh.faces.front();
        mesh.faces.push_back({f[2], f[1], f[0]});
    }
    at.second.faces = mesh.faces;
    at.second.edges = mesh.edges;
    return at;
}

std::string text_of(const two_frames& at) {
    std::string text;
    const auto add = [&](const char* title, const auto& elements) {
        text += title;
        for (const auto& element : elements) {
            text += " ";
            for (const vertex_index v : element) text += std::to_string(v) + ",";
        }
        text += "\n";
    };
    add("faces", at.first.faces);
    add("edges", at.first.edges);
    for (const ccd::mesh* frame : {&at.first, &at.second})
        for (const auto& p : frame->vertices) {
            char row[128];  // three numbers of at most 24 characters
            std::snprintf(row, sizeof row, "%a,%a,%a\n", p.x, p.y, p.z);
            text += row;
        }
    return text;
}

}  // namespace soak
