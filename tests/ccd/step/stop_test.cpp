// Calls that are cancelled throw ccd::stopped and can be repeated.
#include <gtest/gtest.h>

#include <atomic>
#include <ccd/advance.hpp>
#include <ccd/contact.hpp>
#include <ccd/io/mesh_file.hpp>
#include <ccd/step.hpp>
#include <string>
#include <vector>

namespace {

using ccd::stop_query;

const std::string scene = std::string(ERRBOUND_SCENES) + "/cloth-over-ball/frame";

class Stop : public testing::TestWithParam<int> {
  protected:
    /// Cancels a call at its n-th poll; counts all polls.
    stop_query at(int n) {
        calls_ = 0;
        return [this, n] { return ++calls_ >= n; };
    }
    template <class Call>
    void expect_stops(const Call& call) {
        EXPECT_NO_THROW(call(at(1 << 30)));
        const int all = calls_;
        EXPECT_GT(all, 0);
        for (const int n : {1, (all + 1) / 2}) EXPECT_THROW(call(at(n)), ccd::stopped) << n;
        EXPECT_NO_THROW(call(stop_query()));
    }

    const ccd::mesh before_ = ccd::io::read_mesh(scene + "0.ply");
    const ccd::mesh after_ = ccd::io::read_mesh(scene + "1.ply");
    const ccd::vertex_rows rows_{before_, after_};
    std::atomic<int> calls_ = 0;
};

TEST_P(Stop, EndsBatches) {
    const auto pairs = ccd::candidates(before_, after_).vertex_face;
    std::vector<ccd::vertex_face<double>> queries;
    for (const auto& pair : pairs) queries.push_back(query_of(rows_, pair));
    expect_stops([&](const stop_query& stop) {
        ccd::decide_batch(rows_, pairs, {.threads = GetParam(), .stop = stop});
    });
    expect_stops([&](const stop_query& stop) {
        ccd::touches_at_start_batch(queries, {.threads = GetParam(), .stop = stop});
    });
    for (const double distance : {0.0, 1e-3}) {
        const auto options = [&](const stop_query& stop) {
            return ccd::time_options{
                .distances = {.all = distance}, .threads = GetParam(), .stop = stop};
        };
        expect_stops([&](const stop_query& stop) {
            ccd::timed_contacts(rows_, pairs, options(stop));
            ccd::earliest(queries, options(stop));
        });
    }
}

TEST_P(Stop, EndsStepsAndLeavesThemUsable) {
    ccd::mesh_steps steps(before_);
    const auto expected = ccd::step(before_, after_).pairs;
    for (const bool counted : {false, true})
        expect_stops([&](const stop_query& stop) {
            const ccd::step_options options{
                .threads = GetParam(), .count_candidates = counted, .times = true, .stop = stop};
            EXPECT_EQ(steps.run(rows_, options).pairs, expected);
        });
    expect_stops([&](const stop_query& stop) {
        steps.candidates(rows_, {.threads = GetParam(), .stop = stop});
    });
    expect_stops([&](const stop_query& stop) {
        ccd::advance(steps, rows_, {.threads = GetParam(), .stop = stop});
    });
}

TEST_P(Stop, PassesOnWhatTheQueryThrows) {
    const stop_query stop = []() -> bool { throw std::string("enough"); };
    EXPECT_THROW(ccd::step(before_, after_, {.threads = GetParam(), .stop = stop}), std::string);
}

INSTANTIATE_TEST_SUITE_P(Threads, Stop, testing::Values(1, 2));

}  // namespace
