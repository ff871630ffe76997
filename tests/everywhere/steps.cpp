// Steps, advances and intersections of meshes: waving sheets over each other, soups of every shape.
#include <ccd/advance.hpp>
#include <ccd/intersections.hpp>
#include <ccd/mesh.hpp>
#include <ccd/step.hpp>
#include <string>

#include "tests/everywhere/sections.hpp"

namespace everywhere {
namespace {

using ccd::vertex_index;
using ccd::lab::source;

struct two_frames {
    ccd::mesh before, after;
};

void add_vertex(two_frames& to, const ccd::point<double>& t0, const ccd::point<double>& t1) {
    to.before.vertices.push_back(t0);
    to.after.vertices.push_back(t1);
}
void add_face(two_frames& to, const ccd::face& f) {
    to.before.faces.push_back(f);
    to.after.faces.push_back(f);
}

void add_sheet(two_frames& to, source& random, vertex_index n, double height, double fall) {
    const auto first = static_cast<vertex_index>(to.before.vertices.size());
    for (vertex_index i = 0; i < n; ++i)
        for (vertex_index j = 0; j < n; ++j) {
            const double x = i + random.between(-8, 8) / 64.0, y = j + random.between(-8, 8) / 64.0;
            const double z = height + random.between(-16, 16) / 64.0;
            add_vertex(to, {x, y, z}, {x + 0.25 * random.symmetric(), y, z - fall});
        }
    for (vertex_index i = 0; i + 1 < n; ++i)
        for (vertex_index j = 0; j + 1 < n; ++j) {
            const vertex_index v = first + i * n + j;
            add_face(to, {v, v + 1, v + n});
            add_face(to, {v + 1, v + n + 1, v + n});
        }
}

two_frames sheets() {
    source random(11);
    two_frames frames;
    add_sheet(frames, random, 24, 0, 0);
    add_sheet(frames, random, 24, 1, 1.25);
    add_sheet(frames, random, 24, 2.5, 1.75);
    return frames;
}

two_frames soup(const query_families::family& f, std::uint64_t count) {
    two_frames frames;
    for (std::uint64_t i = 0; i < count; ++i) {
        const auto which = i % 2 == 0 ? ccd::kind::vertex_face : ccd::kind::edge_edge;
        const auto v = static_cast<vertex_index>(frames.before.vertices.size());
        for (const auto& p : query_families::make(f, which, 7, i)) add_vertex(frames, p.t0, p.t1);
        if (i % 2 == 0) {
            add_face(frames, {v + 1, v + 2, v + 3});
            continue;
        }
        for (const ccd::edge& e : {ccd::edge{v, v + 1}, ccd::edge{v + 2, v + 3}}) {
            frames.before.edges.push_back(e);
            frames.after.edges.push_back(e);
        }
    }
    return frames;
}

void add_pairs(recorder& to, const ccd::pair_lists& pairs) {
    ccd::for_each_kind([&]<ccd::kind K>() {
        to.add(pairs.of<K>().size());
        for (const auto& pair : pairs.of<K>())
            for (const vertex_index v : ccd::vertices_of(pair)) to.add(v);
    });
}

void record_step(recorder& to, const two_frames& frames, ccd::instruction_set set) {
    ccd::step_options options;
    options.threads = 2;
    options.set = set;
    options.times = true;
    options.count_candidates = true;
    const ccd::step_result contacts = ccd::step(frames.before, frames.after, options);
    ccd::for_each_kind([&]<ccd::kind K>() {
        to.add(contacts.candidates->of<K>());
        to.add(contacts.times.of<K>());
    });
    add_pairs(to, contacts.pairs);
    add_pairs(to, contacts.touching_at_start);
    to.add(contacts.first_contact);
}

void record_step_within(recorder& to, const two_frames& frames, ccd::instruction_set set) {
    ccd::step_options options;
    options.threads = 2;
    options.set = set;
    options.distances.all = 0x1p-6;
    add_pairs(to, ccd::step(frames.before, frames.after, options).pairs);
}

void record_advance(recorder& to, const two_frames& frames, ccd::instruction_set set) {
    ccd::advance_options options;
    options.threads = 2;
    options.set = set;
    const ccd::advance_result result = ccd::advance(frames.before, frames.after, options);
    to.add(result.positions);
    to.add(result.fraction);
    to.add(result.first_contact);
}

void record_intersections(recorder& to, const ccd::mesh& mesh, ccd::instruction_set set) {
    const auto found = ccd::intersections(mesh, {.segments = false, .threads = 2, .set = set});
    to.add(found.pairs.size());
    for (const ccd::intersection& pair : found.pairs) {
        for (const auto& element : {pair.a, pair.b})
            for (const vertex_index v : element.indices) to.add(v);
        to.add(static_cast<std::size_t>(pair.relation));
    }
}

}  // namespace

void record_steps(recorder& to, ccd::instruction_set set) {
    const two_frames large = sheets();
    record_step(to, large, set);
    record_step_within(to, large, set);
    record_advance(to, large, set);
    record_intersections(to, large.after, set);
    to.end_item("sheets");
    for (const auto& f : query_families::families) {
        if (f.thinning > 1) continue;
        const two_frames frames = soup(f, 8);
        record_step(to, frames, set);
        record_advance(to, frames, set);
        record_intersections(to, frames.before, set);
        to.end_item(std::string(f.name));
    }
}

}  // namespace everywhere
