// Repeated steps of one mesh, filters, candidates, initial contact.
#include <gtest/gtest.h>

#include <atomic>

#include "tests/ccd/step/expect_steps.hpp"
#include "tests/support/scaled.hpp"

namespace {

using brute_force::expect_both_ways;
using brute_force::random_mixture;
using brute_force::random_soup;
using brute_force::two_frames;
using brute_force::vertex_index;
using support::scaled;

TEST(MeshSteps, FindWhatFreshOnesFindWhateverWentBefore) {
    const auto [mesh, second] = random_mixture(1);
    std::mt19937_64 random(1);
    ccd::mesh_steps counting(mesh), leaving_out(mesh), both(mesh);
    auto before = mesh.vertices, after = second.vertices;
    for (unsigned step = 0; step < 40; ++step) {
        const ccd::vertex_rows rows(before, after);
        const ccd::step_options threaded{.threads = 1 + static_cast<int>(step % 2)};
        const auto expected = ccd::step(mesh.faces, mesh.edges, rows, {.count_candidates = true});
        expect_both_ways(expected, threaded, [&](const auto& options) {
            return (options.count_candidates ? counting : leaving_out).run(rows, options);
        });
        expect_both_ways(expected, threaded,
                         [&](const auto& options) { return both.run(rows, options); });
        before = after;
        // Small motions, then a shuffle; parts so far apart that floats do not distinguish them.
        for (auto& p : after) {
            p.x += 0.25 * static_cast<double>(random() % 5) - 0.5;
            p.y += step % 10 == 4 ? static_cast<double>(random() % 30) : 0;
            if (step == 20 || step == 25) p.z = static_cast<double>(random() % 2) * 1e12;
        }
    }
}

/// Adds a square sheet of n by n cells, at heights of a few quarters.
void add_sheet(ccd::mesh& mesh, vertex_index n, double from, double height,
               std::mt19937_64& random) {
    const auto first = static_cast<vertex_index>(mesh.vertices.size());
    for (vertex_index i = 0; i <= n; ++i)
        for (vertex_index j = 0; j <= n; ++j)
            mesh.vertices.push_back(
                {from + i, from + j, height + 0.25 * static_cast<double>(random() % 3)});
    for (vertex_index i = 0; i < n; ++i)
        for (vertex_index j = 0; j < n; ++j) {
            const vertex_index a = first + i * (n + 1) + j, b = a + n + 1;
            mesh.faces.insert(mesh.faces.end(), {{a, b, b + 1}, {a, b + 1, a + 1}});
        }
}

/// Repeated steps of one mesh find the same as steps of a new one. Parts or all of it rest, steps
/// start again or elsewhere, and options vary. In some meshes, a small sheet drifts over a large
/// one and is thrown elsewhere.
void expect_as_new(std::uint64_t seed, int steps) {
    std::mt19937_64 random(seed);
    ccd::mesh mesh = seed % 4 == 0 ? random_mixture(seed).first : random_soup(seed, 70, 50).first;
    const bool has_sheets = seed % 4 == 3;
    std::size_t first_of_sheet = 0;
    ccd::point<double> drift{0, 0, 0};
    if (has_sheets) {
        mesh = {};
        add_sheet(mesh, 12, 0, 0, random);
        first_of_sheet = mesh.vertices.size();
        add_sheet(mesh, 4, 3, 0.5, random);
    }
    const auto one_in = [&](unsigned n) { return random() % n == 0; };
    if (one_in(2)) mesh.vertices.resize(mesh.vertices.size() + 3);  // not of faces
    std::vector<std::uint8_t> pinned(mesh.vertices.size());
    for (auto& p : pinned) p = one_in(3);
    const auto sets = ccd::instruction_sets();
    ccd::mesh_steps kept(mesh);
    const auto same_elements = [](const ccd::intersection& a, const ccd::intersection& b) {
        return a.a == b.a && a.b == b.b && a.relation == b.relation;
    };
    std::vector<std::vector<ccd::point<double>>> seen{mesh.vertices};
    auto before = mesh.vertices;
    for (int step = 0; step < steps; ++step) {
        if (one_in(8)) before = seen[random() % seen.size()];  // a restart
        if (one_in(16)) before[random() % before.size()] = {-0.0, 3, 4};
        auto after = before;
        const auto move = [&](auto& p) { p = {p.x + 0.5 * double(random() % 5) - 1, p.y, -p.z}; };
        const std::size_t moving = one_in(3) ? 0 : one_in(8) ? after.size() : 1 + random() % 4;
        for (std::size_t i = 0; i < moving; ++i) move(after[random() % after.size()]);
        if (has_sheets) {
            after = before;
            const auto eighths = [&] { return 0.125 * (static_cast<double>(random() % 5) - 2); };
            if (one_in(4)) drift = {eighths(), eighths(), eighths()};
            if (one_in(12)) drift = {32 * eighths(), eighths(), eighths()};
            if (one_in(6)) move(after[random() % after.size()]);
            for (std::size_t v = first_of_sheet; v < after.size() && !one_in(200); ++v)
                after[v] = {after[v].x + drift.x, after[v].y + drift.y, after[v].z + drift.z};
        }
        ccd::step_options options{.threads = 1 + static_cast<int>(random() % 2),
                                  .set = sets[random() % sets.size()],
                                  .count_candidates = one_in(10),
                                  .initial_contact = one_in(3),
                                  .first_contact = one_in(3),
                                  .times = one_in(3),
                                  .check_start = one_in(4),
                                  .t_max = one_in(5) ? 0.25 * double(random() % 5) : 1,
                                  .filter = {.skip_unused = one_in(6)}};
        if (one_in(10)) options.distances.all = 0.25;
        if (one_in(10)) options.filter.pinned = pinned;
        const ccd::vertex_rows way(before, after);
        const ccd::step_result found = kept.run(way, options);
        const ccd::step_result expected = ccd::mesh_steps(mesh).run(way, options);
        ASSERT_EQ(found.pairs, expected.pairs) << seed << ", step " << step;
        ASSERT_EQ(found.times, expected.times) << seed << ", step " << step;
        ASSERT_EQ(found.first_contact, expected.first_contact) << seed << ", step " << step;
        ASSERT_EQ(found.first_pairs, expected.first_pairs) << seed << ", step " << step;
        ASSERT_EQ(found.touching_at_start, expected.touching_at_start) << seed << ", step " << step;
        ASSERT_EQ(found.candidates, expected.candidates) << seed << ", step " << step;
        ASSERT_TRUE(std::ranges::equal(found.intersections_at_start,
                                       expected.intersections_at_start, same_elements))
            << seed << ", step " << step;
        if (one_in(20)) kept.candidates(way);
        if (!one_in(10)) before = after;
        seen.push_back(after);
    }
}

TEST(MeshSteps, FindWhatFreshOnesFindWhereVerticesRest) {
    // Long sequences are also searched as a whole at times.
    for (std::uint64_t seed = 0; seed < scaled(std::uint64_t(40)); ++seed)
        expect_as_new(seed, seed % 40 == 3 ? 700 : 25);
}

// A filter of pairs skips unused vertices: points of faces and edges that repeat a vertex stay.
TEST(MeshSteps, SkipUnusedVertices) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        auto [mesh, second] = random_mixture(seed);
        const auto first_new = static_cast<vertex_index>(mesh.vertices.size());
        for (auto* frame : {&mesh.vertices, &second.vertices})
            for (std::size_t i = 0; i < 6; ++i) frame->push_back((*frame)[i]);
        mesh.faces.push_back({first_new, first_new, first_new});
        mesh.edges.push_back({first_new + 1, first_new + 1});
        const auto unused = ccd::unused_vertices(mesh.faces, mesh.edges, mesh.vertices.size());
        ASSERT_GE(unused.size(), 4U);
        ASSERT_EQ(std::ranges::count(unused, first_new), 0);
        const ccd::vertex_rows rows(mesh.vertices, second.vertices);
        ccd::mesh_steps steps(mesh);
        ccd::pair_lists expected = steps.run(rows).pairs;
        ccd::for_each_kind([&]<ccd::kind K>() {
            std::erase_if(expected.of<K>(), [&](const auto& pair) {
                return std::ranges::any_of(vertices_of(pair), [&](vertex_index v) {
                    return std::ranges::binary_search(unused, v);
                });
            });
        });
        for (const bool count : {false, true}) {  // close pairs, and all candidates
            ccd::step_options options{.count_candidates = count, .filter = {.skip_unused = true}};
            const ccd::pair_lists skipped = steps.run(rows, options).pairs;
            options.filter.skip_unused = false;
            const ccd::pair_lists all = steps.run(rows, options).pairs;
            EXPECT_GE(number_of(all), number_of(skipped));
            ccd::for_each_kind(
                [&]<ccd::kind K>() { EXPECT_EQ(skipped.of<K>(), expected.of<K>()) << seed; });
        }
    }
}

