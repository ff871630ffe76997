// Stored queries: the public CCD benchmark's CSV form, decimal and hexadecimal-float rows, and
// truth beside a file.
#pragma once

#include <ccd/kind.hpp>
#include <ccd/query.hpp>
#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ccd::io {

/// Queries of one kind in file order. Exactly one of the two vectors is filled.
struct query_file {
    ccd::kind kind{};
    std::vector<vertex_face<double>> vertex_face_queries;
    std::vector<edge_edge<double>> edge_edge_queries;
    std::optional<std::vector<bool>> truth;  ///< one per query

    std::size_t size() const { return vertex_face_queries.size() + edge_edge_queries.size(); }
};

/// What --kind takes: "vf", "ee".
std::vector<std::string> kind_names();

/// The kind that a path names (`vertex-face`, `edge-edge`, `vf`, `ee`), if it names one.
std::optional<ccd::kind> kind_from_path(const std::filesystem::path& path);

/// Reads queries from text. `name` is used in messages. Throws file_error.
/// With `round`, a rational that no double equals is rounded to nearest instead of refused.
query_file parse_queries(std::string_view text, const std::string& name, ccd::kind kind,
                         bool round);

/// Reads a file, and truth from its column or from `../mma_bool/NAME_mma_bool.json` beside it.
/// The kind is `kind` if given, else from the path. Throws file_error.
query_file read_queries(const std::filesystem::path& path, std::optional<ccd::kind> kind,
                        bool round);

/// Reads a JSON array of booleans. `name` is used in messages. Throws file_error.
std::vector<bool> parse_truth(std::string_view text, const std::string& name);

}  // namespace ccd::io
