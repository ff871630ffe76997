// Reads stored queries (target errbound::ccd_io): the public CCD benchmark's CSV form, decimal and
// hexadecimal-float rows, and truth next to a file. Lines and encodings: as ccd/io/mesh_file.hpp.
#pragma once

#include <ccd/kind.hpp>
#include <ccd/query.hpp>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace ccd::io {

struct query_file {
    /// An alternative for each of stored_kinds, in that order.
    std::variant<std::vector<vertex_face<double>>, std::vector<edge_edge<double>>> queries;
    std::optional<std::vector<bool>> truth;  ///< one per query

    ccd::kind kind() const { return stored_kinds[queries.index()]; }
    std::size_t size() const {
        return std::visit([](const auto& all) { return all.size(); }, queries);
    }
};

std::vector<std::string> kind_names();

/// The kind that a path names, if any: the name without extension ends in `vf` or `ee`, with no
/// letter before, or else a folder is named `vertex-face`, `edge-edge`, `vf` or `ee`.
std::optional<ccd::kind> kind_from_path(const std::filesystem::path& path);

/// Reads queries of a stored kind from text; `name` is used in messages. With `round`, a rational
/// that no double equals is rounded to nearest instead of refused. Throws
/// errbound::support::file_error if rows have another form, a number is not finite or equals no
/// double, or the last query is truncated.
query_file parse_queries(std::string_view text, const std::string& name, ccd::kind kind,
                         bool round);

/// Same as parse_queries, for text or for the bytes of a store (ccd/io/query_store.hpp). `kind`
/// must not contradict the kind of a store.
query_file parse_stored_queries(std::string_view bytes, const std::string& name,
                                std::optional<ccd::kind> kind, bool round);

/// At most `count` queries of a file, from query `first` on.
struct file_range {
    std::uint64_t first = 0;
    std::uint64_t count = (std::numeric_limits<std::uint64_t>::max)();
};

/// Reads a file, and truth from its column or from `../mma_bool/NAME_mma_bool.json` next to it.
/// Without `kind`, the path names the kind. A store (ccd/io/query_store.hpp) holds its own kind and
/// truth. Returns the queries in `range`; text is read and checked in full. Throws
/// errbound::support::file_error for bad content, or if no query is in the range.
query_file read_queries(const std::filesystem::path& path, std::optional<ccd::kind> kind,
                        bool round, file_range range = {});

/// Reads a JSON array of booleans. Throws errbound::support::file_error.
std::vector<bool> parse_truth(std::string_view text, const std::string& name);

}  // namespace ccd::io
