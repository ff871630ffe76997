// The soak of advances detects a contact on the way, a violated distance, a missing pair, and a
// step that stops early.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

#include "tests/soak/advance_scenes.hpp"
#include "tests/soak/parts.hpp"

namespace {

using soak::advance_scene;

/// The findings for the library's results after `change(scene, result)`.
template <class Change>
soak::findings found_of(const Change& change) {
    return soak::advance_part([change](const advance_scene& scene, int threads) {
               ccd::advance_result result = soak::library_advance(scene, threads);
               change(scene, result);
               return result;
           })
        .compare_block(1, 0);
}

void expect_found_out(const soak::findings& found, std::string_view fault) {
    EXPECT_TRUE(found.have(fault)) << fault;
}

std::uint64_t sum(const soak::findings& found, std::size_t column) {
    std::uint64_t all = 0;
    for (const auto& row : found.table("scenes").rows) all += row.counts.at(column);
    return all;
}

constexpr std::size_t scenes = 0, short_ones = 6;

TEST(advances, right_ones_do_not_differ) {
    const soak::part part = soak::advance_part();
    const soak::findings found = part.compare_block(2, 0);
    EXPECT_EQ(found.different, 0u) << found.differences.at(0).text;
    EXPECT_EQ(sum(found, scenes), part.count(1));
    EXPECT_LT(sum(found, short_ones), 4u);  // gaps of a last place excuse them
    for (std::size_t column = 1; column < short_ones; ++column)
        EXPECT_GT(sum(found, column), 4u) << found.table("scenes").columns[column];
    for (const std::string_view table : {"where", "distances", "groups"})
        for (const auto& row : found.table(table).rows) EXPECT_GT(row.counts.at(0), 4u) << row.name;
}

TEST(advances, all_the_way) {
    expect_found_out(found_of([](const advance_scene& scene, ccd::advance_result& result) {
                         result.positions = scene.at.second.vertices;
                         result.fraction = 1;
                         result.fractions.assign(result.positions.size(), 1);
                     }),
                     "a pair meets on the way");
}

TEST(advances, without_the_distance) {
    expect_found_out(found_of([](const advance_scene& scene, ccd::advance_result& result) {
                         advance_scene other = scene;
                         other.distance /= 2;
                         for (double& t : other.thickness) t /= 2;
                         result = soak::library_advance(other, 1);
                     }),
                     "a pair meets on the way");
}

TEST(advances, to_other_positions) {
    expect_found_out(found_of([](const advance_scene&, ccd::advance_result& result) {
                         auto& x = result.positions.at(0).x;
                         for (int i = 0; i < 1100; ++i) x = std::nextafter(x, 0x1p1023);
                     }),
                     "vertex 0 is not where its fraction leads");
}

TEST(advances, without_a_pair_at_the_start) {
    expect_found_out(found_of([](const advance_scene&, ccd::advance_result& result) {
                         auto& pairs = result.touching_at_start.edge_edge;
                         if (!pairs.empty()) pairs.pop_back();
                     }),
                     "other pairs touch at the start");
}

TEST(advances, a_contact_later_than_the_first) {
    expect_found_out(found_of([](const advance_scene&, ccd::advance_result& result) {
                         auto& time = result.first_contact;
                         if (time.outcome != ccd::outcome::collides || time.high >= 1) return;
                         time.low = time.high;
                         time.high = std::nextafter(time.high, 2);
                     }),
                     "first contact: it holds at low or before");
}

TEST(advances, of_each_vertex_and_line_searches_too_far) {
    std::size_t vertices = 0, lines = 0, scenes = 0;
    for (std::uint64_t index = 0; index < 20; ++index)
        for (const auto& family : soak::advance_families) {
            const advance_scene scene = soak::scene_of(family, 1, index);
            ccd::advance_result whole = soak::library_advance(scene, 1);
            const auto& [before, after] = scene.at;
            ccd::mesh p = after;
            for (std::size_t v = 0; v < p.vertices.size(); ++v) {
                const auto &x = before.vertices[v], &y = after.vertices[v];
                p.vertices[v] = {y.x - x.x, y.y - x.y, y.z - x.z};
            }
            if (whole.first_contact.outcome != ccd::outcome::collides) continue;
            ++scenes;
            ccd::advance_result by_groups = whole;
            whole.positions = after.vertices;
            whole.fraction = 1;
            whole.fractions.assign(whole.positions.size(), 1);
            vertices += soak::each_vertex_faults(scene, by_groups, whole).find("meets") !=
                        std::string::npos;
            lines += soak::line_search_faults(scene, whole, p).find("meets") != std::string::npos;
            whole.fractions.assign(whole.positions.size(), -1);
            EXPECT_NE(soak::each_vertex_faults(scene, by_groups, whole), "");
        }
    EXPECT_GT(scenes, 10u);
    EXPECT_GT(vertices, scenes / 2);
    EXPECT_GT(lines, scenes / 2);
}

TEST(advances, that_stay_where_they_are) {
    const soak::findings found =
        found_of([](const advance_scene& scene, ccd::advance_result& result) {
            result.positions = scene.at.first.vertices;
            result.fraction = 0;
            result.fractions.assign(result.positions.size(), 0);
        });
    expect_found_out(found, "nothing holds the vertices of an island");
    EXPECT_GT(sum(found, short_ones), 10u);
}

}  // namespace
