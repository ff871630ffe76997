// The pairs that limit a step: a table, JSON, and files that replay them.
#pragma once

#include <ccd/certify.hpp>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ccd/program/command.hpp"
#include "errbound/support/output_file.hpp"

namespace ccd::program {

/// A table of at most 20 pairs; empty without pairs.
std::string text_of_reasons(std::span<const reason> all);
nlohmann::ordered_json json_of_reasons(std::span<const reason> all);

void add_replay_option(CLI::App& line, std::optional<std::filesystem::path>& path);

/// NAME-vf.csv and NAME-ee.csv for NAME.csv.
std::vector<std::filesystem::path> replay_paths(const std::filesystem::path& path);

/// Returns query files in hexadecimal floats, of the kinds that the pairs have. The face of a
/// vertex/edge or vertex/vertex pair has two or three equal corners.
std::vector<errbound::support::output> replay_files(const std::filesystem::path& path,
                                                    const vertex_rows& positions,
                                                    const pair_lists& pairs);

/// A line with the names of files that replay_files returns, and of those that it leaves out: these
/// may exist from an earlier run.
std::string text_of_replay(const std::filesystem::path& path, const pair_lists& pairs);

}  // namespace ccd::program
