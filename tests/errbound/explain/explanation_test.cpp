// Tables and files of explanations.
#include <gtest/gtest.h>

#include <errbound/explain/explain.hpp>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/files.hpp"

namespace {

using errbound::contribution;
using errbound::explanation;
using errbound::json_of;
using test_files::files_in;
using test_files::message_of;
using test_files::temporary_directory;

const double infinity = std::numeric_limits<double>::infinity();

explanation some() {
    return {"area",
            "tight",
            2.5,
            4e-3,
            {{{{"outer", "/src/a.cpp", 3}, {"inner", "/src/b.cpp", 14}}, "+", 3e-3, 0},
             {{}, "input", 9e-4, 0},
             {{}, "the rest", 1e-4, 0}}};
}

const std::string lines[] = {"  3.00e-03  75.0 %  +          outer > inner (b.cpp:14)\n",
                             "  9.00e-04  22.5 %  input\n", "  1.00e-04   2.5 %  the rest\n"};

TEST(Table, HasALineForEachSource) {
    const std::string head =
        "area = 2.5 ± 4.0e-03, by tight\n    amount   share  operation  scope\n";
    EXPECT_EQ(text_of(some()), head + lines[0] + lines[1] + lines[2]);
    EXPECT_EQ(text_of(some(), 1), head + lines[0] + "  and 2 more\n");
}

TEST(Table, HasNoControlCharacters) {
    explanation e = some();
    e.name = "\x1b[2J\xff\xc2\x9b";
    e.contributions[0].scopes[1].name = "in\nner\x7f";
    e.contributions[1].operation = "\xc3\xa4\xe2\x88\x9a";  // counts as two columns
    EXPECT_EQ(text_of(e),
              "?[2J?? = 2.5 ± 4.0e-03, by tight\n"
              "    amount   share  operation  scope\n"
              "  3.00e-03  75.0 %  +          outer > in?ner? (b.cpp:14)\n"
              "  9.00e-04  22.5 %  \xc3\xa4\xe2\x88\x9a\n" +
                  lines[2]);
    e.contributions[0].operation = "\xc3\xa4\xe2\x88\x9a";
    EXPECT_NE(text_of(e).find("75.0 %  \xc3\xa4\xe2\x88\x9a         outer"), std::string::npos);
}

TEST(Table, ShowsCancellation) {
    explanation e = some();
    e.contributions[0].known = -3e-3;
    e.contributions[1].known = 9e-4;
    e.error = 2.2e-3;
    EXPECT_EQ(text_of(e, 2),
              "area = 2.5 ± 2.2e-03, by tight\n"
              "    amount     signed   share  operation  scope\n"
              "  3.00e-03  -3.00e-03  75.0 %  +          outer > inner (b.cpp:14)\n"
              "  9.00e-04  +9.00e-04  22.5 %  input\n"
              "  and 1 more\n"
              "  the amounts add up to 4.00e-03; errors cancel to at most 2.20e-03\n");
}

TEST(Table, OfInfiniteAndZeroErrors) {
    explanation e = some();
    e.error = e.contributions[0].amount = infinity;
    EXPECT_EQ(text_of(e, 1),
              "area = 2.5 ± unknown, by tight\n"
              "   amount    share  operation  scope\n"
              "  unknown  100.0 %  +          outer > inner (b.cpp:14)\n"
              "  and 2 more\n");
    e.error = 0;
    e.contributions.clear();
    EXPECT_EQ(text_of(e), "area = 2.5 ± 0, by tight\n  no error\n");
}

TEST(Shares, AreOfTheSumOrOfTheInfiniteAmounts) {
    explanation e = some();
    const std::vector<double> of_sum = shares_of(e);
    ASSERT_EQ(of_sum.size(), 3U);
    EXPECT_DOUBLE_EQ(of_sum[0], 0.75);
    EXPECT_DOUBLE_EQ(of_sum[1], 0.225);
    EXPECT_DOUBLE_EQ(of_sum[2], 0.025);
    e.contributions[1].amount = e.contributions[2].amount = infinity;
    EXPECT_EQ(shares_of(e), std::vector<double>({0, 0.5, 0.5}));
    for (contribution& c : e.contributions) c.amount = 0;
    EXPECT_EQ(shares_of(e), std::vector<double>({0, 0, 0}));
}

TEST(Json, HasNumbersAndNames) {
    explanation e = some();
    e.contributions.pop_back();
    e.name = "a\"b\\c\n\xc3\xa4\xff\xed\xa0\x80";
    e.value = 0.1;
    e.contributions[1].amount = infinity;
    EXPECT_EQ(json_of({e}), R"({
  "format": "errbound explanation",
  "version": 1,
  "results": [
    {
      "name": "a\"b\\c\u000a)"
                            "\xc3\xa4"
                            R"(????",
      "rule": "tight",
      "value": 0.1,
      "error": 0.004,
      "contributions": [
        {"amount": 0.003, "known": 0, "operation": "+", "scopes": [{"name": "outer", "file": "/src/a.cpp", "line": 3}, {"name": "inner", "file": "/src/b.cpp", "line": 14}]},
        {"amount": null, "known": 0, "operation": "input", "scopes": []}
      ]
    }
  ]
}
)");
    EXPECT_EQ(
        json_of(std::vector<explanation>()),
        "{\n  \"format\": \"errbound explanation\",\n  \"version\": 1,\n  \"results\": []\n}\n");
}

namespace fs = std::filesystem;

std::string text_in(const fs::path& file) {
    std::ostringstream read;
    read << std::ifstream(file).rdbuf();
    return read.str();
}

TEST(File, IsWholeOrNotWritten) {
    const temporary_directory directory;
    const auto file = directory.path / "out.json";
    errbound::write_explanations(file, {some()});
    errbound::write_explanations(file, {some(), some()});
    EXPECT_EQ(text_in(file), json_of({some(), some()}));
    for (const fs::path& bad :
         {directory.path / "no" / "out.json", directory.path, fs::path("/dev/full")})
        EXPECT_NE(message_of([&] {
                      errbound::write_explanations(bad, {some()});
                  }).find(bad.string() + ": cannot be written"),
                  std::string::npos);
    EXPECT_EQ(files_in(directory.path), 1);
}

TEST(File, KeepsLinksAndPermissions) {
    const temporary_directory directory;
    const auto file = directory.path / "out.json", link = directory.path / "link.json";
    test_files::write(file, "before");
    const fs::perms own = fs::perms::owner_read | fs::perms::owner_write;
    fs::permissions(file, own);
    if (!test_files::link("out.json", link)) GTEST_SKIP() << "no symbolic links";
    errbound::write_explanations(link, {some()});
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(fs::status(file).permissions(), own);
    EXPECT_EQ(text_in(file), json_of({some()}));
    EXPECT_EQ(files_in(directory.path), 2);
}

}  // namespace
