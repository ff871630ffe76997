#include "tests/bench/scenes.hpp"

#include <ccd/io/mesh_file.hpp>
#include <ccd/step.hpp>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "ccd/lab/data_set.hpp"
#include "tests/support/query_families.hpp"

namespace bench {
namespace {

namespace fs = std::filesystem;

fs::path data_folder() {
    const char* folder = std::getenv("ERRBOUND_SHARED_DATA");
    return folder != nullptr ? folder : ERRBOUND_SHARED_DATA;
}

/// Adds all queries of files in the folder; returns false if there are none.
bool read_stored(const fs::path& folder, query_sets& queries) {
    if (!fs::is_directory(folder)) return false;
    bool found = false;
    for (const auto& source : ccd::lab::find_data({folder}).sources) {
        if (source.queries.empty()) continue;
        found = true;
        const auto data = ccd::lab::load(source, 0);
        const auto append = [](auto& into, const auto& from) {
            into.insert(into.end(), from.begin(), from.end());
        };
        append(queries.vertex_face.stored, data->queries.vertex_face.queries.stored);
        append(queries.edge_edge.stored, data->queries.edge_edge.queries.stored);
    }
    return found;
}

/// Queries on small integer grids; most are degenerate.
void make_degenerate(query_sets& queries) {
    constexpr std::uint64_t of_each_family = 2000, seed = 1;
    for (const auto& family : query_families::families) {
        if (family.name.find("grid") == std::string_view::npos ||
            family.name.find('^') != std::string_view::npos)
            continue;
        queries.for_each([&]<class Query>(query_set<Query>& into) {
            for (std::uint64_t i = 0; i < of_each_family; ++i)
                into.stored.push_back(query_families::as_query<Query>(
                    query_families::make(family, ccd::kind_of<Query>, seed, i)));
        });
    }
}

fs::path frames_of(const std::string& name) {
    return name == "cloth-over-ball" ? fs::path(ERRBOUND_SCENES) / name
                                     : data_folder() / "scenes" / name / "frames";
}

}  // namespace

std::vector<std::string> scene_names() {
    return {"cloth-over-ball", "cloth-funnel", "cloth-ball", "handcrafted", "degenerate"};
}

bool load(const std::string& name, scene& into) {
    into.name = name;
    if (name == "handcrafted") return read_stored(data_folder() / "queries", into.queries);
    if (name == "degenerate") {
        make_degenerate(into.queries);
        return true;
    }
    if (!fs::is_directory(frames_of(name))) return false;
    const auto found = ccd::lab::find_data({frames_of(name)});
    if (found.sources.empty()) return false;
    const auto& frames = found.sources.front().frames;
    into.before = ccd::io::read_mesh(frames.at(0));
    into.after = ccd::io::read_mesh(frames.at(1));
    ccd::pair_lists pairs = ccd::candidates(into.before, into.after);
    into.queries.vertex_face.by_index = std::move(pairs.vertex_face);
    into.queries.edge_edge.by_index = std::move(pairs.edge_edge);
    into.queries.for_each(
        [rows = ccd::vertex_rows(into.before, into.after)](auto& set) { set.rows = rows; });
    return true;
}

}  // namespace bench
