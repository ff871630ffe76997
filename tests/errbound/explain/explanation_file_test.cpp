// Files of explanations, messages for bad ones, and flame graphs.
#include "errbound/program/explanation_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "errbound/program/flame_graph.hpp"
#include "tests/support/files.hpp"

namespace {

using errbound::contribution;
using errbound::explanation;
using errbound::json_of;
using errbound::explaining::flame_graphs;
using errbound::explaining::parse_explanations;
using test_files::message_of;

const double infinity = std::numeric_limits<double>::infinity();

std::vector<explanation> some() {
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
    const std::string text = json_of(some());
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
    std::string text = json_of(some());
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
    const std::string text = json_of(some());
    for (std::size_t length = 0; length + 1 < text.size(); ++length)
        EXPECT_TRUE(message_of([&] {
                        parse_explanations(text.substr(0, length), "f");
                    }).starts_with("f: text at byte"));
}

TEST(FlameGraph, HasABarForEachScopeAndOperation) {
    const std::string svg = flame_graphs(some());
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
