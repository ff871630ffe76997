#include "ccd/report/data_set.hpp"

#include <algorithm>
#include <errbound/support/error.hpp>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <tuple>

#include "ccd/batch/threads.hpp"
#include "ccd/io/mesh_file.hpp"
#include "ccd/io/query_file.hpp"
#include "ccd/report/machine.hpp"
#include "ccd/step/broad_phase.hpp"
#include "ccd/step/step_frames.hpp"
#include "errbound/support/output_file.hpp"

namespace ccd::report {
namespace {

using errbound::support::file_error;
using errbound::support::read_whole;

namespace fs = std::filesystem;

// ---- Finding ----

bool is_mesh(const fs::path& path) {
    return path.extension() == ".ply" || path.extension() == ".obj";
}

/// A folder that only tells what is in it: the one above has the name.
bool is_kind_of_content(const fs::path& folder) {
    return find_kind(folder.filename().string()).has_value();
}

std::string name_of_queries(const fs::path& folder) {
    if (folder.filename() == "queries" && folder.has_parent_path())
        return folder.parent_path().filename().string() + " queries";
    return folder.filename().string();
}

std::string name_of_scene(const fs::path& folder) {
    return (folder.filename() == "frames" ? folder.parent_path() : folder).filename().string();
}

/// Adds the source, under its folder's whole path if another one has its name.
void add(data_source source, const fs::path& folder, found_data& found) {
    const auto same = [&source](const data_source& other) { return other.name == source.name; };
    if (std::ranges::any_of(found.sources, same)) source.name = folder.generic_string();
    found.sources.push_back(std::move(source));
}

/// Adds all regular files below the folder, by absolute path.
void add_files_below(const fs::path& folder, std::set<fs::path>& files) {
    if (!fs::is_directory(folder))
        throw file_error(folder.string() + ": found no such folder, expected one of data");
    const auto options = fs::directory_options::skip_permission_denied;
    for (auto entry = fs::recursive_directory_iterator(fs::canonical(folder), options);
         entry != fs::recursive_directory_iterator(); ++entry) {
        if (entry->is_regular_file()) files.insert(entry->path());
    }
}

// ---- Truth ----

template <class Query>
void count_colliding(judged_queries<Query>& into) {
    into.colliding =
        static_cast<std::size_t>(std::count(into.collides.begin(), into.collides.end(), 1));
}

template <class Query>
void decide_by_exact(judged_queries<Query>& into, int threads) {
    std::vector<outcome> answers(into.queries.size());
    into.queries.decide_batch(0, answers, {.threads = threads});
    into.collides.resize(answers.size());
    std::ranges::transform(answers, into.collides.begin(), [](outcome said) {
        return static_cast<unsigned char>(said == outcome::collides);
    });
    count_colliding(into);
}

/// Appends a file's queries; their truth where it has one, else -1.
template <class Query>
void append(const std::vector<Query>& queries, const std::optional<std::vector<bool>>& truth,
            judged_queries<Query>& into, std::vector<signed char>& truths) {
    into.queries.stored.insert(into.queries.stored.end(), queries.begin(), queries.end());
    for (std::size_t i = 0; i < queries.size(); ++i) {
        truths.push_back(truth ? static_cast<signed char>((*truth)[i]) : -1);
    }
}

template <class Query>
void settle_truth(const std::vector<signed char>& truths, judged_queries<Query>& into,
                  int threads) {
    decide_by_exact(into, threads);
    for (std::size_t i = 0; i < truths.size(); ++i) {
        if (truths[i] < 0) continue;
        into.collides[i] = static_cast<unsigned char>(truths[i]);
        ++into.stored_truths;
    }
    count_colliding(into);
}

// ---- Scenes ----

/// A pair's vertices, those of one element in ascending order: the same for every way to write it.
std::array<index, 4> key(const vertex_face_pair& q) {
    std::array<index, 4> k{q.v, q.f0, q.f1, q.f2};
    std::sort(k.begin() + 1, k.end());
    return k;
}
std::array<index, 4> key(const edge_edge_pair& q) {
    edge a{q.a0, q.a1}, b{q.b0, q.b1};
    std::ranges::sort(a);
    std::ranges::sort(b);
    if (b < a) std::swap(a, b);
    return {a[0], a[1], b[0], b[1]};
}

/// Collects the blocks that a broad phase hands out from its threads, sorted.
template <class Pair, class Find>
std::vector<Pair> collected(const Find& find) {
    std::vector<Pair> all;
    std::mutex mutex;
    find([&](std::span<const Pair> block) {
        const std::lock_guard lock(mutex);
        all.insert(all.end(), block.begin(), block.end());
    });
    std::ranges::sort(all, {}, [](const Pair& q) { return vertices_of(q); });
    return all;
}

void find_candidates(data_set& data, int threads) {
    const step_frames frames(data.before, data.after);
    const std::vector<face>& faces = data.before.faces;
    detail::on_threads(threads, [&] {
        data.vertex_face_queries.queries.by_index =
            collected<vertex_face_pair>([&](const auto& consume) {
                vertex_face_candidates(frames, faces, data.before.vertices.size(), consume);
            });
        data.edge_edge_queries.queries.by_index =
            collected<edge_edge_pair>([&](const auto& consume) {
                edge_edge_candidates(frames, unique_edges(faces), consume);
            });
    });
    data.vertex_face_queries.queries.rows = data.edge_edge_queries.queries.rows =
        vertex_rows(data.before, data.after);
}

/// The one file of ../boxes beside a scene's frames whose name ends so, if there is one.
std::optional<fs::path> stored_pairs(const fs::path& frame, const std::string& ending) {
    const fs::path folder = frame.parent_path().parent_path() / "boxes";
    std::optional<fs::path> found;
    if (!fs::is_directory(folder)) return found;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (!entry.path().filename().string().ends_with(ending)) continue;
        if (found)
            throw file_error(folder.string() + ": found several files *" + ending +
                             ", expected the one of the frames beside it");
        found = entry.path();
    }
    return found;
}

/// Pairs of a file, a JSON array of [i, j]: elements by number, vertices first, then edges in the
/// order of their greater, then lesser vertex, then faces.
std::vector<std::array<std::size_t, 2>> read_pairs(const fs::path& path) {
    try {
        return nlohmann::json::parse(read_whole(path))
            .get<std::vector<std::array<std::size_t, 2>>>();
    } catch (const nlohmann::json::exception& error) {
        throw file_error(path.string() + ": found " + error.what() +
                         ", expected a JSON array of pairs of elements");
    }
}

/// Compares the truth that is stored beside a scene, if any, with that of `exact`. `pair_of` makes
/// indices of two element numbers, or nothing if they are out of range.
template <class Query, class PairOf>
void compare_stored(const fs::path& frame, const std::string& ending, const PairOf& pair_of,
                    judged_queries<Query>& judged, std::string& contents) {
    const std::optional<fs::path> path = stored_pairs(frame, ending);
    if (!path) return;
    const fs::path truth_path =
        path->parent_path().parent_path() / "mma_bool" / (path->stem().string() + "_mma_bool.json");
    const auto pairs = read_pairs(*path);
    const std::vector<bool> truth = io::parse_truth(read_whole(truth_path), truth_path.string());
    if (truth.size() != pairs.size())
        throw file_error(truth_path.string() + ": found " + std::to_string(truth.size()) +
                         " truth values, expected " + std::to_string(pairs.size()) +
                         ", one per pair of " + path->string());
    contents += read_whole(*path) + read_whole(truth_path);

    std::map<std::array<index, 4>, bool> stored;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const auto pair = pair_of(pairs[i][0], pairs[i][1]);
        if (!pair)
            throw file_error(path->string() + ": element " + std::to_string(i) +
                             ": found a number out of range, expected one of the frames'");
        stored[key(*pair)] = truth[i];
    }
    judged.stored_truths = pairs.size();
    for (std::size_t i = 0; i < judged.queries.by_index.size(); ++i) {
        const auto entry = stored.find(key(judged.queries.by_index[i]));
        const bool expected = entry != stored.end() && entry->second;
        judged.contradictions += expected != (judged.collides[i] != 0);
        if (entry != stored.end()) stored.erase(entry);
    }
    // Pairs that are no candidates cannot collide: their swept boxes are apart.
    judged.contradictions += static_cast<std::size_t>(
        std::ranges::count_if(stored, [](const auto& left) { return left.second; }));
}

