// Compares the table of `exact`'s stages in the code with that in the documents.
#include <gtest/gtest.h>

#include <ccd/explain.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <fstream>
#include <string>

namespace {

TEST(exact_stages, stand_at_their_places) {
    for (std::size_t i = 0; i < ccd::stage_count; ++i) {
        const auto stage = static_cast<ccd::stage>(i);
        EXPECT_EQ(ccd::exact_stages[i].stage, stage);
        EXPECT_EQ(ccd::info(stage).name, ccd::exact_stages[i].name);
    }
    EXPECT_EQ(ccd::info(static_cast<ccd::stage>(ccd::stage_count)).name, "unknown");
    EXPECT_EQ(ccd::info(static_cast<ccd::stage>(255)).name, "unknown");
}

TEST(exact_stages, are_the_rows_of_the_page) {
    std::ifstream page(ERRBOUND_STAGES_PAGE);
    ASSERT_TRUE(page) << ERRBOUND_STAGES_PAGE;
    const std::string head = "| stage | question | arithmetic |";
    std::string line;
    while (std::getline(page, line) && line != head) continue;
    ASSERT_EQ(line, head) << "no such table in " << ERRBOUND_STAGES_PAGE;
    ASSERT_TRUE(std::getline(page, line));  // the line below the heading
    for (const ccd::stage_info& s : ccd::exact_stages) {
        ASSERT_TRUE(std::getline(page, line));
        EXPECT_EQ(line, "| " + std::string(s.name) + " | " + std::string(s.question) + " | " +
                            std::string(s.arithmetic) + " |");
    }
    std::getline(page, line);
    EXPECT_EQ(line, "") << "a row that the code does not have";
}

TEST(verdict, is_undecided_by_default) {
    constexpr ccd::verdict nothing;
    EXPECT_EQ(nothing.outcome, ccd::outcome::uncertain);
    EXPECT_EQ(nothing.cause, ccd::cause::undecided);
    EXPECT_TRUE(may_collide(nothing));
}

TEST(verdict, has_names) {
    EXPECT_EQ(name(ccd::outcome::collides), "collides");
    EXPECT_EQ(name(ccd::cause::undecided), "undecided");
    EXPECT_EQ(name(static_cast<ccd::outcome>(3)), "unknown");
    EXPECT_EQ(name(static_cast<ccd::cause>(200)), "unknown");
}

}  // namespace