TEST(MeshSteps, MayBeMoved) {
    const auto at = random_mixture(2);
    ccd::mesh_steps steps(at.first);
    ccd::mesh_steps moved = std::move(steps);
    expect_both_ways(ccd::step(at.first, at.second, {.count_candidates = true}), {},
                     [&](const auto& options) {
                         return moved.run({at.first, at.second}, options);
                     });
}

TEST(Filter, LetsThroughPairsOfWhichSomeVerticesMayCollide) {
    const auto at = random_mixture(3);
    const std::size_t vertices = at.first.vertices.size();
    std::vector<int> groups(vertices);
    std::vector<std::uint8_t> pinned(vertices);
    for (std::size_t v = 0; v < vertices; ++v) {
        groups[v] = static_cast<int>(v / 9);
        pinned[v] = v % 3 != 0;
    }
    const auto by_sum = [](vertex_index v, vertex_index w) { return (v + w) % 5 == 0; };
    const auto one_group = [&](vertex_index v, vertex_index w) { return groups[v] == groups[w]; };
    const auto one_moves = [&](vertex_index v, vertex_index w) {
        return pinned[v] == 0 || pinned[w] == 0;
    };
    const auto unfiltered = ccd::candidates(at.first, at.second);
    const auto expect = [&](const ccd::pair_filter& filter, const auto& may) {
        const auto expected = brute_force::step(at, brute_force::by_method(), may);
        expect_both_ways(expected, {.filter = filter}, [&](const auto& options) {
            return ccd::step(at.first, at.second, options);
        });
        EXPECT_LT(expected.candidates->edge_edge, unfiltered.edge_edge.size());
        EXPECT_GT(expected.candidates->edge_edge, 0U);
    };
    expect({.can_collide = by_sum}, by_sum);
    expect({.groups = groups}, [&](vertex_index v, vertex_index w) { return !one_group(v, w); });
    expect({.groups = groups, .rule = ccd::pair_filter::group_rule::within_groups}, one_group);
    expect({.pinned = pinned}, one_moves);
    expect({.can_collide = by_sum, .groups = groups, .pinned = pinned},
           [&](vertex_index v, vertex_index w) {
               return by_sum(v, w) && !one_group(v, w) && one_moves(v, w);
           });
}