void compare_stored(const fs::path& frame, data_set& data, std::string& contents) {
    const std::size_t vertices = data.before.vertices.size();
    std::vector<edge> edges = unique_edges(data.before.faces);
    std::ranges::sort(edges, {}, [](const edge& e) { return std::tuple(e[1], e[0]); });
    const std::vector<face>& faces = data.before.faces;
    compare_stored(
        frame, "vf.json",
        [&](std::size_t i, std::size_t j) -> std::optional<vertex_face_pair> {
            const std::size_t first = vertices + edges.size();
            if (i >= vertices || j < first || j - first >= faces.size()) return std::nullopt;
            const face& f = faces[j - first];
            return vertex_face_pair{static_cast<index>(i), f[0], f[1], f[2]};
        },
        data.vertex_face_queries, contents);
    compare_stored(
        frame, "ee.json",
        [&](std::size_t i, std::size_t j) -> std::optional<edge_edge_pair> {
            if (std::min(i, j) < vertices || std::max(i, j) - vertices >= edges.size())
                return std::nullopt;
            const edge &a = edges[i - vertices], &b = edges[j - vertices];
            return edge_edge_pair{a[0], a[1], b[0], b[1]};
        },
        data.edge_edge_queries, contents);
}

}  // namespace

std::string_view name(origin from) {
    switch (from) {
        case origin::scene:
            return "scene";
        case origin::stored:
            return "stored";
        case origin::made:
            return "made";
    }
    return {};
}

