// Components of `ccd report`: statistics, stored parts, data sets and their known answers, counts
// of errors.
#include "ccd/lab/report.hpp"

#include <gtest/gtest.h>

#include <array>
#include <errbound/support/error.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "ccd/lab/sections.hpp"
#include "errbound/support/output_file.hpp"
#include "tests/support/files.hpp"

namespace {

namespace fs = std::filesystem;
namespace lab = ccd::lab;
using ccd::kind;
using lab::row;
using lab::rows;

class Report : public testing::Test {
  protected:
    fs::path write(const fs::path& name, const std::string& text) const {
        test_files::write(folder_ / name, text);
        return folder_ / name;
    }
    /// The first data set below the folder.
    lab::loaded_data load() const { return lab::load(lab::find_data({folder_}).sources.at(0), 1); }

    const test_files::temporary_directory directory_;
    const fs::path folder_ = directory_.path;
};

TEST_F(Report, QuantilesAreOfTheNumbers) {
    const std::vector<double> four{1, 2, 3, 4};
    EXPECT_EQ(lab::quantile(four, 0), 1);
    EXPECT_EQ(lab::quantile(four, 0.25), 1);
    EXPECT_EQ(lab::quantile(four, 0.26), 2);
    EXPECT_EQ(lab::quantile(four, 0.5), 2);
    EXPECT_EQ(lab::quantile(four, 0.99), 4);
    EXPECT_EQ(lab::quantile(four, 1), 4);
    EXPECT_EQ(lab::quantile(std::vector<double>{7}, 0.5), 7);
    EXPECT_TRUE(std::isnan(lab::quantile({}, 0.5)));
}

TEST_F(Report, CsvQuotesWhatNeedsIt) {
    EXPECT_EQ(errbound::support::csv_of(
                  {"a", "b", "c"}, {{{"c", 0.1}, {"a", "x, \"y\""}}, {{"a", 3}, {"b", nullptr}}}),
              "a,b,c\n\"x, \"\"y\"\"\",,0.1\n3,,\n");
}

// A vertex that falls through a triangle, and one that stays above it.
constexpr const char* hit = "0.25,0.25,1\n0,0,0\n1,0,0\n0,1,0\n0.25,0.25,-1\n0,0,0\n1,0,0\n0,1,0\n";
constexpr const char* miss =
    "0.25,0.25,1\n0,0,0\n1,0,0\n0,1,0\n0.25,0.25,0.5\n0,0,0\n1,0,0\n0,1,0\n";

// A triangle, and another that falls from `z`, through it if that is negative.
using corners = std::array<const char*, 3>;
std::string frame(double z, const corners& falling = {"0.2 0.2 ", "0.4 0.2 ", "0.2 0.4 "}) {
    std::string text;
    for (const char* corner : {"0 0 ", "1 0 ", "0 1 "}) text += std::string("v ") + corner + "0\n";
    for (const char* corner : falling)
        text += std::string("v ") + corner + std::to_string(z) + '\n';
    return text + "f 1 2 3\nf 4 5 6\n";
}

TEST_F(Report, FindsQueriesByFolderAndScenesOfTwoFrames) {
    write("a/vertex-face/1.csv", hit);
    write("a/edge-edge/1.csv", hit);
    write("a/edge-edge/2.csv", hit);
    write("b/queries/1vf.csv", hit);
    write("other/table.csv", "x,y\n");
    write("b/frames/10.obj", frame(-1));
    write("b/frames/9.obj", frame(1));
    write("c/one.obj", frame(1));
    const auto found = lab::find_data({folder_, folder_ / "a"});
    ASSERT_EQ(found.sources.size(), 3U);
    EXPECT_EQ(found.sources[0].name, "b");
    ASSERT_EQ(found.sources[0].frames.size(), 2U);
    EXPECT_EQ(found.sources[0].frames[0].filename(), "9.obj");
    EXPECT_EQ(found.sources[1].name, "a");
    EXPECT_EQ(found.sources[1].queries.size(), 3U);
    EXPECT_EQ(found.sources[2].name, "b queries");
    ASSERT_EQ(found.skipped.size(), 2U);
    EXPECT_EQ(found.skipped[0].path.filename(), "table.csv");
    EXPECT_EQ(found.skipped[1].path.filename(), "c");
    EXPECT_THROW(lab::find_data({folder_ / "none"}), errbound::support::file_error);
}

TEST_F(Report, TruthIsTheFilesElseExact) {
    const std::string lines = std::string(hit) + miss;
    std::string with_truth;
    for (std::size_t at = 0; at < lines.size(); at = lines.find('\n', at) + 1)
        // wrong for the second query
        with_truth += lines.substr(at, lines.find('\n', at) - at) + ",1\n";
    write("a/vf/1.csv", lines);
    write("a/vf/2.csv", with_truth);
    const auto data = load();
    const auto& known = data->queries.vertex_face;
    EXPECT_EQ(known.collides, (std::vector<unsigned char>{1, 0, 1, 1}));
    EXPECT_EQ(known.colliding, 3U);
    EXPECT_EQ(known.stored_truths, 2U);

    for (const char* method : {"exact", "exact, batch"}) {
        const rows counted = lab::count_errors(*data, kind::vertex_face, method, 1, [](double) {});
        ASSERT_EQ(counted.size(), 1U);
        EXPECT_EQ(counted[0]["queries"], 4);
        EXPECT_EQ(counted[0]["collisions"], 2);
        EXPECT_EQ(counted[0]["false_negatives"], 1) << "against the file's wrong truth";
        EXPECT_EQ(counted[0]["false_positives"], 0);
    }
}

TEST_F(Report, SceneTruthIsComparedWithWhatIsStored) {
    write("s/frames/0.obj", frame(1));
    write("s/frames/1.obj", frame(-1));
    // Vertices 3, 4 and 5 fall through face 0, whose index follows those of 6 vertices and 6 edges.
    write("s/boxes/0vf.json", "[[3,12],[4,12],[5,12],[0,13]]");
    write("s/mma_bool/0vf_mma_bool.json", "[true,true,true,false]");
    auto data = load();
    EXPECT_EQ(data->origin, "scene");
    EXPECT_EQ(data->queries.vertex_face.colliding, 3U);
    EXPECT_EQ(data->queries.vertex_face.stored_truths, 4U);
    EXPECT_EQ(data->queries.vertex_face.contradictions, 0U);
    const std::string before = data->fingerprint;

    write("s/boxes/0vf.json", "[[3,12],[0,13]]");  // one is wrong, two are not listed
    write("s/mma_bool/0vf_mma_bool.json", "[false,true]");
    data = load();
    EXPECT_EQ(data->queries.vertex_face.contradictions, 4U);
    EXPECT_NE(data->fingerprint, before);

    write("s/boxes/0vf.json", "[[3,14],[0,13]]");
    EXPECT_THROW(load(), errbound::support::file_error);
    write("s/boxes/0vf.json", "[[3,12]]");
    EXPECT_THROW(load(), errbound::support::file_error);
}

TEST_F(Report, StoredPairsOfEdgesAreInAnyOrder) {
    // Falls across two edges of the other triangle.
    const corners crossing{"0.4 -0.5 ", "0.4 0.3 ", "2 -0.4 "};
    write("s/frames/0.obj", frame(1, crossing));
    write("s/frames/1.obj", frame(-1, crossing));
    // Edges follow 6 vertices: 01 02 12 34 35 45.
    write("s/boxes/0ee.json", "[[9,6],[8,11],[10,7]]");
    write("s/mma_bool/0ee_mma_bool.json", "[true,true,false]");
    const auto data = load();
    EXPECT_EQ(data->queries.edge_edge.colliding, 2U);
    EXPECT_EQ(data->queries.edge_edge.stored_truths, 3U);
    EXPECT_EQ(data->queries.edge_edge.contradictions, 0U);
}

}  // namespace
