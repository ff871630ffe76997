#include "tests/soak/advance_scenes.hpp"

#include <algorithm>
#include <ccd/methods/transform.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "errbound/support/hexadecimal.hpp"
#include "tests/soak/parts.hpp"
#include "tests/support/distance_families.hpp"

namespace soak {
namespace {

using brute_force::two_frames;
using ccd::vertex_index;
using query_families::kind;
using query_families::source;

/// The mesh's projection onto z = 0, with only its edges and points.
two_frames in_plane(two_frames at) {
    for (ccd::mesh* frame : {&at.first, &at.second}) {
        frame->edges = ccd::unique_edges(frame->faces, frame->edges);
        frame->faces.clear();
        for (auto& p : frame->vertices) p.z = 0;
    }
    return at;
}

/// A separation near the distance of a random pair.
ccd::separation distance_of_some_pair(source& random, const advance_scene& scene) {
    std::vector<std::pair<kind, query_families::points>> all;
    const ccd::vertex_rows rows(scene.at.first, scene.at.second);
    scene.for_each_pair([&]<class Pair>(const Pair& pair) {
        const auto points = points_of(query_of(rows, pair));
        query_families::points four;
        four.fill(points[0]);
        std::ranges::copy(points, four.begin());
        all.emplace_back(ccd::kind_of<Pair>, four);
    });
    if (all.empty()) return {0x1p-10, 0};
    const auto& [which, points] =
        all[static_cast<std::size_t>(random.between(0, static_cast<int>(all.size()) - 1))];
    return distance_families::draw(random).make(random, which, points);
}

void draw_distances(source& random, advance_scene& scene) {
    const int drawn = random.between(0, 3);
    scene.distances_name = distances_names[std::max(0, drawn - 1)];
    if (drawn < 2) return;
    const ccd::separation d = distance_of_some_pair(random, scene);
    if (drawn == 2) {
        const double sum = d.first + d.second;
        scene.distance = std::isfinite(sum) ? sum : d.first;
        return;
    }
    for (std::size_t v = 0; v < scene.at.first.vertices.size(); ++v)
        scene.thickness.push_back(random.one_in(2) ? d.first : d.second);
}

void draw_groups(source& random, advance_scene& scene) {
    const ccd::mesh& mesh = scene.at.first;
    const std::size_t vertices = mesh.vertices.size();
    const int drawn = random.between(0, 3);
    scene.groups_name = groups_names[drawn];
    if (drawn == 1) scene.groups = ccd::connected_parts(mesh.faces, mesh.edges, vertices);
    if (drawn < 2) return;
    for (std::size_t v = 0; v < vertices; ++v)
        scene.groups.push_back(drawn == 2 ? static_cast<int>(v) : random.between(-1, 2));
}

advance_scene with_the_rest_drawn(source& random, const two_frames& at) {
    advance_scene scene{.at = at, .in_plane = random.one_in(3)};
    if (scene.in_plane) scene.at = in_plane(at);
    draw_distances(random, scene);
    draw_groups(random, scene);
    return scene;
}

/// A grid of few last places far from the origin: rounding moves points by whole cells.
two_frames far_off(source& random, two_frames at) {
    const double unit = std::ldexp(1, -random.between(44, 52));
    for (ccd::mesh* frame : {&at.first, &at.second})
        for (auto& p : frame->vertices) p = {1 + unit * p.x, 1 + unit * p.y, 1 + unit * p.z};
    return at;
}

/// Points that slide along a tilted face and its edges, few last places above or below.
two_frames sliding(source& random) {
    const auto drawn = [&] {
        return ccd::point<double>{random.symmetric(), random.symmetric(), random.symmetric()};
    };
    const ccd::point<double> a = drawn(), b = drawn(), c = drawn();
    const auto on_face = [&] {
        const double s = random.unit(), t = random.one_in(3) ? 0 : (1 - s) * random.unit();
        const auto mix = [&](double x, double y, double z) {
            return (1 - s - t) * x + s * y + t * z;
        };
        return ccd::point<double>{mix(a.x, b.x, c.x), mix(a.y, b.y, c.y), mix(a.z, b.z, c.z)};
    };
    ccd::mesh before{{a, b, c}, {{0, 1, 2}}}, after = before;
    for (int i = random.between(1, 4); i > 0; --i) {
        const double above = std::ldexp(random.between(-2, 2), -random.between(44, 54));
        before.vertices.push_back(on_face());
        after.vertices.push_back(on_face());
        before.vertices.back().z += above;
        after.vertices.back().z -= above * random.between(-1, 1);
        if (i % 2 == 0) continue;  // a rod to the next one
        const auto v = static_cast<vertex_index>(before.vertices.size() - 1);
        if (i > 1) before.edges.push_back({v, v + 1});
    }
    after.edges = before.edges;
    return {before, after};
}

}  // namespace

const std::vector<advance_family> advance_families{
    {"mixture on a grid",
     [](source& random) { return brute_force::random_mixture(random.bits()); }},
    {"soup of last places",
     [](source& random) {
         return far_off(random, brute_force::random_soup(random.bits(), 16, 6));
     }},
    {"mixture of last places",
     [](source& random) { return far_off(random, brute_force::random_mixture(random.bits())); }},
    {"sliding", sliding},
};

ccd::mesh_steps advance_scene::steps() const {
    return in_plane ? ccd::mesh_steps::in_plane(at.first.edges, at.first.vertices.size())
                    : ccd::mesh_steps(at.first);
}

std::string advance_scene::text() const {
    std::string text = in_plane ? "in the plane" : "in space";
    text += "\ndistance " + errbound::support::hexadecimal(distance) + "\nthickness";
    for (const double t : thickness) text += " " + errbound::support::hexadecimal(t);
    text += "\ngroups";
    for (const int g : groups) text += " " + std::to_string(g);
    return text + "\n" + text_of(at);
}

advance_scene scene_of(const query_families::family& family, std::uint64_t seed,
                       std::uint64_t index) {
    source random = query_families::source_of(family.name, {seed, index, /*of advances*/ 16});
    return with_the_rest_drawn(random, mesh_of(family, seed, index));
}

advance_scene scene_of(const advance_family& family, std::uint64_t seed, std::uint64_t index) {
    source random = query_families::source_of(family.name, {seed, index, /*of advances*/ 16});
    return with_the_rest_drawn(random, family.make(random));
}

}  // namespace soak