void decide_truth(data_set& data, int threads) {
    decide_by_exact(data.vertex_face_queries, threads);
    decide_by_exact(data.edge_edge_queries, threads);
}

found_data find_data(const std::vector<fs::path>& folders) {
    std::set<fs::path> files;
    for (const fs::path& folder : folders) add_files_below(folder, files);

    found_data found;
    std::map<fs::path, std::vector<fs::path>> queries, meshes;  // by the folder that names them
    for (const fs::path& file : files) {
        const fs::path folder = file.parent_path();
        if (is_mesh(file)) meshes[folder].push_back(file);
        if (file.extension() != ".csv") continue;
        if (io::kind_from_path(file)) {
            queries[is_kind_of_content(folder) ? folder.parent_path() : folder].push_back(file);
        } else {
            found.left_out.push_back({file, "its path names no kind of query"});
        }
    }
    for (auto& [folder, frames] : meshes) {
        if (frames.size() != 2) {
            found.left_out.push_back({folder, "found " + std::to_string(frames.size()) +
                                                  " meshes there, expected two frames"});
            continue;
        }
        std::ranges::sort(frames, {}, [](const fs::path& frame) {
            return std::tuple(frame.stem().string().size(), frame);
        });
        add({.name = name_of_scene(folder), .queries = {}, .frames = frames}, folder, found);
    }
    for (const auto& [folder, paths] : queries) {
        add({.name = name_of_queries(folder), .queries = paths, .frames = {}}, folder, found);
    }
    return found;
}

std::unique_ptr<data_set> load(const data_source& source, int threads) {
    auto data = std::make_unique<data_set>();
    data->name = source.name;
    std::string contents;
    if (!source.frames.empty()) {
        data->origin = origin::scene;
        data->before = io::read_mesh(source.frames[0]);
        data->after = io::read_mesh(source.frames[1]);
        io::require_same_topology(data->before, source.frames[0].string(), data->after,
                                  source.frames[1].string());
        for (const fs::path& path : source.frames) contents += read_whole(path);
        find_candidates(*data, threads);
        decide_truth(*data, threads);
        compare_stored(source.frames[0], *data, contents);
    } else {
        std::vector<signed char> vertex_face_truths, edge_edge_truths;
        for (const fs::path& path : source.queries) {
            const io::query_file file = io::read_queries(path, std::nullopt, false);
            contents += read_whole(path);
            if (file.kind == kind::vertex_face) {
                append(file.vertex_face_queries, file.truth, data->vertex_face_queries,
                       vertex_face_truths);
            } else {
                append(file.edge_edge_queries, file.truth, data->edge_edge_queries,
                       edge_edge_truths);
            }
        }
        settle_truth(vertex_face_truths, data->vertex_face_queries, threads);
        settle_truth(edge_edge_truths, data->edge_edge_queries, threads);
        // Truth that lies beside a file counts as its content.
        contents.append(data->vertex_face_queries.collides.begin(),
                        data->vertex_face_queries.collides.end());
        contents.append(data->edge_edge_queries.collides.begin(),
                        data->edge_edge_queries.collides.end());
    }
    data->fingerprint = fingerprint_of(contents);
    return data;
}

}  // namespace ccd::report
