// Bodies that turn: one query, a body that turns by more than half a turn, and steps of many bodies
// up to poses that are certainly free.
#include <ccd/bodies/constant_turn.hpp>
#include <ccd/bodies/motion.hpp>
#include <ccd/bodies/steps.hpp>
#include <cstddef>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

namespace {

ccd::mesh box(double x, double y, double z) {
    ccd::mesh m;
    for (int i = 0; i < 8; ++i)
        m.vertices.push_back({(i & 1) != 0 ? x : -x, (i & 2) != 0 ? y : -y, (i & 4) != 0 ? z : -z});
    m.faces = {{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
               {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}};
    return m;
}

}  // namespace

int main() {
    // A quarter of a turn about z: the tip (5, 0, 0) arrives at (0, 5, 0), and at t = 1/2 at (3, 4,
    // 0).
    const ccd::body_motion quarter = ccd::shorter_arc({{1, 0, 0, 0}, {}}, {{1, 0, 0, 1}, {}});
    const ccd::body_motion still = ccd::resting{};
    const ccd::vertex_face_of<ccd::body_point> query{
        {&quarter, {5, 0, 0}}, {&still, {3, -9, -9}}, {&still, {3, 9, -9}}, {&still, {3, 0, 9}}};
    const ccd::first_time touch = ccd::time_of_impact(query);
    std::printf("the tip touches between t = %.17g and %.17g\n", touch.low, touch.high);

    const ccd::prepared_motion turns(quarter), rests(still);  // for many queries
    const ccd::vertex_face_of<ccd::body_point> prepared{turns.at({5, 0, 0}), rests.at({3, -9, -9}),
                                                        rests.at({3, 9, -9}), rests.at({3, 0, 9})};
    if (ccd::time_of_impact(prepared) != touch) return 1;

    // Two turns about z, in pieces of a quarter. The tip passes the wall again and again.
    std::vector<ccd::body_motion> motions;
    std::vector<ccd::spline_piece<ccd::vertex_face_of<ccd::body_point>>> pieces;
    const auto two_turns = ccd::turn({}, {0, 0, 1}, 4 * std::numbers::pi, {});
    motions.reserve(two_turns.size());  // queries refer to the motions
    for (const auto& [from, to, motion] : two_turns) {
        const auto* const part = &motions.emplace_back(motion);
        pieces.push_back({from, to, query});
        pieces.back().motion.v.motion = part;
    }
    const ccd::spline_time first = ccd::first_time_of_pieces(pieces);
    std::printf("in two turns: in piece %zu of %zu, at time %.6f\n", first.piece, pieces.size(),
                first.low);

    // The same tip, at a constant angular velocity of 12 radians.
    const ccd::constant_turn spin{{}, {0, 0, 1}, 12, {}, {}}, at_rest{};
    const ccd::enclosed_time constant = ccd::enclosed_time_of_impact(
        ccd::vertex_face_of<ccd::turning_point>{{&spin, {5, 0, 0}},
                                                {&at_rest, {3, -9, -9}},
                                                {&at_rest, {3, 9, -9}},
                                                {&at_rest, {3, 0, 9}}});
    std::printf("at constant velocity: %s between %.9f and %.9f\n",
                std::string(name(constant.outcome)).c_str(), constant.low, constant.high);

    // A bar turns towards a wall, above a floor.
    ccd::body_steps steps({box(4, 0.5, 0.5), box(9, 0.25, 1), box(9, 9, 0.25)});
    const std::vector<ccd::body_motion> step{
        quarter, ccd::affine_motion{.p0 = {0, 3, 0}, .p1 = {0, 2.5, 0}},
        ccd::affine_motion{.p0 = {0, 0, -2}, .p1 = {0, 0, -2}}};
    const ccd::body_step_result found = steps.run(step);
    const ccd::body_advance free = steps.advance(step, {.step = {.check_start = true}});
    std::printf("%zu pairs, the first at t = %.6f; free up to %.6f of the way, with %zu pairs\n",
                number_of(found.pairs), found.first_contact.low, free.fraction,
                number_of(steps.run(free.motions).pairs));
}