TEST(Candidates, AreThoseOfTheStep) {
    const auto at = random_mixture(4);
    const auto expected = brute_force::step(at);
    const auto listed = ccd::candidates(at.first, at.second);
    std::atomic<std::size_t> in_blocks = 0;
    ccd::mesh_steps steps(at.first);
    const auto counts = steps.for_each_candidate(
        {at.first, at.second}, {.edge_edge = [&](auto block) { in_blocks += block.size(); }});
    ccd::for_each_kind([&]<ccd::kind K>() {
        EXPECT_EQ(listed.of<K>().size(), expected.candidates->of<K>()) << name(K);
        EXPECT_TRUE(std::ranges::is_sorted(listed.of<K>()));
        // Faces of vertex/face candidates have vertices in the mesh's order, not ascending.
        if constexpr (K != ccd::kind::vertex_face) {
            EXPECT_TRUE(std::ranges::includes(listed.of<K>(), expected.pairs.of<K>())) << name(K);
        }
    });
    EXPECT_EQ(in_blocks, expected.candidates->edge_edge);
    EXPECT_EQ(counts.edge_edge, expected.candidates->edge_edge);
    EXPECT_EQ(counts.vertex_face, 0U);  // without a visitor
    const auto none = steps.candidates(
        {at.first, at.second},
        {.filter = {.can_collide = [](vertex_index, vertex_index) { return false; }}});
    EXPECT_EQ(none, ccd::pair_lists{});
}

TEST(InitialContact, IsToldFromALaterImpact) {
    std::size_t touching = 0, later = 0;
    for (const unsigned seed : {5U, 6U, 7U}) {
        const auto at = random_mixture(seed);
        const auto expected = brute_force::step(at);
        const auto found = ccd::step(at.first, at.second, {.initial_contact = true});
        EXPECT_EQ(found.touching_at_start, expected.touching_at_start);
        EXPECT_EQ(ccd::step(at.first, at.second).touching_at_start, ccd::pair_lists{});
        ccd::for_each_kind([&]<ccd::kind K>() {
            touching += found.touching_at_start.of<K>().size();
            later += found.pairs.of<K>().size() - found.touching_at_start.of<K>().size();
        });
    }
    EXPECT_GT(touching, 0U);
    EXPECT_GT(later, 0U);
}

}  // namespace
