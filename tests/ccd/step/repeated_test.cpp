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

/// A mesh, and steps in which parts or all of it rest. In some meshes, two small sheets that touch
/// drift over a large one and are thrown elsewhere.
class resting_sequence {
  public:
    explicit resting_sequence(std::uint64_t seed) : random_(seed) {
        if (seed % 4 == 3) {
            add_sheet(mesh_, 12, 0, 0, random_);
            first_of_sheets_ = mesh_.vertices.size();
            add_sheet(mesh_, 4, 3, 0.5, random_);
            second_small_sheet_ = mesh_.vertices.size();
            add_sheet(mesh_, 2, 3.5, 0.5, random_);
        } else {
            mesh_ = (seed % 4 == 0 ? random_mixture(seed) : random_soup(seed, 70, 50)).first;
        }
        if (one_in(2)) mesh_.vertices.resize(mesh_.vertices.size() + 3);  // not of faces
        pinned_.resize(mesh_.vertices.size());
        for (auto& p : pinned_) p = one_in(3);
        seen_.push_back(mesh_.vertices);
        before = after = mesh_.vertices;
    }

    /// Sets the next step: the last one goes on, or one starts again or elsewhere.
    void move() {
        if (!one_in(10)) before = after;
        if (one_in(8)) before = seen_[random_() % seen_.size()];
        if (one_in(16)) before[random_() % before.size()] = {-0.0, 3, 4};
        after = before;
        if (one_in(
                40))  // a shuffle, also of parts so far apart that floats do not distinguish them
            for (auto& p : after) {
                p.y += double(random_() % 30);
                p.z = one_in(2) ? 1e12 : 0;
            }
        if (first_of_sheets_ > 0) {
            if (one_in(12)) drift_ = {32 * eighths(), eighths(), eighths()};
            if (one_in(6)) move_one();
            drift();
        } else {
            const std::size_t moving = one_in(3) ? 0 : one_in(8) ? after.size() : 1 + random_() % 4;
            for (std::size_t i = 0; i < moving; ++i) move_one();
        }
        seen_.push_back(after);
    }
    /// Sets a step after the last one in which the small sheets drift.
    void drift() {
        before = after;
        if (one_in(4)) drift_ = {eighths(), eighths(), eighths()};
        for (std::size_t v = first_of_sheets_; v < after.size() && !one_in(200); ++v)
            after[v] = {after[v].x + drift_.x, after[v].y + drift_.y, after[v].z + drift_.z};
    }
    /// Sets a step in which the small sheets go far away and meet there, or come from there.
    void leave(bool backwards) {
        const auto far = [&] { return std::ldexp(eighths(), static_cast<int>(random_() % 32)); };
        drift_ = {far(), far(), far()};
        drift();
        // An axis x − y separates them here, but not far away.
        for (std::size_t v = second_small_sheet_; v < before.size(); ++v)
            (are_apart_ ? after : before)[v].x += are_apart_ ? -8 : 8;
        are_apart_ = backwards;
        if (backwards) std::swap(before, after);
        drift_ = {0, 0, 0};
    }
    ccd::step_options options() {
        const auto sets = ccd::instruction_sets();
        ccd::step_options options{.threads = 1 + static_cast<int>(random_() % 2),
                                  .set = sets[random_() % sets.size()],
                                  .count_candidates = one_in(10),
                                  .initial_contact = one_in(3),
                                  .first_contact = one_in(3),
                                  .times = one_in(3),
                                  .check_start = one_in(4),
                                  .t_max = one_in(5) ? 0.25 * double(random_() % 5) : 1,
                                  .filter = {.skip_unused = one_in(6)}};
        if (one_in(10)) options.distances.all = 0.25;
        if (one_in(10)) options.filter.pinned = pinned_;
        return options;
    }
    bool one_in(unsigned n) { return random_() % n == 0; }
    const ccd::mesh& mesh() const { return mesh_; }

    std::vector<ccd::point<double>> before, after;

  private:
    void move_one() {
        auto& p = after[random_() % after.size()];
        p = {p.x + 0.5 * double(random_() % 5) - 1, p.y, -p.z};
    }
    double eighths() { return 0.125 * (static_cast<double>(random_() % 5) - 2); }

    std::mt19937_64 random_;
    ccd::mesh mesh_;
    std::size_t first_of_sheets_ = 0, second_small_sheet_ = 0;
    bool are_apart_ = false;  ///< the small sheets
    ccd::point<double> drift_{0, 0, 0};
    std::vector<std::uint8_t> pinned_;
    std::vector<std::vector<ccd::point<double>>> seen_;
};

void expect_all_same(const ccd::step_result& found, const ccd::step_result& expected) {
    const auto same_elements = [](const ccd::intersection& a, const ccd::intersection& b) {
        return a.a == b.a && a.b == b.b && a.relation == b.relation;
    };
    brute_force::expect_same_results(found, expected);
    ASSERT_EQ(found.first_pairs, expected.first_pairs);
    ASSERT_EQ(found.candidates, expected.candidates);
    ASSERT_TRUE(std::ranges::equal(found.intersections_at_start, expected.intersections_at_start,
                                   same_elements));
}

TEST(MeshSteps, FindWhatFreshOnesFindWhereVerticesRest) {
    for (std::uint64_t seed = 0; seed < scaled(std::uint64_t(40)); ++seed) {
        resting_sequence sequence(seed);
        ccd::mesh_steps kept(sequence.mesh());
        for (int step = 0; step < 25; ++step) {
            SCOPED_TRACE(std::to_string(seed) + ", step " + std::to_string(step));
            sequence.move();
            const ccd::vertex_rows way(sequence.before, sequence.after);
            const ccd::step_options options = sequence.options();
            expect_all_same(kept.run(way, options),
                            ccd::mesh_steps(sequence.mesh()).run(way, options));
            if (sequence.one_in(20)) kept.candidates(way);
        }
    }
}

// At times, all elements are searched in a new order.
TEST(MeshSteps, FindWhatFreshOnesFindWhereASheetDriftsForLong) {
    resting_sequence sequence(3);
    ccd::mesh_steps kept(sequence.mesh());
    for (int step = 0; step < 2000; ++step) {
        sequence.drift();
        const ccd::vertex_rows way(sequence.before, sequence.after);
        ASSERT_EQ(kept.run(way, {.threads = 1}).pairs,
                  ccd::step(sequence.mesh().faces, {}, way, {.threads = 1}).pairs)
            << step;
    }
}

// Positions far outside of the box around earlier ones are rounded in a new box.
TEST(MeshSteps, FindWhatFreshOnesFindWhereSheetsLeaveTheRest) {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        resting_sequence sequence(4 * seed + 3);
        ccd::mesh_steps kept(sequence.mesh());
        for (int step = 0; step < 12; ++step) {
            step % 3 == 2 ? sequence.leave(seed % 2 == 0) : sequence.drift();
            const ccd::vertex_rows way(sequence.before, sequence.after);
            ASSERT_EQ(kept.run(way, {.threads = 1}).pairs,
                      ccd::step(sequence.mesh().faces, {}, way, {.threads = 1}).pairs)
                << seed << ", step " << step;
        }
    }
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

}  // namespace
