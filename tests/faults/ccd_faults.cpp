// Collision detection when memory runs out.
#include <ccd/bodies/steps.hpp>
#include <ccd/curves.hpp>
#include <ccd/exact.hpp>
#include <ccd/method.hpp>
#include <ccd/reference.hpp>
#include <ccd/step.hpp>
#include <tuple>
#include <vector>

#include "tests/ccd/step/brute_force.hpp"
#include "tests/faults/failing_heap.hpp"

namespace {

using namespace ccd;
using faults::try_every_allocation;

auto content(const pair_lists& lists) {
    return std::tuple(lists.vertex_face, lists.edge_edge, lists.vertex_edge, lists.vertex_vertex);
}
auto content(const step_result& result) {
    return std::tuple(content(result.pairs), content(result.touching_at_start), result.candidates);
}
/// Sorts the pairs of each kind, since threads find candidates in any order.
auto sorted(pair_lists lists) {
    for_each_kind([&]<kind K>() { std::ranges::sort(lists.of<K>()); });
    return content(lists);
}

/// Faces, rods and points, some of them repeated; for several threads, many faces.
const brute_force::two_frames& frames_for(int threads) {
    static const auto few = brute_force::random_mixture(7),
                      many = brute_force::random_soup(7, 120, 80);
    return threads == 1 ? few : many;
}

step_options options_of(int threads) {
    static const std::vector<int> few(frames_for(1).first.vertices.size(), 3),
        many(frames_for(2).first.vertices.size(), 3);
    step_options options;
    options.threads = threads;
    options.explain = options.initial_contact = true;
    options.filter.can_collide = [](vertex_index v, vertex_index w) { return v + w != 9; };
    options.filter.groups = threads == 1 ? few : many;
    options.filter.rule = pair_filter::group_rule::within_groups;
    return options;
}

TEST(CcdFaults, Meshes) {
    const mesh& m = frames_for(1).first;
    try_every_allocation("unique_edges", [&] { return unique_edges(m.faces, m.edges); });
    try_every_allocation("unique_faces", [&] { return unique_faces(m.faces); });
}

TEST(CcdFaults, Steps) {
    for (const int threads : {1, 2}) {
        const brute_force::two_frames& frames = frames_for(threads);
        const std::string of = ", threads: " + std::to_string(threads);
        const step_options options = options_of(threads);
        for (const method m : {method::exact, method::tight}) {
            step_options by = options;
            by.method = m;
            by.explain = m == method::exact;
            try_every_allocation("step by " + std::string(info(m).name) + of,
                                 [&] { return content(step(frames.first, frames.second, by)); });
        }
        try_every_allocation("candidates" + of, [&] {
            return sorted(candidates(frames.first, frames.second, options));
        });
    }
}

TEST(CcdFaults, RepeatedSteps) {
    for (const int threads : {1, 2}) {
        const auto& [before, after] = frames_for(threads);
        const vertex_rows forwards(before.vertices, after.vertices),
            backwards(after.vertices, before.vertices);
        const std::string of = ", threads: " + std::to_string(threads);
        const step_options options = options_of(threads);
        const auto used = [&, &first = before] {
            mesh_steps steps(first);
            steps.run(forwards, options);
            return steps;
        };
        try_every_allocation("mesh_steps" + of, [&, &first = before] {
            return content(mesh_steps(first).run(forwards, options));
        });
        try_every_allocation("mesh_steps::run" + of, used, [&](mesh_steps& steps) {
            return content(steps.run(backwards, options));
        });
        try_every_allocation("mesh_steps::candidates" + of, used, [&](mesh_steps& steps) {
            return sorted(steps.candidates(backwards, options));
        });
        try_every_allocation("mesh_steps::for_each_candidate" + of, used, [&](mesh_steps& steps) {
            return steps.for_each_candidate(backwards, {}, options).edge_edge;
        });
    }
}

TEST(CcdFaults, StepsOfBodies) {
    const mesh flat{{{0, 0, 0}, {2, 0, 0}, {0, 2, 1}}, {{0, 1, 2}}},
        steep{{{0, 0, 0}, {1, 1.5, 0.25}, {0.25, 0.125, 1.75}}, {{0, 1, 2}}};
    const std::vector<body_motion> motions{
        screw({0, 0, 0.125}, {}, {0.25, 0.125, 1}),
        affine_motion{.p0 = {0.5, 0.25, 0.375}, .p1 = {0.25, 0.125, 0.75}}};
    for (const int threads : {1, 2})
        try_every_allocation(
            "body_steps::run, threads: " + std::to_string(threads),
            [&] {
                return body_steps({flat, steep});
            },
            [&](body_steps& steps) {
                const auto found = steps.run(motions, {.check_start = true, .threads = threads});
                return std::tuple(content(found.pairs), content(found.touching_at_start),
                                  found.crossing_at_start);
            });
}

/// Near-degenerate queries, which reach all stages.
std::vector<vertex_face<double>> hard_queries() {
    std::vector<vertex_face<double>> queries;
    for (int i = 0; i < 8; ++i) {
        const double e = i < 4 ? 0 : 0x1p-52, far = i % 4 == 0 ? 0x1p900 : 1,
                     near = i % 4 == 1 ? 0x1p-900 : 1;
        queries.push_back({{{near / 4, 0.25, 1 + e}, {0.25, near / 4, -1}},
                           {{0, 0, e}, {0, 0, -e}},
                           {{far, 0, 0}, {1, 0, near}},
                           {{0, 1, 0}, {0, far, 0}}});
        queries.push_back({{{0.25, 0.25, near}, {0.5, 0.25, near}},
                           {{0, 0, near}, {0, 0, near}},
                           {{1, 0, near}, {1, 0, near}},
                           {{0, 1, near + e}, {0, 1, near}}});
    }
    return queries;
}

TEST(CcdFaults, Batches) {
    const std::vector<vertex_face<double>> queries = hard_queries();
    for (const int threads : {1, 2}) {
        const auto& [before, after] = frames_for(threads);
        const vertex_rows positions(before.vertices, after.vertices);
        const pair_lists pairs = candidates(before, after);
        const batch_options options{.threads = threads, .explain = true};
        const std::string of = ", threads: " + std::to_string(threads);
        try_every_allocation("decide_batch (queries)" + of,
                             [&] { return decide_batch(queries, options).answers; });
        try_every_allocation("touches_at_start_batch (queries)" + of,
                             [&] { return touches_at_start_batch(queries, options).answers; });
        for_each_kind([&]<kind K>() {
            const auto& of_kind = pairs.of<K>();
            try_every_allocation("decide_batch (" + std::string(name(K)) + ")" + of,
                                 [&] { return decide_batch(positions, of_kind, options).answers; });
            try_every_allocation("touches_at_start_batch (" + std::string(name(K)) + ")" + of, [&] {
                return touches_at_start_batch(positions, of_kind, options).answers;
            });
        });
    }
}

TEST(CcdFaults, OneQuery) {
    const std::vector<vertex_face<double>> queries = hard_queries();
    const auto all = [&queries](const auto& decide) {
        std::vector<verdict> verdicts(queries.size());
        std::ranges::transform(queries, verdicts.begin(), decide);
        return verdicts;
    };
    for (const method_info& m : methods())
        try_every_allocation("decide by " + std::string(m.name), [&] {
            return all([&m](const auto& q) { return decide(m.method, q); });
        });
    try_every_allocation("decide_reference",
                         [&] { return all([](const auto& q) { return decide_reference(q); }); });
    try_every_allocation("touches_at_start",
                         [&] { return all([](const auto& q) { return touches_at_start(q); }); });
}

// Tests one query, since its computation allocates often.
TEST(CcdFaults, FirstTimes) {
    const vertex_face<double> q = hard_queries()[4];
    try_every_allocation("time_of_impact_reference", [&] { return time_of_impact_reference(q); });
    try_every_allocation("time_within_reference",
                         [&] { return time_within_reference(q, {0.125}); });
    const point<double> v[]{q.v.t0, q.f1.t0, q.v.t1};
    const vertex_face_curves curves{v, {&q.f0.t0, 1}, {&q.f1.t0, 1}, {&q.f2.t0, 1}};
    try_every_allocation("time_of_impact of curves", [&] { return time_of_impact(curves); });
    try_every_allocation("time_within of curves", [&] { return time_within(curves, {0.125}); });
}

}  // namespace
