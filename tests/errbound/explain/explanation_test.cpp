// Tables and files of explanations, messages for bad files, and flame graphs.
#include <gtest/gtest.h>

#include <cmath>
#include <errbound/explain/explain.hpp>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "errbound/program/explanation_file.hpp"
#include "errbound/program/flame_graph.hpp"
#include "tests/support/files.hpp"

namespace {

using errbound::contribution;
using errbound::explanation;
using errbound::json_of;
using errbound::explaining::flame_graphs;
using errbound::explaining::parse_explanations;
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

std::vector<explanation> several() {
    return {{"area",
             "tight",
             0.1,
             4e-3,
             {{{{"outer", "/src/a.cpp", 3}, {"in <&\"ner", "/src/b.cpp", 14}}, "+", 3e-3, -1e-3},
              {{}, "input", 1e-3, 0}}},
            {"nothing", "residual", 1, 0, {}},
            {"unknown", "tight", 1, infinity, {{{{"s", "f", 0}}, "/", infinity, 0}}}};
}

TEST(ExplanationFile, IsReadBackAsWritten) {
    const std::string text = json_of(several());
    const std::vector<explanation> read = parse_explanations(text, "file");
    EXPECT_EQ(json_of(read), text);
    EXPECT_EQ(read[0].contributions[0].known, -1e-3);
    EXPECT_EQ(read[0].contributions[0].scopes[1].line, 14U);
    EXPECT_TRUE(std::isinf(read[2].error));
    EXPECT_TRUE(parse_explanations(json_of(std::vector<explanation>()), "file").empty());
    const auto again = [](double value) {
        return parse_explanations(json_of({explanation{"one", "tight", value, infinity, {}}}),
                                  "file")[0]
            .value;
    };
    EXPECT_TRUE(std::signbit(again(-0.0)));
    EXPECT_EQ(again(-infinity), -infinity);
    EXPECT_TRUE(std::isnan(again(std::nan(""))));
}

/// The message for the file with one text replaced by another.
std::string message_with(const std::string& from, const std::string& to) {
    std::string text = json_of(several());
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    return message_of([&] { parse_explanations(text, "f.json"); });
}

TEST(ExplanationFile, MessagesHavePositionFoundAndExpected) {
    EXPECT_EQ(
        message_of([] { parse_explanations("{\"a\": ", "f.json"); }),
        "f.json: text at byte 7 is not JSON; expected output of errbound::write_explanations");
    EXPECT_EQ(message_of([] { parse_explanations("[]", "f.json"); }),
              "f.json: content is []; expected an object");
    const auto expect = [](const std::string& from, const std::string& to,
                           const std::string& message) {
        EXPECT_EQ(message_with(from, to), "f.json: " + message);
    };
    expect("errbound explanation", "other",
           "format is \"other\"; expected \"errbound explanation\"");
    expect("\"version\": 1", "\"version\": 2", "version is 2; expected 1");
    expect("\"error\": 0.004", "\"error\": -0.004",
           "results[0].error is -0.004; expected a number that is not negative, or null");
    expect("\"value\": 0.1", "\"value\": \"0.1\"",
           "results[0].value is \"0.1\"; expected a number, \"inf\", \"-inf\" or null");
    expect("\"value\": 0.1", "\"value\": 1e999",
           "a number is out of range; expected numbers of double");
    expect("\"line\": 14", "\"line\": -1",
           "results[0].contributions[0].scopes[1].line is -1; expected a line's number");
    expect("\"amount\": 0.001", "\"amunt\": 0.001",
           "results[0].contributions[1].amount is missing; expected a value");
    expect("\"operation\": \"/\"", "\"operation\": [1]",
           "results[2].contributions[0].operation is an array; expected a string");
    expect("\"name\": \"area\"", "\"name\": {\"a\": \"" + std::string(99, 'x') + "\"}",
           "results[0].name is an object; expected a string");
    expect("\"contributions\": []", "\"contributions\": {}",
           "results[1].contributions is {}; expected an array");
    EXPECT_NE(message_with("area", "\xff").find("text at byte"), std::string::npos);
}

TEST(ExplanationFile, OfAnyDepth) {
    constexpr std::size_t depth = 200'000;
    const std::string inner = std::string(depth, '[') + std::string(depth, ']');
    EXPECT_EQ(message_with("\"errbound explanation\"", inner),
              "f.json: format is an array; expected \"errbound explanation\"");
    EXPECT_EQ(message_with("\"operation\": \"/\"", "\"operation\": " + inner),
              "f.json: results[2].contributions[0].operation is an array; expected a string");
    EXPECT_NE(message_with("\"operation\": \"/\"", std::string(depth, '[')).find("is not JSON"),
              std::string::npos);
}

TEST(ExplanationFile, CutAnywhereIsRefused) {
    const std::string text = json_of(several());
    for (std::size_t length = 0; length + 1 < text.size(); ++length)
        EXPECT_TRUE(message_of([&] {
                        parse_explanations(text.substr(0, length), "f");
                    }).starts_with("f: text at byte"));
}

TEST(FlameGraph, HasABarForEachScopeAndOperation) {
    const std::string svg = flame_graphs(several());
    EXPECT_EQ(svg.find("<svg xmlns=\"http://www.w3.org/2000/svg\""), 0U);
    EXPECT_TRUE(svg.ends_with("</svg>\n"));
    for (const char* tip :
         {"<title>area: 100.0 %, 4.00e-03</title>",
          "<title>outer (/src/a.cpp:3): 75.0 %, 3.00e-03</title>",
          "<title>in &lt;&amp;&quot;ner (/src/b.cpp:14): 75.0 %",
          "<title>+: 75.0 %, 3.00e-03</title>", "<title>input: 25.0 %, 1.00e-03</title>",
          "<title>nothing: 100.0 %, 0.00e+00</title>", "<title>/: 100.0 %, unknown</title>",
          ">nothing = 1 ± 0, by residual: no error<", ">area = 0.1 ± 4.0e-03, by tight<"})
        EXPECT_NE(svg.find(tip), std::string::npos) << tip;
    // The sum's bar has three quarters of the root's 980 pixels; the input's bar is next to it.
    EXPECT_NE(svg.find("width=\"735.0\""), std::string::npos);
    EXPECT_NE(svg.find("x=\"745.0\""), std::string::npos);
}

TEST(FlameGraph, OfManySourcesAndDeepScopes) {
    explanation e{"deep", "tight", 1, 1, {}};
    for (int i = 0; i < 50'000; ++i)
        e.contributions.push_back(
            {{{"s", "f", static_cast<unsigned>(i)}}, i % 2 == 0 ? "+" : "*", 1.0 / 50'000, 0});
    contribution deepest{{}, "-", 1, 0};
    for (unsigned i = 0; i < 100'000; ++i) deepest.scopes.push_back({"deep", "f", i});
    e.contributions.push_back(deepest);
    EXPECT_TRUE(flame_graphs({e}).ends_with("</svg>\n"));
    EXPECT_EQ(flame_graphs({}).find("<title>"), std::string::npos);
}

TEST(FlameGraph, HasSharesOfAmountsWhoseSumOverflows) {
    explanation e{"large", "tight", 1, 1, {{{}, "+", 1e308, 0}, {{}, "*", 1e308, 0}}};
    EXPECT_NE(flame_graphs({e}).find("<title>+: 50.0 %, 1.00e+308</title>"), std::string::npos);
}

TEST(FlameGraph, HasOnlyCharactersOfXml) {
    explanation e{std::string("a\x01\xff\xef\xbf\xbf") + "b\xc3\xa4", "tight", 1, 1, {}};
    const std::string svg = flame_graphs({e});
    EXPECT_NE(svg.find(">a???b\xc3\xa4<"), std::string::npos);
}

}  // namespace
