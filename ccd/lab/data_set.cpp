#include "ccd/lab/data_set.hpp"

#include <algorithm>
#include <ccd/io/mesh_file.hpp>
#include <ccd/io/query_file.hpp>
#include <ccd/step.hpp>
#include <errbound/support/error.hpp>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "ccd/lab/generators.hpp"
#include "ccd/lab/tables.hpp"
#include "ccd/step/elements.hpp"
#include "errbound/support/output_file.hpp"

namespace ccd::lab {
namespace {

using errbound::support::file_error;
using errbound::support::read_whole;

namespace fs = std::filesystem;

bool is_mesh(const fs::path& path) {
    return path.extension() == ".ply" || path.extension() == ".obj";
}

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

/// Adds the source. Its name becomes the folder's whole path if another source has the same name.
void add(data_source source, const fs::path& folder, found_data& found) {
    const auto same = [&source](const data_source& other) { return other.name == source.name; };
    if (std::ranges::any_of(found.sources, same)) source.name = folder.generic_string();
    found.sources.push_back(std::move(source));
}

void add_files_below(const fs::path& folder, std::set<fs::path>& files) {
    if (!fs::is_directory(folder))
        throw file_error(folder.string() + ": folder does not exist; expected one of data");
    const auto options = fs::directory_options::skip_permission_denied;
    for (auto entry = fs::recursive_directory_iterator(fs::canonical(folder), options);
         entry != fs::recursive_directory_iterator(); ++entry) {
        if (entry->is_regular_file()) files.insert(entry->path());
    }
}

template <class Query>
void decide_by_exact(queries_with_truth<Query>& into, int threads) {
    std::vector<outcome> answers(into.queries.size());
    into.queries.decide_batch(0, answers, {.threads = threads});
    into.collides.resize(answers.size());
    std::ranges::transform(answers, into.collides.begin(), [](outcome answer) {
        return static_cast<unsigned char>(answer == outcome::collides);
    });
    into.colliding = static_cast<std::size_t>(std::ranges::count(into.collides, 1));
}

void decide_truth(data_set& data, int threads) {
    data.queries.for_each([threads](auto& known) { decide_by_exact(known, threads); });
}

std::optional<fs::path> stored_pairs(const fs::path& frame, const std::string& ending) {
    const fs::path folder = frame.parent_path().parent_path() / "boxes";
    std::optional<fs::path> found;
    if (!fs::is_directory(folder)) return found;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (!entry.path().filename().string().ends_with(ending)) continue;
        if (found)
            throw file_error(folder.string() + ": number of files *" + ending +
                             " is more than 1; expected that of the frames next to it");
        found = entry.path();
    }
    return found;
}

std::vector<std::array<std::size_t, 2>> read_pairs(const fs::path& path) {
    try {
        return row::parse(read_whole(path)).get<std::vector<std::array<std::size_t, 2>>>();
    } catch (const nlohmann::json::exception& error) {
        throw file_error(path.string() + ": content is no list (" + error.what() +
                         "); expected a JSON array of pairs of elements");
    }
}

/// Vertices first, then edges in the order of their greater, then lesser vertex, then faces.
class numbered_elements {
  public:
    explicit numbered_elements(const mesh& m)
        : vertices_(m.vertices.size()), edges_(unique_edges(m.faces, m.edges)), faces_(m.faces) {
        std::ranges::sort(edges_, {}, [](const edge& e) { return std::tuple(e[1], e[0]); });
    }

    /// Nothing if an index is out of range.
    template <class Pair>
    std::optional<Pair> pair(std::size_t i, std::size_t j) const {
        if constexpr (kind_of<Pair> == kind::vertex_face) {
            const std::size_t first = vertices_ + edges_.size();
            if (i >= vertices_ || j < first || j - first >= faces_.size()) return std::nullopt;
            const face& f = faces_[j - first];
            return Pair{static_cast<vertex_index>(i), f[0], f[1], f[2]};
        } else {
            if (std::min(i, j) < vertices_ || std::max(i, j) - vertices_ >= edges_.size())
                return std::nullopt;
            return detail::candidate_of(edges_[i - vertices_], edges_[j - vertices_]);
        }
    }

  private:
    std::size_t vertices_;
    std::vector<edge> edges_;
    const std::vector<face>& faces_;
};

/// Compares stored truth, if any, with that of `exact`. Appends the files' bytes to `contents`.
template <class Query>
void compare_stored(const fs::path& frame, const numbered_elements& elements,
                    queries_with_truth<Query>& known, std::string& contents) {
    const auto path = stored_pairs(frame, std::string(short_name(kind_of<Query>)) + ".json");
    if (!path) return;
    const fs::path truth_path =
        path->parent_path().parent_path() / "mma_bool" / (path->stem().string() + "_mma_bool.json");
    const auto pairs = read_pairs(*path);
    const std::vector<bool> truth = io::parse_truth(read_whole(truth_path), truth_path.string());
    if (truth.size() != pairs.size())
        throw file_error(truth_path.string() + ": number of truth values is " +
                         std::to_string(truth.size()) + "; expected " +
                         std::to_string(pairs.size()) + ", one for each pair of " + path->string());
    contents += read_whole(*path) + read_whole(truth_path);

    std::map<pair_of_query<Query>, bool> stored;  // a pair may be in the file twice
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const auto pair = elements.pair<pair_of_query<Query>>(pairs[i][0], pairs[i][1]);
        if (!pair)
            throw file_error(path->string() + ": index in element " + std::to_string(i) +
                             " is out of range; expected indices of the frames' elements");
        stored[detail::canonical(*pair)] = truth[i];
    }
    known.stored_truths = pairs.size();
    for (std::size_t i = 0; i < known.queries.by_index.size(); ++i) {
        const auto entry = stored.find(detail::canonical(known.queries.by_index[i]));
        const bool expected = entry != stored.end() && entry->second;
        known.contradictions += expected != (known.collides[i] != 0);
        if (entry != stored.end()) stored.erase(entry);
    }
    // Stored pairs that are no candidates cannot collide: their swept boxes are apart.
    known.contradictions += static_cast<std::size_t>(
        std::ranges::count_if(stored, [](const auto& left) { return left.second; }));
}

