// Stored queries and scenes, in the folder ERRBOUND_SHARED_DATA of the environment, else of the
// build. Tests are skipped without it.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace stored_data {

inline constexpr const char* missing =
    "No stored data: set ERRBOUND_SHARED_DATA to the folder that holds them.";

inline std::filesystem::path folder() {
    const char* given = std::getenv("ERRBOUND_SHARED_DATA");
    return given != nullptr ? given : ERRBOUND_SHARED_DATA;
}

/// All files with this extension below a folder, sorted.
inline std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder,
                                                   const std::string& extension) {
    std::vector<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.path().extension() == extension) paths.push_back(entry.path());
    std::ranges::sort(paths);
    return paths;
}

inline bool has_scenes() {
    return std::filesystem::is_directory(folder() / "scenes");
}
/// Calls visit(before, after) for the two frames of each stored scene.
template <class Visit>
void for_each_scene(const Visit& visit) {
    for (const auto& entry : std::filesystem::directory_iterator(folder() / "scenes")) {
        if (!entry.is_directory()) continue;
        const auto frames = files_in(entry.path(), ".ply");
        if (frames.size() != 2)
            throw std::runtime_error(entry.path().string() + ": expected two frames");
        visit(frames[0], frames[1]);
    }
}

}  // namespace stored_data
