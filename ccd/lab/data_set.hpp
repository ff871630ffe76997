// Sources of queries with their truth: stored queries, scenes of two frames, generated queries.
#pragma once

#include <algorithm>
#include <ccd/batch.hpp>
#include <ccd/contact.hpp>
#include <ccd/mesh.hpp>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ccd/lab/families.hpp"

namespace ccd::lab {

/// Queries in the order in which they are decided: `by_index` into `rows`, which are not owned, or
/// `stored`.
template <class Query>
struct query_set {
    ccd::vertex_rows rows;
    std::vector<pair_of_query<Query>> by_index;
    std::vector<Query> stored;

    std::size_t size() const { return by_index.size() + stored.size(); }
    Query operator[](std::size_t i) const {
        return by_index.empty() ? stored[i] : ccd::query_of(rows, by_index[i]);
    }
    stage_report decide_batch(std::size_t first, std::span<ccd::outcome> answers,
                              const ccd::batch_options& options) const {
        return by_index.empty()
                   ? ccd::decide_batch(std::span(stored).subspan(first, answers.size()), answers,
                                       options)
                   : ccd::decide_batch(rows, std::span(by_index).subspan(first, answers.size()),
                                       answers, options);
    }
    std::vector<timed_contact> timed_contacts(const time_options& options) const {
        return by_index.empty() ? ccd::timed_contacts(stored, options)
                                : ccd::timed_contacts(rows, by_index, options);
    }
    /// `count` queries: drawn evenly if there are more, repeated if there are fewer.
    query_set resized(std::size_t count) const {
        query_set result{.rows = rows, .by_index = {}, .stored = {}};
        const auto draw = [&](const auto& from, auto& to) {
            to.reserve(from.empty() ? 0 : count);
            for (std::size_t i = 0; i < count && !from.empty(); ++i) {
                to.push_back(from[count < from.size() ? i * from.size() / count : i % from.size()]);
            }
        };
        draw(by_index, result.by_index);
        draw(stored, result.stored);
        return result;
    }
    query_set at_most(std::size_t count) const { return size() > count ? resized(count) : *this; }
    std::vector<Query> all_stored() const {
        std::vector<Query> queries;
        queries.reserve(size());
        for (std::size_t i = 0; i < size(); ++i) queries.push_back((*this)[i]);
        return queries;
    }
};

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
    std::vector<omission> skipped;
};

/// Searches the folders recursively.
///
/// Stored queries are CSV files whose path names their kind; those of one folder, and of its
/// folders edge-edge, vertex-face, ee and vf, are one data set. A folder with exactly two meshes
/// (PLY or OBJ) is a scene; the one with the shorter, then lesser name is its first frame. Throws
/// errbound::support::file_error if a folder is missing.
found_data find_data(const std::vector<std::filesystem::path>& folders);

template <class Query>
struct queries_with_truth {
    query_set<Query> queries;
    std::vector<unsigned char> collides;  ///< the truth of each, 0 or 1
    std::size_t colliding = 0;
    std::size_t stored_truths = 0;  ///< taken from files, or compared with them
    /// The stored truths of a scene that `exact` contradicts, plus collisions that they lack.
    std::size_t contradictions = 0;
};

/// A loaded data set. Its queries refer to its frames, so it cannot be copied or moved.
struct data_set {
    std::string name;
    std::string fingerprint;  ///< of its files' contents
    /// "scene": all candidates of a step of a mesh; "stored": files; "made", "stress": generated.
    std::string_view origin = "stored";
    mesh before, after;
    by_stored_kind<queries_with_truth> queries;

    data_set() = default;
    data_set(const data_set&) = delete;
    data_set& operator=(const data_set&) = delete;

    template <class Visit>
    decltype(auto) visit(kind which, Visit&& visit) const {
        return visit_stored_kind(
            which, [&]<kind K>() -> decltype(auto) { return visit(queries.template of<K>()); });
    }
};
using loaded_data = std::unique_ptr<data_set>;

/// Loads a data set. The truth of stored queries is that of their file (io::read_queries), or by
/// `exact` if it has none. The queries of a scene are all pairs that share no vertex and whose
/// swept boxes touch, sorted, with truth by `exact`. If the scene's folder is in the layout of the
/// public benchmark, that truth is compared with the stored one: ../boxes/*vf.json and *ee.json
/// name pairs of elements, ../mma_bool/NAME_mma_bool.json which of them collide; all others do not.
/// Memory: some 20 bytes a query of a scene, 200 of a stored one. Throws
/// errbound::support::file_error.
loaded_data load(const data_source& source, int threads);

/// Generated queries, the same everywhere: contacts, and their neighbours within a few units in the
/// last place; small integers, most of them degenerate.
std::vector<loaded_data> made_data(int threads);

/// Makes `each` queries of each stored kind for each value of the knob, fewer where the family is
/// thinned.
loaded_data data_of(const family& from, std::size_t each, int threads);

}  // namespace ccd::lab
