// Data sets of a report: stored queries and scenes of two frames, found in folders, each query with
// its truth.
#pragma once

#include <ccd/mesh.hpp>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "ccd/report/measuring/query_set.hpp"

namespace ccd::report {

/// Where a data set's files are.
struct data_source {
    std::string name;                            ///< unique among those found together
    std::vector<std::filesystem::path> queries;  ///< CSV files, sorted
    std::vector<std::filesystem::path> frames;   ///< of a scene: two, and no CSV files
};

struct omission {
    std::filesystem::path path;
    std::string why;
};

struct found_data {
    std::vector<data_source> sources;
    std::vector<omission> left_out;
};

/// Looks through the folders and those within them.
///
/// Stored queries are CSV files whose path names their kind; those of one folder, and of its
/// folders edge-edge, vertex-face, ee and vf, are one data set. A folder with exactly two meshes
/// (PLY or OBJ) is a scene, the one with the shorter, then lesser name its first frame. Throws
/// errbound::support::file_error if a folder is not there.
found_data find_data(const std::vector<std::filesystem::path>& folders);

/// Queries of one kind with their truth.
template <class Query>
struct queries_with_truth {
    query_set<Query> queries;
    std::vector<unsigned char> collides;  ///< the truth of each, 0 or 1
    std::size_t colliding = 0;
    std::size_t stored_truths = 0;  ///< taken from files, or compared with them
    /// Of a scene's stored truths, those that `exact` contradicts, and collisions that they lack.
    std::size_t contradictions = 0;
};

/// Where queries come from.
enum class origin {
    scene,   ///< all candidates of a step of a mesh
    stored,  ///< files
    made,    ///< the program itself
};
std::string_view name(origin from);

/// A loaded data set. Its queries refer to its frames: it must stay where it is.
struct data_set {
    std::string name;
    std::string fingerprint;  ///< of its files' contents
    report::origin origin = origin::stored;
    mesh before, after;
    by_stored_kind<queries_with_truth> queries;

    data_set() = default;
    data_set(const data_set&) = delete;
    data_set& operator=(const data_set&) = delete;
};

/// Reads the files and finds the truth.
///
/// Stored queries: from their file (io::read_queries), where it has none by `exact`. A scene: all
/// pairs that share no vertex and whose swept boxes touch, sorted, their truth by `exact`; truth
/// stored beside it, as the scalable benchmark does (../boxes/*vf.json and *ee.json name pairs of
/// elements, ../mma_bool/NAME_mma_bool.json which of them collide, and all others do not), is
/// compared with it. Memory: some 20 bytes a query of a scene, 200 of a stored one.
/// Throws errbound::support::file_error.
std::unique_ptr<data_set> load(const data_source& source, int threads);

/// Queries that the program makes itself, the same everywhere: contacts, and their neighbours
/// within a few units in the last place; small integers, most of them degenerate.
std::vector<std::unique_ptr<data_set>> made_data(int threads);

/// The truth of all queries by `exact`, in batches.
void decide_truth(data_set& data, int threads);

}  // namespace ccd::report
