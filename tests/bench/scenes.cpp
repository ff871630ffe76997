#include "tests/bench/scenes.hpp"

#include <cstdlib>
#include <filesystem>
#include <utility>

namespace bench {

namespace fs = std::filesystem;
using ccd::lab::loaded_data;

std::vector<std::string> scene_names() {
    return {"cloth-over-ball", "cloth-funnel", "cloth-ball", "handcrafted", "small integers"};
}

loaded_data load(const std::string& name) {
    if (name == "small integers")
        for (auto& data : ccd::lab::made_data(0))
            if (data->name == name) return std::move(data);
    const char* shared = std::getenv("ERRBOUND_SHARED_DATA");
    const fs::path data_folder = shared != nullptr ? shared : ERRBOUND_SHARED_DATA;
    const fs::path folder = name == "cloth-over-ball" ? fs::path(ERRBOUND_SCENES) / name
                            : name == "handcrafted"   ? data_folder / "queries"
                                                      : data_folder / "scenes" / name / "frames";
    if (!fs::is_directory(folder)) return nullptr;
    ccd::lab::data_source all{name, {}, {}};
    for (auto& found : ccd::lab::find_data({folder}).sources) {
        all.queries.insert(all.queries.end(), found.queries.begin(), found.queries.end());
        if (name != "handcrafted") all.frames = std::move(found.frames);
    }
    if (all.queries.empty() && all.frames.empty()) return nullptr;
    return ccd::lab::load(all, 0);
}

}  // namespace bench
