// First times of contact, or of a distance, of a step's pairs.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>
#include <vector>

#include "tests/ccd/step/expect_steps.hpp"
#include "tests/ccd/step/nasty_shapes.hpp"

namespace {

using brute_force::random_mixture;
using brute_force::two_frames;
using ccd::first_time;
using ccd::outcome;

/// The times of pairs by single calls, and the earliest that are not at the start.
struct timed {
    ccd::time_lists times;
    ccd::pair_lists at_start;
    first_time first{outcome::separate};

    timed(const two_frames& at, const ccd::pair_lists& pairs, double distance, double t_max = 1) {
        const ccd::vertex_rows rows(at.first, at.second);
        ccd::for_each_kind([&]<ccd::kind K>() {
            for (const auto& pair : pairs.of<K>()) {
                const first_time time = time_within(query_of(rows, pair), {distance, 0}, t_max);
                times.of<K>().push_back(time);
                if (time.at_start())
                    at_start.of<K>().push_back(pair);
                else if (first.outcome != outcome::collides ||
                         std::tuple(time.low, time.high) < std::tuple(first.low, first.high))
                    first = time;
            }
        });
    }
};

TEST(StepTimes, AreThoseOfEachPair) {
    for (const unsigned seed : {1U, 2U, 3U})
        for (const double distance : {0.0, 0x1p-1074, 0.125, 1.0}) {
            const auto at = random_mixture(seed);
            const auto plain = brute_force::step(at, brute_force::by_distance{distance});
            const timed expected(at, plain.pairs, distance);
            ccd::step_options options{.distances = {distance}};
            const auto run = [&] { return ccd::step(at.first, at.second, options); };
            EXPECT_EQ(run().first_contact, first_time());
            options.initial_contact = true;
            EXPECT_EQ(run().touching_at_start, expected.at_start);
            for (options.threads = 1; options.threads < 4; options.threads += 2) {
                options.times = false;
                options.first_contact = true;
                const auto first = run();
                EXPECT_EQ(first.times, ccd::time_lists());
                EXPECT_EQ(first.first_contact, expected.first);
                EXPECT_EQ(first.touching_at_start, expected.at_start);
                options.times = true;
                const auto found = run();
                EXPECT_EQ(found.pairs, plain.pairs);
                EXPECT_EQ(found.times, expected.times);
                EXPECT_EQ(found.first_contact, expected.first);
                EXPECT_EQ(found.touching_at_start, expected.at_start);
            }
            options.count_candidates = true;
            brute_force::expect_same(run(), plain);
        }
}

ccd::pair_lists pairs_with(const ccd::first_time& time, const ccd::pair_lists& pairs,
                           const ccd::time_lists& times) {
    ccd::pair_lists found;
    ccd::for_each_kind([&]<ccd::kind K>() {
        for (std::size_t i = 0; i < times.of<K>().size(); ++i)
            if (times.of<K>()[i] == time) found.of<K>().push_back(pairs.of<K>()[i]);
    });
    return found;
}

/// The search until t_max finds the pairs of a whole step with a time in [0, t_max], near and far
/// from the origin, at any scale. t_max may be one of these times, or next to one.
TEST(StepTimes, UntilAnyTimeAreThoseOfTheWholeStep) {
    const auto expect_all = [](const two_frames& at, const char* what) {
        const auto whole = ccd::step(at.first, at.second, {.times = true});
        std::vector<double> until{-1, 0, 0x1p-1074, 1e-9, 0.1, 0.5, std::nextafter(1.0, 0.0)};
        ccd::for_each_kind([&]<ccd::kind K>() {
            const auto& times = whole.times.of<K>();
            for (std::size_t i = 0; i < times.size(); i += 1 + times.size() / 4)
                for (const double t : {times[i].low, times[i].high})
                    until.insert(until.end(), {std::nextafter(t, 0.0), t, std::nextafter(t, 1.0)});
        });
        EXPECT_EQ(ccd::step(at.first, at.second, {.t_max = 0.5}).pairs,
                  ccd::step(at.first, at.second, {.times = true, .t_max = 0.5}).pairs);
        for (const double t_max : until)
            for (const ccd::instruction_set set : ccd::instruction_sets()) {
                if (t_max >= 1) continue;
                const auto part =
                    ccd::step(at.first, at.second, {.set = set, .times = true, .t_max = t_max});
                ccd::pair_lists pairs;
                ccd::time_lists times;
                const ccd::vertex_rows rows(at.first, at.second);
                ccd::for_each_kind([&]<ccd::kind K>() {
                    for (const auto& pair : whole.pairs.of<K>())
                        if (const auto time = time_of_impact(query_of(rows, pair), t_max);
                            time.outcome == outcome::collides) {
                            pairs.of<K>().push_back(pair);
                            times.of<K>().push_back(time);
                        }
                });
                ASSERT_EQ(part.pairs, pairs) << what << ", t_max " << t_max;
                ASSERT_EQ(part.times, times) << what << ", t_max " << t_max;
                ASSERT_EQ(part.first_pairs, pairs_with(part.first_contact, pairs, times))
                    << what << ", t_max " << t_max;
            }
    };
    for (const double size : {0x1p-1060, 1e-150, 1.0, 1e150, 0x1p1020})
        for (const double offset : {0.0, 1e3, 1e12}) {
            auto at = brute_force::random_soup(5, 24, 16);
            for (ccd::mesh* frame : {&at.first, &at.second})
                for (auto& p : frame->vertices)
                    p = {size * (p.x / 16 + offset), size * (p.y / 16), size * (p.z / 16 - offset)};
            if (std::isfinite(size * offset)) expect_all(at, "soup");
        }
    // Rounded positions until a short time are one position, so that their scale is 2^1000.
    auto from_one_point = brute_force::random_soup(6, 8, 5);
    for (auto& p : from_one_point.first.vertices) p = {1, 1, 1};
    expect_all(from_one_point, "soup from one point");
    expect_all(random_mixture(5), "mixture");
    for (const auto& shape : nasty_shapes::shapes)
        expect_all(nasty_shapes::triangles(shape, 3), shape.name);
}

TEST(StepDistances, OfThicknessesAreThoseOfTheThickestVertices) {
    const auto at = random_mixture(3);
    std::vector<double> thickness(at.first.vertices.size(), 0.25);
    const auto same = ccd::step(at.first, at.second, {.distances = {0, thickness}});
    EXPECT_EQ(same.pairs, ccd::step(at.first, at.second, {.distances = {0.5}}).pairs);
    for (std::size_t v = 0; v < thickness.size(); v += 2) thickness[v] = 0;
    const ccd::vertex_rows rows(at.first, at.second);
    const ccd::pair_distances distances{0, thickness};
    const auto found = ccd::step(at.first, at.second, {.distances = distances});
    ccd::pair_lists expected;
    ccd::for_each_kind([&]<ccd::kind K>() {
        for (const auto& pair : same.pairs.of<K>())
            if (decide_within(query_of(rows, pair), distances.of(pair)).outcome ==
                outcome::collides)
                expected.of<K>().push_back(pair);
    });
    EXPECT_EQ(found.pairs, expected);
    EXPECT_LT(found.pairs.vertex_face.size(), same.pairs.vertex_face.size());
}

/// The ends of the pairs' boxes, widened by the distance, are infinite.
TEST(StepDistances, MayOverflow) {
    constexpr double most = std::numeric_limits<double>::max();
    ccd::mesh mesh{{{-most, 0, 0}, {most, 0, 0}, {0, 0, 0}}, {}};
    const auto near = [&](double distance) {
        return ccd::step(mesh, mesh, {.distances = {distance}}).pairs.vertex_vertex.size();
    };
    EXPECT_EQ(near(most), 2U);
    EXPECT_EQ(near(std::nextafter(most, 0.0)), 0U);
}

TEST(StepDistances, AreOfExactAlone) {
    const auto at = random_mixture(1);
    for (ccd::step_options options :
         {ccd::step_options{.first_contact = true}, ccd::step_options{.times = true},
          ccd::step_options{.t_max = 0.5}, ccd::step_options{.distances = {1}}}) {
        options.method = ccd::method::tight;
        EXPECT_THROW(ccd::step(at.first, at.second, options), std::invalid_argument);
    }
}

}  // namespace
