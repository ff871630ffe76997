// A long run of comparisons: all cores, stopped and resumed at any time without a trace in its
// result.
//
// A run is a sequence of blocks. Block b of a seed asks the same on every machine. The state of a
// run is therefore the first block, the number of blocks and what they found.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "tests/soak/findings.hpp"

namespace soak {

/// What a run repeats.
struct part {
    std::string name;  ///< "symmetries"
    std::string unit;  ///< what is counted: "queries"
    std::string version =
        {};  ///< of the questions: names of families; states of others are refused
    /// Compares all answers of one block. Called from several threads at once.
    std::function<findings(std::uint64_t seed, std::uint64_t block)> compare_block = {};
    /// How many questions that many blocks hold.
    std::function<std::uint64_t(std::uint64_t blocks)> count = {};

    /// The least number of blocks with at least so many questions.
    std::uint64_t blocks_for(std::uint64_t questions) const;
};

struct state {
    std::uint64_t seed = 1;
    std::uint64_t first = 0;  ///< the number of questions before the first block of the run
    findings found = {};
    double seconds = 0;  ///< spent so far, over all sittings
    friend bool operator==(const state&, const state&) = default;
};

/// The state as JSON and back. from_json throws std::runtime_error with what is wrong: no such
/// text, or questions other than this program's.
std::string to_json(const state& s, const part& of);
state from_json(const std::string& text, const part& of);

/// Where a run keeps its state; files of differing queries lie beside it.
std::filesystem::path state_path(const std::filesystem::path& folder);

/// Writes the state, whole or not at all, and the files of differences if there are any; removes
/// those of an earlier run. Throws errbound::support::file_error.
void save(const state& s, const part& of, const std::filesystem::path& folder);

struct run_options {
    std::uint64_t blocks = 0;  ///< to be done in all, resumed ones included
    unsigned threads = 0;      ///< 0: one per core
    std::filesystem::path folder = {};
    double seconds_between_saves = 30;
};

/// Called now and then, from the calling thread.
using progress = std::function<void(const state&)>;

/// Continues `from` until all blocks are done or `stop` is not 0, and saves now and then and at the
/// end. Blocks count in their order alone, so the result depends on nothing but seed and number of
/// blocks. `show` is called about ten times a second. Throws what the part or save throws.
state run(state from, const run_options& options, const part& what, const std::atomic<int>& stop,
          const progress& show);

}  // namespace soak
