#include "ccd/program/first_pairs.hpp"

#include <algorithm>
#include <ccd/methods/transform.hpp>
#include <cstddef>
#include <nlohmann/json.hpp>

#include "ccd/lab/queries.hpp"
#include "errbound/support/table.hpp"

namespace ccd::program {
namespace {

using errbound::support::fixed;

std::span<const vertex_index> vertices_of_reason(const reason& r) {
    return visit_kind(r.kind, [&]<kind K>() {
        constexpr std::size_t count =
            kind_traits<K>::first_vertices + kind_traits<K>::second_vertices;
        return std::span(r.vertices).first(count);
    });
}

std::string text_of_pair(const reason& r) {
    std::string text(short_name(r.kind));
    for (const vertex_index v : vertices_of_reason(r)) text += ',' + std::to_string(v);
    return text;
}

nlohmann::ordered_json or_null(double value, double error) {
    return error < std::numeric_limits<double>::infinity() ? nlohmann::ordered_json{value, error}
                                                           : nlohmann::ordered_json(nullptr);
}

}  // namespace

std::string text_of_reasons(std::span<const reason> all) {
    constexpr std::size_t most = 20;
    if (all.empty()) return "";
    errbound::support::table rows = {
        {"first pairs", "motion", "normal velocity", "distance at start"}};
    for (const reason& r : all.first(std::min(most, all.size())))
        rows.push_back({text_of_pair(r), std::string(name(r.motion)),
                        fixed(r.normal_velocity, "%.6g"), fixed(r.at_start.distance, "%.6g")});
    return '\n' + errbound::support::text_of(rows, 2) +
           (all.size() > most ? "and " + std::to_string(all.size() - most) + " more\n" : "");
}

nlohmann::ordered_json json_of_reasons(std::span<const reason> all) {
    auto list = nlohmann::ordered_json::array();
    for (const reason& r : all)
        list.push_back(
            {{"kind", name(r.kind)},
             {"vertices", vertices_of_reason(r)},
             {"time", {r.time.low, r.time.high}},
             {"motion", name(r.motion)},
             {"normal_velocity", or_null(r.normal_velocity, r.normal_velocity_error)},
             {"distance_at_start", or_null(r.at_start.distance, r.at_start.distance_error)}});
    return list;
}

void add_replay_option(CLI::App& line, std::optional<std::filesystem::path>& path) {
    add(line, "--replay", path,
        "Print the pairs of the first contact: how they move on, and their distance at\n"
        "the start. Write them to OUT-vf.csv and OUT-ee.csv, which ccd query reads")
        .ends_in(".csv");
}

std::vector<std::filesystem::path> replay_paths(const std::filesystem::path& path) {
    std::vector<std::filesystem::path> paths;
    for (const kind k : stored_kinds) {
        paths.push_back(path);
        paths.back().replace_filename(path.stem().string() + '-' + std::string(short_name(k)) +
                                      ".csv");
    }
    return paths;
}

std::vector<errbound::support::output> replay_files(const std::filesystem::path& path,
                                                    const vertex_rows& positions,
                                                    const pair_lists& pairs) {
    std::string texts[stored_kinds.size()];
    for_each_kind([&]<kind K>() {
        for (const auto& pair : pairs.of<K>()) {
            const auto points = points_of(query_of(positions, pair));
            lab::points four;
            for (std::size_t i = 0; i < four.size(); ++i)
                four[i] = points[std::min(i, points.size() - 1)];
            texts[K == kind::edge_edge ? 1 : 0] += lab::csv(four);
        }
    });
    static_assert(stored_kinds[1] == kind::edge_edge);
    const auto paths = replay_paths(path);
    std::vector<errbound::support::output> files;
    for (std::size_t i = 0; i < paths.size(); ++i)
        if (!texts[i].empty()) files.push_back({paths[i], std::move(texts[i])});
    return files;
}

std::string text_of_replay(const std::filesystem::path& path, const pair_lists& pairs) {
    std::string text;
    const auto paths = replay_paths(path);
    for (std::size_t i = 0; i < paths.size(); ++i) {
        const std::size_t edges = pairs.edge_edge.size();
        const bool any =
            (stored_kinds[i] == kind::edge_edge ? edges : number_of(pairs) - edges) > 0;
        text += (i == 0 ? "\nreplay: " : "; ") + paths[i].string() +
                (any ? "" : " is not written, since there is no such pair");
    }
    return text + '\n';
}

}  // namespace ccd::program
