// A long run of comparisons: all cores, stopped and resumed at any time without a trace in its
// result.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "tests/soak/comparison.hpp"

namespace soak {

struct state {
    std::uint64_t seed = 1;
    totals found = {};
    double seconds = 0;  ///< spent so far, over all sittings
    friend bool operator==(const state&, const state&) = default;
};

/// The state as JSON and back. from_json throws std::runtime_error with what is wrong: no such
/// text, or families other than this program's.
std::string to_json(const state& s);
state from_json(const std::string& text);

/// Where a run keeps its state and what it found: state.json, differences-vf.csv,
/// differences-ee.csv.
std::filesystem::path state_path(const std::filesystem::path& folder);
std::filesystem::path differences_path(const std::filesystem::path& folder,
                                       query_families::kind which);

/// Writes the state, whole or not at all, and the files of differing queries if there are any;
/// removes those of an earlier run. Throws errbound::support::file_error.
void save(const state& s, const std::filesystem::path& folder);

struct run_options {
    std::uint64_t blocks = 0;  ///< to be done in all, resumed ones included
    unsigned threads = 0;      ///< 0: one per core
    std::filesystem::path folder = {};
    double seconds_between_saves = 30;
};

/// Continues `from` until all blocks are done or `stop` is set, and saves now and then and at the
/// end. Blocks count in their order alone, so the result depends on nothing but seed and number of
/// blocks. `progress` is called about ten times a second, from the calling thread. Throws what a
/// decider or save throws.
state run(state from, const run_options& options, const decider& truth,
          std::span<const decider> deciders, const std::atomic<bool>& stop,
          const std::function<void(const state&)>& progress);

}  // namespace soak