void load_scene(const data_source& source, int threads, data_set& into, std::string& contents) {
    into.origin = "scene";
    into.before = io::read_mesh(source.frames[0]);
    into.after = io::read_mesh(source.frames[1]);
    io::require_same_topology(into.before, source.frames[0].string(), into.after,
                              source.frames[1].string());
    for (const fs::path& path : source.frames) contents += read_whole(path);
    pair_lists found = candidates(into.before, into.after, {.threads = threads});
    into.queries.vertex_face.queries.by_index = std::move(found.vertex_face);
    into.queries.edge_edge.queries.by_index = std::move(found.edge_edge);
    into.queries.for_each(
        [rows = vertex_rows(into.before, into.after)](auto& known) { known.queries.rows = rows; });
    decide_truth(into, threads);
    const numbered_elements elements(into.before);
    into.queries.for_each(
        [&](auto& known) { compare_stored(source.frames[0], elements, known, contents); });
}

/// One truth per query; -1 if none is stored.
template <class Query>
using truth_bytes = std::vector<signed char>;

void load_queries(const data_source& source, int threads, data_set& into, std::string& contents) {
    by_stored_kind<truth_bytes> truths;
    for (const fs::path& path : source.queries) {
        const io::query_file file = io::read_queries(path, std::nullopt, false);
        contents += read_whole(path);
        std::visit(
            [&]<class Query>(const std::vector<Query>& queries) {
                auto& all = into.queries.of<kind_of<Query>>().queries.stored;
                all.insert(all.end(), queries.begin(), queries.end());
                for (std::size_t i = 0; i < queries.size(); ++i)
                    truths.of<kind_of<Query>>().push_back(
                        file.truth ? static_cast<signed char>((*file.truth)[i]) : -1);
            },
            file.queries);
    }
    decide_truth(into, threads);
    into.queries.for_each([&]<class Query>(queries_with_truth<Query>& known) {
        const std::vector<signed char>& stored = truths.of<kind_of<Query>>();
        for (std::size_t i = 0; i < stored.size(); ++i) {
            if (stored[i] < 0) continue;
            known.collides[i] = static_cast<unsigned char>(stored[i]);
            ++known.stored_truths;
        }
        known.colliding = static_cast<std::size_t>(std::ranges::count(known.collides, 1));
        // Truth that lies next to a file counts as its content.
        contents.append(known.collides.begin(), known.collides.end());
    });
}

template <class Make>
loaded_data generated(std::string_view name, std::string_view origin, std::size_t count,
                      int threads, const Make& make) {
    auto data = std::make_unique<data_set>();
    data->name = name;
    data->origin = origin;
    data->fingerprint = fingerprint_of(name);  // the program's fingerprint covers the generator
    data->queries.for_each([&]<class Query>(queries_with_truth<Query>& into) {
        for (std::uint64_t i = 0; i < count; ++i)
            into.queries.stored.push_back(as_query<Query>(make(i, kind_of<Query>)));
    });
    decide_truth(*data, threads);
    return data;
}

struct recipe {
    std::string_view name;
    points (*make)(source& random, kind which);
};
constexpr recipe recipes[] = {
    {"near contact",
     [](source& random, kind which) {
         return generators::jitter(random, generators::near_contact(random, which, 1), 3);
     }},
    {"small integers", [](source& random, kind) { return generators::grid(random, 1); }},
};

}  // namespace

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
            found.skipped.push_back({file, "its path names no kind of query"});
        }
    }
    for (auto& [folder, frames] : meshes) {
        if (frames.size() != 2) {
            found.skipped.push_back(
                {folder,
                 "number of meshes is " + std::to_string(frames.size()) + "; expected two frames"});
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

loaded_data load(const data_source& source, int threads) {
    auto data = std::make_unique<data_set>();
    data->name = source.name;
    std::string contents;
    if (source.frames.empty())
        load_queries(source, threads, *data, contents);
    else
        load_scene(source, threads, *data, contents);
    data->fingerprint = fingerprint_of(contents);
    return data;
}

std::vector<loaded_data> made_data(int threads) {
    std::vector<loaded_data> all;
    for (const recipe& r : recipes)
        all.push_back(generated(r.name, "made", 5000, threads, [&r](std::uint64_t i, kind which) {
            source random = source_of(r.name, {std::uint64_t(which), i});
            return r.make(random, which);
        }));
    return all;
}

loaded_data data_of(const family& from, std::size_t each, int threads) {
    std::vector<std::pair<double, std::uint64_t>> all;  // knob, index
    for (const double knob : from.knobs)
        for (std::uint64_t i = 0; i * from.thinning(knob) < each; ++i) all.emplace_back(knob, i);
    return generated(from.name, "stress", all.size(), threads, [&](std::uint64_t i, kind which) {
        return make(from, all[i].first, which, /*seed*/ 1, all[i].second);
    });
}

}  // namespace ccd::lab
