// Finished parts of a report, kept in files so that a stopped run goes on where it was.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace ccd::report {

using row = nlohmann::ordered_json;  ///< an object: column -> value
using rows = std::vector<row>;

/// A part: what it is called, and all that its rows depend on.
struct part_key {
    std::string name;
    nlohmann::ordered_json depends_on;
};

/// Parts in a folder, a file each. A file of another key, or one that is damaged, counts as none.
class part_store {
  public:
    /// Makes the folder if it is not there. Throws errbound::support::file_error.
    explicit part_store(std::filesystem::path folder);

    /// Whether the part is there; if so, its rows.
    bool find(const part_key& key, rows& into) const;
    /// Writes the part, whole or not at all. Throws errbound::support::file_error.
    void keep(const part_key& key, const rows& of_part) const;
    std::filesystem::path path_of(const part_key& key) const;

  private:
    std::filesystem::path folder_;
};

}  // namespace ccd::report
