// Invalid arguments of steps, and the messages.
#include <gtest/gtest.h>

#include <ccd/step.hpp>
#include <limits>
#include <stdexcept>
#include <string>

#include "tests/ccd/step/expect_steps.hpp"

namespace {

using brute_force::random_soup;

template <class Call>
std::string refusal(const Call& call) {
    try {
        call();
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "nothing refused";
}
std::string refusal_of(const ccd::mesh& before, const ccd::mesh& after,
                       const ccd::step_options& options = {}) {
    return refusal([&] { ccd::step(before, after, options); });
}

TEST(StepRefuses, FramesThatDoNotBelongTogether) {
    const auto frames = random_soup(1, 10, 5);
    const ccd::mesh &before = frames.first, &after = frames.second;
    ccd::mesh other = after;
    other.faces.pop_back();
    EXPECT_EQ(refusal_of(before, other), "ccd::step: 5 faces before, 4 after");
    other = after;
    other.faces[2] = {1, 2, 4};
    EXPECT_TRUE(refusal_of(before, other).starts_with("ccd::step: face 2 is ("));
    EXPECT_TRUE(refusal_of(before, other).ends_with(" before, (1, 2, 4) after"));
    other = after;
    other.edges = {{0, 1}};
    EXPECT_EQ(refusal_of(before, other), "ccd::step: 0 edges before, 1 after");
    other = after;
    other.vertices.pop_back();
    EXPECT_EQ(refusal_of(before, other), "ccd::step: 10 vertices before, 9 after");
    EXPECT_EQ(refusal([&] {
                  ccd::mesh_steps(before).run({other, other});
              }),
              "ccd::step: positions of 9 vertices, the mesh has 10");
    EXPECT_EQ(refusal([&] {
                  ccd::mesh_steps(before).run({nullptr, nullptr, 10});
              }),
              "ccd::step: found a null pointer, expected positions");
}

TEST(StepRefuses, CoordinatesThatAreNotFinite) {
    const auto frames = random_soup(1, 10, 5);
    const ccd::mesh &before = frames.first, &after = frames.second;
    ccd::mesh other = after;
    other.vertices[3].y = -std::numeric_limits<double>::infinity();
    EXPECT_EQ(refusal_of(before, other),
              "ccd::step: the y of vertex 3 at t = 1 is not finite (-inf)");
    other = before;
    other.vertices[9].z = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(refusal_of(other, after).find("the z of vertex 9 at t = 0 is not finite"),
              std::string::npos);
    EXPECT_NE(refusal([&] { ccd::candidates(other, after); }).find("vertex 9"), std::string::npos);
}

TEST(StepRefuses, IndicesOutOfRange) {
    auto frames = random_soup(1, 10, 5);
    ccd::mesh &before = frames.first, &after = frames.second;
    before.faces[2][1] = after.faces[2][1] = 10;
    EXPECT_EQ(refusal_of(before, after), "ccd::mesh_steps: face 2 names vertex 10 of 10");
    const ccd::mesh rods{{{0, 0, 0}}, {}, {{0, 0}, {0, 1}}};
    EXPECT_EQ(refusal_of(rods, rods), "ccd::mesh_steps: edge 1 names vertex 1 of 1");
}

TEST(StepRefuses, OptionsThatAreNone) {
    const auto frames = random_soup(1, 10, 5);
    const ccd::mesh &before = frames.first, &after = frames.second;
    EXPECT_EQ(refusal_of(before, after, {.method = ccd::method(77)}),
              "ccd::step: found method 77, expected one of ccd::methods()");
    EXPECT_THROW(ccd::step({}, {}, {.set = ccd::instruction_set(7)}), std::invalid_argument);
    EXPECT_EQ(refusal_of(before, after, {.threads = -5}),
              "ccd: found -5 threads, expected 0 (one per core) or more");
    EXPECT_EQ(refusal_of(before, after, {.filter = {.rule = ccd::pair_filter::group_rule(9)}}),
              "ccd::step: found group rule 9, expected between_groups or within_groups");
    const std::vector<int> groups(9);
    EXPECT_EQ(refusal_of(before, after, {.filter = {.groups = groups}}),
              "ccd::step: the filter has groups of 9 vertices, the mesh has 10");
    const std::vector<std::uint8_t> pinned(11);
    EXPECT_EQ(refusal_of(before, after, {.filter = {.pinned = pinned}}),
              "ccd::step: the filter has pinned flags of 11 vertices, the mesh has 10");
}

TEST(StepTakes, AnEmptyMesh) {
    const auto nothing = ccd::step(ccd::mesh{}, ccd::mesh{}, {.count_candidates = true});
    EXPECT_EQ(nothing.candidates, ccd::pair_counts{});
    EXPECT_EQ(nothing.pairs, ccd::pair_lists{});
    EXPECT_EQ(ccd::candidates(ccd::mesh{}, ccd::mesh{}), ccd::pair_lists{});
}

}  // namespace
