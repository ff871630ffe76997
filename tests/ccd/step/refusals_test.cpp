// Invalid arguments of steps, and the messages.
#include <gtest/gtest.h>

#include <ccd/advance.hpp>
#include <ccd/step.hpp>
#include <limits>
#include <stdexcept>
#include <string>

#include "tests/ccd/step/expect_steps.hpp"
#include "tests/support/files.hpp"

namespace {

using brute_force::random_soup;

const auto frames = random_soup(1, 10, 5);
const ccd::mesh &before = frames.first, &after = frames.second;

constexpr auto& refusal = test_files::message_of<std::invalid_argument>;

std::string refusal_of(const ccd::mesh& before, const ccd::mesh& after,
                       const ccd::step_options& options = {}) {
    return refusal([&] { ccd::step(before, after, options); });
}

TEST(StepRefuses, FramesThatDoNotBelongTogether) {
    ccd::mesh other = after;
    other.faces.pop_back();
    EXPECT_EQ(refusal_of(before, other),
              "ccd::step: number of faces after is 4; expected 5 as before");
    other = after;
    other.faces[2] = {1, 2, 4};
    EXPECT_TRUE(
        refusal_of(before, other).starts_with("ccd::step: face 2 after is (1, 2, 4); expected ("));
    EXPECT_TRUE(refusal_of(before, other).ends_with(") as before"));
    other = after;
    other.edges = {{0, 1}};
    EXPECT_EQ(refusal_of(before, other),
              "ccd::step: number of edges after is 1; expected 0 as before");
    other = after;
    other.vertices.pop_back();
    EXPECT_EQ(refusal_of(before, other),
              "ccd::step: number of vertices after is 9; expected 10 as before");
    EXPECT_EQ(refusal([&] {
                  ccd::mesh_steps(before).run({other, other});
              }),
              "ccd::step: number of positions is 9; expected 10, one for each vertex");
    EXPECT_EQ(refusal([&] {
                  ccd::mesh_steps(before).run({nullptr, nullptr, 10});
              }),
              "ccd::step: pointer to positions is null; expected positions");
}

TEST(StepRefuses, CoordinatesThatAreNotFinite) {
    ccd::mesh other = after;
    other.vertices[3].y = -std::numeric_limits<double>::infinity();
    EXPECT_EQ(refusal_of(before, other),
              "ccd::step: y of vertex 3 at t = 1 is -inf; expected a finite number");
    other = before;
    other.vertices[9].z = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(refusal_of(other, after).find("z of vertex 9 at t = 0 is"), std::string::npos);
    EXPECT_NE(refusal([&] { ccd::candidates(other, after); }).find("vertex 9"), std::string::npos);
}

TEST(AdvanceRefuses, InItsOwnName) {
    ccd::mesh other = after;
    other.vertices[3].y = std::numeric_limits<double>::infinity();
    const std::string rest = ": y of vertex 3 at t = 1 is inf; expected a finite number";
    EXPECT_EQ(refusal([&] { ccd::advance(before, other); }), "ccd::advance" + rest);
    EXPECT_EQ(refusal([&] { ccd::advance(before, after, {.keep = -1e-9}); }),
              "ccd::advance: keep is -1e-09; expected a number in [0, 1)");
    ccd::mesh_steps steps(before);
    EXPECT_EQ(refusal([&] {
                  ccd::free_step(steps, {before, after}, {.conservative = 0});
              }),
              "ccd::free_step: conservative is 0; expected a number in (0, 1]");
    EXPECT_EQ(refusal([&] {
                  ccd::free_step(steps, {nullptr, nullptr, 9});
              }),
              "ccd::free_step: number of positions is 9; expected 10, one for each vertex");
}

TEST(StepRefuses, IndicesOutOfRange) {
    ccd::mesh wrong = before;
    wrong.faces[2][1] = 10;
    EXPECT_EQ(refusal_of(wrong, wrong),
              "ccd::mesh_steps: vertex index of face 2 is 10; expected less than 10");
    const ccd::mesh rods{{{0, 0, 0}}, {}, {{0, 0}, {0, 1}}};
    EXPECT_EQ(refusal_of(rods, rods),
              "ccd::mesh_steps: vertex index of edge 1 is 1; expected less than 1");
}

TEST(StepRefuses, OptionsThatAreNone) {
    EXPECT_EQ(refusal_of(before, after, {.method = ccd::method(77)}),
              "ccd::step: method is 77; expected one of ccd::methods()");
    EXPECT_THROW(ccd::step({}, {}, {.set = ccd::instruction_set(7)}), std::invalid_argument);
    EXPECT_EQ(refusal_of(before, after, {.threads = -5}),
              "ccd: number of threads is -5; expected 0 (one per core) or more");
    EXPECT_EQ(refusal_of(before, after, {.filter = {.rule = ccd::pair_filter::group_rule(9)}}),
              "ccd::step: group rule is 9; expected between_groups or within_groups");
    const std::vector<int> groups(9);
    EXPECT_EQ(refusal_of(before, after, {.filter = {.groups = groups}}),
              "ccd::step: number of groups is 9; expected 10, one for each vertex");
    const std::vector<std::uint8_t> pinned(11);
    EXPECT_EQ(refusal_of(before, after, {.filter = {.pinned = pinned}}),
              "ccd::step: number of pinned flags is 11; expected 10, one for each vertex");
}

TEST(StepTakes, AnEmptyMesh) {
    const auto nothing = ccd::step(ccd::mesh{}, ccd::mesh{}, {.count_candidates = true});
    EXPECT_EQ(nothing.candidates, ccd::pair_counts{});
    EXPECT_EQ(nothing.pairs, ccd::pair_lists{});
    EXPECT_EQ(ccd::candidates(ccd::mesh{}, ccd::mesh{}), ccd::pair_lists{});
}

}  // namespace
