// The soak detects a wrong answer and writes it out for a replay.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <ccd/exact.hpp>
#include <ccd/io/query_file.hpp>
#include <ccd/method.hpp>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "errbound/support/output_file.hpp"
#include "tests/soak/images.hpp"
#include "tests/soak/parts.hpp"

namespace {

namespace fs = std::filesystem;
using query_families::kind;

/// A fixture with a temporary folder.
class soak_test : public testing::Test {
  protected:
    soak_test() { fs::create_directories(folder); }
    ~soak_test() override { fs::remove_all(folder); }

    const fs::path folder =
        fs::temp_directory_path() / ("errbound_soak_test." + std::to_string(getpid()));
};

/// The answers of another method: `tight` is sometimes uncertain, `float` also wrong.
soak::decider by_method(ccd::method method) {
    return soak::one_by_one(std::string(ccd::info(method).name), [method](const auto& q) {
        if constexpr (requires { ccd::decide(method, q); })
            return ccd::decide(method, q);
        else
            return ccd::decide_exact(q);
    });
}

/// Faster than the reference, and right (exact_does_not_differ).
soak::decider exact() {
    return soak::exact_deciders().front();
}

/// Another decider's answers after `change(answers)`.
template <class Change>
soak::decider changed(std::string name, const soak::decider& right, const Change& change) {
    soak::decider all{.name = std::move(name)};
    ccd::for_each_kind([&]<ccd::kind K>() {
        all.decide.of<K>() = [decide = right.decide.of<K>(), change](
                                 const auto& list, std::span<ccd::outcome> answers) {
            const ccd::stage_report stages = decide(list, answers);
            change(answers);
            return stages;
        };
    });
    return all;
}

/// A decider that leaves the last query of each batch undecided.
soak::decider forgetful() {
    return changed("forgetful", exact(), [](std::span<ccd::outcome> answers) {
        answers.back() = ccd::outcome::uncertain;
    });
}

std::uint64_t count(const soak::findings& found, std::string_view table, std::string_view row,
                    std::size_t column) {
    for (const auto& [name, counts] : found.table(table).rows)
        if (name == row) return counts.at(column);
    ADD_FAILURE() << "no row " << row;
    return 0;
}

constexpr std::uint64_t few_blocks = 3;

soak::findings run(std::uint64_t seed, const fs::path& folder, const soak::part& what) {
    return soak::run({.seed = seed, .end = few_blocks, .threads = 2, .folder = folder}, what, 0,
                     [](const soak::findings&) {});
}

TEST_F(soak_test, exact_does_not_differ) {
    const auto deciders = soak::exact_deciders();
    const soak::part part = soak::comparison_part(soak::reference(), deciders);
    const soak::findings found = run(3, folder, part);
    EXPECT_EQ(found.blocks, few_blocks);
    ASSERT_GE(deciders.size(), 3u);
    for (const auto& d : deciders) {
        EXPECT_EQ(count(found, "against the reference", d.name, 1), 0u) << d.name;
        EXPECT_EQ(count(found, "against the reference", d.name, 0), part.count(few_blocks))
            << d.name;
    }
    EXPECT_EQ(found.different, 0u);
    EXPECT_FALSE(fs::exists(folder / "differences-vf.csv"));
}

TEST_F(soak_test, wrong_deciders_are_found_out) {
    const soak::findings found =
        soak::comparison_part(exact(), {exact(), by_method(ccd::method::float_),
                                        by_method(ccd::method::tight), forgetful()})
            .compare_block(1, 0);
    const auto differences = [&](std::string_view name) {
        return count(found, "against the reference", name, 1);
    };
    EXPECT_EQ(differences("one by one"), 0u);
    EXPECT_GT(differences("float"), 0u);
    EXPECT_GT(differences("tight"), 0u);
    EXPECT_EQ(differences("forgetful"), 2u);  // one for each kind
    EXPECT_EQ(found.differences.size(), found.different);
    EXPECT_GE(found.different, differences("float"));
}

TEST_F(soak_test, differing_queries_are_written_to_be_replayed) {
    const soak::findings found =
        run(7, folder, soak::comparison_part(exact(), {by_method(ccd::method::float_)}));
    std::size_t read = 0;
    for (const kind which : ccd::stored_kinds) {
        const auto file = ccd::io::read_queries(
            folder / ("differences-" + std::string(short_name(which)) + ".csv"), {}, false);
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
    EXPECT_EQ(read, found.different);
    EXPECT_GT(read, 0u);
}

// Integers can be moved, sheared and scaled without rounding; arbitrary doubles can only be scaled.
TEST_F(soak_test, images_are_of_every_form_where_they_are_exact) {
    ccd::lab::source random(1);
    const auto forms_of = [&](std::string_view name) {
        const auto& family =
            *std::ranges::find(query_families::families, name, &query_families::family::name);
        std::map<soak::image::form, int> forms;
        int reversed = 0, scaled = 0;
        for (std::uint64_t i = 0; i < 100; ++i) {
            const auto query = query_families::make(family, kind::edge_edge, 1, i);
            const soak::query_images images(query, 4, random);
            EXPECT_EQ(images.of({}), query);
            const soak::image m = images.draw(random);
            reversed += m.reversed;
            for (const auto& axis : m.axes) {
                ++forms[axis.as];
                scaled += axis.exponent != 0;
            }
        }
        EXPECT_GT(reversed, 20);
        EXPECT_GT(scaled, 50);
        return forms;
    };
    EXPECT_EQ(forms_of("grid5").size(), 4u);
    EXPECT_GT(forms_of("grid5")[soak::image::form::sheared], 10);
    EXPECT_EQ(forms_of("any-bits")[soak::image::form::sheared], 0);
}

TEST_F(soak_test, images_of_a_query_have_one_answer) {
    const soak::part part = soak::symmetry_part(soak::symmetric_deciders());
    const soak::findings found = run(3, folder, part);
    EXPECT_EQ(found.different, 0u) << found.differences.at(0).text;
    std::uint64_t answers = 0;
    for (const auto& d : soak::exact_deciders()) answers += count(found, "decider", d.name, 0);
    EXPECT_EQ(answers, part.count(few_blocks));
    // Late stages decide, too, and `tight` is certain at times.
    EXPECT_GT(count(found, "decided by", "integers", 0), answers / 10);
    EXPECT_GT(count(found, "decided by", "unbounded", 0), 0u);
    EXPECT_LT(count(found, "decider", "tight", 1), count(found, "decider", "tight", 0));
}

TEST_F(soak_test, one_answer_turned_round_among_thousands_is_found) {
    const soak::decider once = changed(
        "wrong once", exact(),
        [turned = std::make_shared<std::atomic<bool>>(false)](std::span<ccd::outcome> answers) {
            if (turned->exchange(true)) return;
            auto& answer = answers[answers.size() / 2];
            answer =
                answer == ccd::outcome::collides ? ccd::outcome::separate : ccd::outcome::collides;
        });
    const soak::findings found = soak::symmetry_part({exact(), once}).compare_block(1, 0);
    EXPECT_EQ(found.different, 1u);
    EXPECT_TRUE(found.have("wrong once returns"));
}

TEST_F(soak_test, rounding_methods_contradict_themselves_on_images) {
    const soak::decider wrong = by_method(ccd::method::float_);
    EXPECT_GT(soak::symmetry_part({wrong}).compare_block(1, 0).different, 0u);
    // Treats `float` as if it were conservative: certain answers are wrong.
    soak::decider certain = wrong;
    certain.may_be_uncertain = true;
    EXPECT_GT(soak::symmetry_part({exact(), certain}).compare_block(1, 0).different, 0u);
}

TEST_F(soak_test, exact_answers_uncertain_are_differences) {
    const soak::findings found = soak::symmetry_part({exact(), forgetful()}).compare_block(1, 0);
    EXPECT_EQ(found.different, 1u + 1 + 3 + 4);  // one for each kind, and as other kinds
}

TEST_F(soak_test, a_step_that_loses_one_pair_is_found) {
    const auto losing = [](const brute_force::two_frames& at, int threads, bool counted) {
        ccd::step_result result = soak::exact_step(at, threads, counted);
        auto& pairs = result.pairs.edge_edge;
        if (threads == 2 && pairs.size() > 3) pairs.pop_back();
        return result;
    };
    EXPECT_EQ(soak::mesh_part().compare_block(1, 0).different, 0u);
    const soak::findings found = soak::mesh_part(losing).compare_block(1, 0);
    ASSERT_GT(found.different, 0u);
    EXPECT_NE(found.differences[0].text.find("on 2 threads"), std::string::npos);
}

TEST_F(soak_test, a_throwing_decider_ends_the_run) {
    soak::decider throwing = exact();
    throwing.decide.vertex_face = [](const auto&, auto) -> ccd::stage_report {
        throw std::runtime_error("as expected");
    };
    EXPECT_THROW(run(1, folder, soak::comparison_part(exact(), {throwing})), std::runtime_error);
}

TEST_F(soak_test, as_many_blocks_as_queries_need) {
    for (const soak::part& part :
         {soak::comparison_part(exact(), {}), soak::symmetry_part({exact()})}) {
        EXPECT_EQ(part.blocks_for(0), 0u);
        for (const std::uint64_t queries : {1ull, 2000ull, 100000ull, 20000000ull}) {
            const std::uint64_t blocks = part.blocks_for(queries);
            EXPECT_GE(part.count(blocks), queries);
            EXPECT_LT(part.count(blocks - 1), queries);
        }
    }
}

}  // namespace
