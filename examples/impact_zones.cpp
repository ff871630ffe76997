// The impacts of a step in order of time, and the zones that must be solved together.
#include <algorithm>
#include <ccd/contact.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <cstdio>
#include <vector>

namespace {

struct impact {
    ccd::first_contact contact;
    std::vector<ccd::vertex_index> vertices;
};

std::vector<impact> impacts_of(const ccd::step_result& result, const ccd::vertex_rows& positions) {
    std::vector<impact> impacts;
    ccd::for_each_kind([&]<ccd::kind K>() {
        const auto& pairs = result.pairs.of<K>();
        const auto contacts = ccd::first_contacts(positions, pairs, result.times.of<K>());
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const auto vertices = vertices_of(pairs[i]);
            impacts.push_back({contacts[i], {vertices.begin(), vertices.end()}});
        }
    });
    std::ranges::sort(impacts, {}, [](const impact& i) { return i.contact.time.low; });
    return impacts;
}

std::vector<int> zones_of(const std::vector<impact>& impacts, std::size_t vertices) {
    std::vector<ccd::edge> joined;
    for (const impact& i : impacts)
        for (const ccd::vertex_index v : i.vertices) joined.push_back({i.vertices[0], v});
    return ccd::connected_parts({}, joined, vertices);
}

}  // namespace

int main() {
    // Two beads fall on a face, a third on another face, and a fourth misses.
    const ccd::mesh before{{{0, 0, 0},
                            {1, 0, 0},
                            {0, 1, 0},
                            {5, 0, 0},
                            {6, 0, 0},
                            {5, 1, 0},
                            {.2, .2, 1},
                            {.5, .25, 2},
                            {5.25, .25, .5},
                            {3, 0, 1}},
                           {{0, 1, 2}, {3, 4, 5}}};
    ccd::mesh after = before;
    for (std::size_t v = 6; v < 10; ++v) after.vertices[v].z -= 4;

    const ccd::vertex_rows positions(before, after);
    const ccd::step_result result = ccd::step(before, after, {.times = true});
    const std::vector<impact> impacts = impacts_of(result, positions);
    const std::vector<int> zones = zones_of(impacts, before.vertices.size());
    for (const auto& [contact, vertices] : impacts) {
        const auto& [x, y, z] = contact.normal;
        const auto& w = contact.weights;
        std::printf(
            "t = %.4f, zone %d: vertex %u at %.2f %.2f %.2f of face %u %u %u,"
            " normal %.0f %.0f %.0f, velocity %.1f\n",
            contact.time.low, zones[vertices[0]], vertices[0], w[1], w[2], w[3], vertices[1],
            vertices[2], vertices[3], x, y, z, contact.normal_velocity);
    }
    return impacts.size() == 3 && zones[6] == zones[7] && zones[6] != zones[8] ? 0 : 1;
}
