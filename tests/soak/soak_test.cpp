// The soak itself: it sees a wrong answer, writes it out to be replayed, and a run that was stopped
// and resumed ends as one that was not.
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <ccd/io/query_file.hpp>
#include <ccd/method.hpp>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "errbound/support/output_file.hpp"
#include "tests/soak/comparison.hpp"
#include "tests/soak/long_run.hpp"

namespace {

namespace fs = std::filesystem;
using query_families::kind;

/// A folder of this test, removed with it.
class soak_test : public testing::Test {
  protected:
    soak_test() { fs::create_directories(folder); }
    ~soak_test() override { fs::remove_all(folder); }

    const fs::path folder =
        fs::temp_directory_path() / ("errbound_soak_test." + std::to_string(getpid()));
};

/// The answers of another method: `tight` is uncertain at times, `float` also wrong.
soak::decider by_method(ccd::method method) {
    const auto decide = [method](auto queries, std::span<ccd::outcome> answers) {
        for (std::size_t i = 0; i < queries.size(); ++i) {
            answers[i] = ccd::decide(method, queries[i]).outcome;
        }
    };
    return {std::string(ccd::info(method).name), {decide, decide}};
}

/// One that leaves the last query of each batch undecided.
soak::decider forgetful() {
    const soak::decider right = soak::reference();
    const auto all_but_last = [](const auto& decide) {
        return [decide](auto queries, std::span<ccd::outcome> answers) {
            decide(queries.first(queries.size() - 1), answers.first(answers.size() - 1));
        };
    };
    return {"forgetful",
            {all_but_last(right.decide.vertex_face), all_but_last(right.decide.edge_edge)}};
}

constexpr std::uint64_t few_blocks = 3;

soak::state run(const soak::state& from, const fs::path& folder,
                const std::vector<soak::decider>& deciders, const std::atomic<bool>& stop = false) {
    return soak::run(from, {.blocks = few_blocks, .threads = 2, .folder = folder},
                     soak::reference(), deciders, stop, [](const soak::state&) {});
}

TEST_F(soak_test, exact_does_not_differ) {
    const soak::state s = run({.seed = 3}, folder, soak::exact_deciders());
    EXPECT_EQ(s.found.blocks, few_blocks);
    ASSERT_GE(s.found.deciders.size(), 3u);
    for (const auto& d : s.found.deciders) {
        EXPECT_EQ(d.differences, 0u) << d.name;
        EXPECT_EQ(d.compared, soak::query_count(few_blocks)) << d.name;
    }
    EXPECT_EQ(s.found.differing_queries, 0u);
    EXPECT_FALSE(fs::exists(soak::differences_path(folder, kind::vertex_face)));
}

TEST_F(soak_test, wrong_deciders_are_found_out) {
    const soak::totals found =
        soak::compare_block(1, 0, soak::reference(),
                            std::vector{soak::reference(), by_method(ccd::method::float_),
                                        by_method(ccd::method::tight), forgetful()});
    ASSERT_EQ(found.deciders.size(), 4u);
    EXPECT_EQ(found.deciders[0].differences, 0u);
    EXPECT_GT(found.deciders[1].differences, 0u);
    EXPECT_GT(found.deciders[2].differences, 0u);
    EXPECT_EQ(found.deciders[3].differences, 2u);  // one of each kind
    std::uint64_t listed = 0;
    for (const soak::difference& d : found.differences) listed += d.wrong.size();
    EXPECT_EQ(listed, found.deciders[1].differences + found.deciders[2].differences + 2);
    EXPECT_EQ(found.differences.size(), found.differing_queries);
}

TEST_F(soak_test, differing_queries_are_written_to_be_replayed) {
    const soak::state s = run({.seed = 7}, folder, {by_method(ccd::method::float_)});
    std::size_t read = 0;
    for (const kind which : ccd::stored_kinds) {
        const auto file = ccd::io::read_queries(soak::differences_path(folder, which), {}, false);
        ASSERT_TRUE(file.truth.has_value());
        for (std::size_t i = 0; i < file.size(); ++i, ++read) {
            const auto [exact, wrong] = std::visit(
                [i](const auto& queries) {
                    return std::pair(ccd::decide(ccd::method::exact, queries[i]),
                                     ccd::decide(ccd::method::float_, queries[i]));
                },
                file.queries);
            EXPECT_NE(wrong.outcome, exact.outcome);
            EXPECT_EQ((*file.truth)[i], exact.outcome == ccd::outcome::collides);
        }
    }
    EXPECT_EQ(read, s.found.differing_queries);
    EXPECT_GT(read, 0u);
}

TEST_F(soak_test, resumed_run_ends_like_an_uninterrupted_one) {
    const std::vector<soak::decider> deciders{by_method(ccd::method::exact),
                                              by_method(ccd::method::float_)};
    const soak::state whole = run({.seed = 5}, folder / "whole", deciders);

    // Stopped after every few queries, and resumed from the file each time.
    soak::state s{.seed = 5};
    int sittings = 0;
    for (; s.found.blocks < few_blocks; ++sittings) {
        std::atomic<bool> stop = false;
        soak::decider stopping = deciders[0];
        stopping.decide.edge_edge = [&stop, decide = deciders[0].decide.edge_edge](auto queries,
                                                                                   auto answers) {
            stop = true;
            decide(queries, answers);
        };
        run(s, folder / "parts", {stopping, deciders[1]}, stop);
        s = soak::from_json(errbound::support::read_whole(soak::state_path(folder / "parts")));
    }
    EXPECT_GT(sittings, 1);
    EXPECT_EQ(s.found, whole.found);
    for (const kind which : ccd::stored_kinds) {
        EXPECT_EQ(errbound::support::read_whole(soak::differences_path(folder / "parts", which)),
                  errbound::support::read_whole(soak::differences_path(folder / "whole", which)));
    }
}

TEST_F(soak_test, a_throwing_decider_ends_the_run) {
    soak::decider throwing = soak::reference();
    throwing.decide.vertex_face = [](auto, auto) { throw std::runtime_error("as asked"); };
    EXPECT_THROW(run({.seed = 1}, folder, {throwing}), std::runtime_error);
}

TEST_F(soak_test, states_that_cannot_be_resumed_are_refused) {
    const std::string good = soak::to_json({.seed = 1});
    EXPECT_EQ(soak::from_json(good), soak::state{.seed = 1});
    std::string other = good;
    other.replace(other.find("uniform"), 7, "unknown");
    for (const std::string& bad : {other, std::string("{}"), std::string(), std::string("[1]")}) {
        EXPECT_THROW(soak::from_json(bad), std::runtime_error) << bad;
    }
}

TEST_F(soak_test, as_many_blocks_as_queries_need) {
    EXPECT_EQ(soak::blocks_for(0), 0u);
    for (const std::uint64_t queries : {1ull, 2000ull, 100000ull, 20000000ull}) {
        const std::uint64_t blocks = soak::blocks_for(queries);
        EXPECT_GE(soak::query_count(blocks), queries);
        EXPECT_LT(soak::query_count(blocks - 1), queries);
    }
}

}  // namespace
