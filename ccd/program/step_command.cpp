// `ccd step`: one step of a mesh, from files to colliding pairs.
#include <sys/resource.h>

#include <algorithm>
#include <ccd/step.hpp>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "ccd/io/mesh_file.hpp"
#include "ccd/program/commands.hpp"
#include "errbound/support/output_file.hpp"
#include "errbound/support/table.hpp"

namespace ccd::program {
namespace {

std::size_t peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
    return static_cast<std::size_t>(usage.ru_maxrss);
#else
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // Linux and the BSDs count KiB
#endif
}

std::string lines_of_pairs(const step_result& result) {
    std::string lines;
    const auto add = [&lines](std::string_view kind, const std::initializer_list<index>& indices) {
        lines += kind;
        for (const index i : indices) lines += ',' + std::to_string(i);
        lines += '\n';
    };
    for (const vertex_face_pair& p : result.vertex_face)
        add(short_name(kind::vertex_face), {p.v, p.f0, p.f1, p.f2});
    for (const edge_edge_pair& p : result.edge_edge)
        add(short_name(kind::edge_edge), {p.a0, p.a1, p.b0, p.b1});
    return lines;
}

std::string json_of(const step_arguments& arguments, const step_result& result, double read,
                    std::size_t memory) {
    nlohmann::ordered_json document = {
        {"method", info(arguments.method).name},
        {"candidates",
         {{"vertex_face", result.vertex_face_candidates},
          {"edge_edge", result.edge_edge_candidates}}},
        {"collisions",
         {{"vertex_face", result.vertex_face.size()}, {"edge_edge", result.edge_edge.size()}}},
        {"seconds",
         {{"read", read},
          {"prepare", result.prepare_seconds},
          {"broad", result.broad_phase_seconds},
          {"narrow", result.narrow_phase_seconds},
          {"sort", result.sort_seconds},
          {"total", result.total_seconds}}},
        {"threads", result.threads},
        {"peak_memory_bytes", memory}};
    if (arguments.explain) {
        document["stages"] = nlohmann::ordered_json::array();
        for (std::size_t i = 0; i < stage_count; ++i) {
            const stage_report::entry& entry = result.stages.stages[i];
            document["stages"].push_back({{"stage", info(static_cast<stage>(i)).name},
                                          {"entered", entry.entered},
                                          {"left_out", entry.left_out},
                                          {"separate", entry.separate},
                                          {"collides", entry.collides},
                                          {"seconds", entry.seconds}});
        }
    }
    return document.dump(2) + '\n';
}

std::string fixed(double value, const char* format) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

/// What the boxes left out, and what it cost to see it.
std::string text_of_boxes(std::size_t vertices, std::size_t faces, std::size_t edges,
                          const step_result& result) {
    const auto row = [](const char* kind, double possible, std::size_t candidates) {
        return std::vector<std::string>{kind, fixed(possible, "%.0f"),
                                        fixed(possible - static_cast<double>(candidates), "%.0f"),
                                        std::to_string(candidates)};
    };
    const auto v = static_cast<double>(vertices), f = static_cast<double>(faces),
               e = static_cast<double>(edges);
    const table rows = {{"pairs", "of the mesh", "apart", "candidates"},
                        row("vertex-face", v * f, result.vertex_face_candidates),
                        row("edge-edge", e * (e - 1) / 2, result.edge_edge_candidates)};
    return text_of(rows, 1) + "apart: swept boxes do not touch, or a vertex is shared; found in " +
           fixed(1e3 * result.broad_phase_seconds, "%.2f ms") + " by a tree of boxes\n";
}

/// What each stage settled, at what cost, and why some queries passed it by.
std::string text_of_stages(const step_result& result) {
    table rows = {{"stage", "queries", "skipped", "separate", "collide", "left open", "thread ms",
                   "ns/query"}};
    std::string notes;
    double seconds = 0;
    for (std::size_t i = 0; i < stage_count; ++i) {
        const stage_info& stage = info(static_cast<ccd::stage>(i));
        const stage_report::entry& entry = result.stages.stages[i];
        rows.push_back(
            {std::string(stage.name), std::to_string(entry.entered), std::to_string(entry.left_out),
             std::to_string(entry.separate), std::to_string(entry.collides),
             std::to_string(entry.entered - entry.separate - entry.collides),
             fixed(1e3 * entry.seconds, "%.2f"),
             entry.entered == 0
                 ? "-"
                 : fixed(1e9 * entry.seconds / static_cast<double>(entry.entered), "%.1f")});
        notes += std::string(stage.name) + ": " + std::string(stage.how) + '\n';
        if (entry.left_out > 0)
            notes += "    skipped where it settled fewer than a quarter of the queries before\n";
        seconds += entry.seconds;
    }
    const double rest = result.narrow_phase_seconds * result.threads - seconds;
    return text_of(rows, 1) + "thread ms: of all threads together; reading positions and moving " +
           "queries from stage to stage took " + fixed(1e3 * std::max(rest, 0.0), "%.2f") +
           "\n\nY is zero where the four points are coplanar; no G_i is negative where that "
           "happens\n"
           "within both features. Queries left open, and skipped ones, go on to the next stage.\n" +
           notes;
}

std::string text_of_step(const step_arguments& arguments, const mesh& before,
                         const step_result& result, double read, std::size_t memory) {
    const table pairs = {{std::string(info(arguments.method).name), "candidates", "collisions"},
                         {"vertex-face", std::to_string(result.vertex_face_candidates),
                          std::to_string(result.vertex_face.size())},
                         {"edge-edge", std::to_string(result.edge_edge_candidates),
                          std::to_string(result.edge_edge.size())}};
    const table costs = {
        {"read", "prepare", "broad phase", "narrow phase", "sort", "threads", "peak memory"},
        {fixed(1e3 * read, "%.1f ms"), fixed(1e3 * result.prepare_seconds, "%.1f ms"),
         fixed(1e3 * result.broad_phase_seconds, "%.1f ms"),
         fixed(1e3 * result.narrow_phase_seconds, "%.1f ms"),
         fixed(1e3 * result.sort_seconds, "%.1f ms"), std::to_string(result.threads),
         fixed(static_cast<double>(memory) / (1 << 20), "%.1f MiB")}};
    return text_of(pairs, 1) + '\n' + text_of(costs, 0) +
           (arguments.explain ? '\n' +
                                    text_of_boxes(before.vertices.size(), before.faces.size(),
                                                  unique_edges(before.faces).size(), result) +
                                    '\n' + text_of_stages(result)
                              : "");
}

}  // namespace

void run_step(const step_arguments& arguments) {
    const auto start = std::chrono::steady_clock::now();
    const mesh before = io::read_mesh(arguments.before);
    const mesh after = io::read_mesh(arguments.after);
    io::require_same_topology(before, arguments.before.string(), after, arguments.after.string());
    const double read =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

    const step_result result =
        arguments.device.cuda
            ? step_on_device(before, after, arguments.method, arguments.device.precision)
            : step(before, after,
                   {.method = arguments.method,
                    .threads = arguments.threads,
                    .set = arguments.set,
                    .explain = arguments.explain});
    const std::size_t memory = peak_memory_bytes();
    if (arguments.pairs) io::write_whole(*arguments.pairs, lines_of_pairs(result));
    if (arguments.json) {
        io::write_whole(*arguments.json, json_of(arguments, result, read, memory));
    }
    std::cout << text_of_step(arguments, before, result, read, memory);
}

}  // namespace ccd::program
