// First times of stored queries, and of all colliding pairs of stored scenes, compared with the
// oracle. Such data has many contacts at the start, ties, and contacts without crossing.
//
// Data are in the folder ERRBOUND_SHARED_DATA of the environment, else of the build; one scene is
// in the repository.
#include <gtest/gtest.h>

#include <algorithm>
#include <ccd/io/mesh_file.hpp>
#include <ccd/io/query_file.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tests/support/distance_families.hpp"
#include "tests/support/first_time_faults.hpp"

namespace {

namespace fs = std::filesystem;

fs::path data_folder() {
    if (const char* folder = std::getenv("ERRBOUND_SHARED_DATA")) return folder;
    return ERRBOUND_SHARED_DATA;
}

std::vector<fs::path> files_in(const fs::path& folder, const std::string& extension) {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.path().extension() == extension) paths.push_back(entry.path());
    std::ranges::sort(paths);
    return paths;
}

/// Compares contact, and a random distance.
template <class Query>
void expect_right_times(const Query& query, std::size_t index) {
    EXPECT_EQ(support::fault_of(query, ccd::time_of_impact(query)), "") << "query " << index;
    ccd::lab::points at{};
    std::ranges::copy(ccd::points_of(query), at.begin());
    auto random = ccd::lab::source_of("stored", {index});
    const auto& family = distance_families::draw(random);
    const ccd::separation d = family.make(random, ccd::kind_of<Query>, at);
    EXPECT_EQ(support::fault_of(query, d, ccd::time_within(query, d)), "")
        << "query " << index << ", " << family.name;
}

TEST(stored, queries) {
    const fs::path data = data_folder();
    if (!fs::is_directory(data))
        GTEST_SKIP() << "No stored queries at \"" << data.string()
                     << "\": set ERRBOUND_SHARED_DATA to the folder that holds them.";
    std::size_t count = 0;
    for (const fs::path& path : files_in(data, ".csv")) {
        SCOPED_TRACE(path.string());
        const auto file = ccd::io::read_queries(path, std::nullopt, false);
        std::visit(
            [&](const auto& queries) {
                for (std::size_t i = 0; i < queries.size(); ++i, ++count)
                    expect_right_times(queries[i], i);
            },
            file.queries);
    }
    std::cout << count << " queries\n";
}

void expect_right_scene(const fs::path& before, const fs::path& after) {
    SCOPED_TRACE(before.string());
    const ccd::mesh first = ccd::io::read_mesh(before), second = ccd::io::read_mesh(after);
    const ccd::step_result step = ccd::step(first, second, {.times = true});
    const ccd::vertex_rows rows{&first.vertices.data()->x, &second.vertices.data()->x,
                                first.vertices.size()};
    std::size_t count = 0, at_start = 0;
    ccd::for_each_kind([&]<ccd::kind K>() {
        const auto& pairs = step.pairs.of<K>();
        const auto& times = step.times.of<K>();
        ASSERT_EQ(times.size(), pairs.size());
        for (std::size_t i = 0; i < pairs.size(); ++i, ++count) {
            at_start += times[i].at_start();
            EXPECT_EQ(support::fault_of(query_of(rows, pairs[i]), times[i]), "")
                << path_name(K) << " pair " << i;
        }
    });
    EXPECT_GT(count, 0u);
    std::cout << count << " pairs collide, " << at_start << " at the start: " << before << "\n";
}

TEST(stored, scene_of_the_repository) {
    const fs::path scene = ERRBOUND_SCENE;
    expect_right_scene(scene / "frame0.ply", scene / "frame1.ply");
}

TEST(stored, scenes) {
    const fs::path scenes = data_folder() / "scenes";
    if (!fs::is_directory(scenes))
        GTEST_SKIP() << "No stored scenes at \"" << scenes.string()
                     << "\": set ERRBOUND_SHARED_DATA to the folder that holds them.";
    for (const auto& entry : fs::directory_iterator(scenes)) {
        if (!entry.is_directory()) continue;
        const auto frames = files_in(entry.path(), ".ply");
        ASSERT_EQ(frames.size(), 2u) << entry.path();
        expect_right_scene(frames[0], frames[1]);
    }
}

}  // namespace
