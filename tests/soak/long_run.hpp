// A long run of comparisons: all cores, stopped and resumed at any time without a trace in its
// result.
//
// A run is a sequence of blocks. Block b of a seed asks the same on every machine, so that a number
// of blocks is all the state that a run has, beside what it found.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

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

/// Continues `from` until all blocks are done or `stop` is set, and saves now and then and at the
/// end. Blocks count in their order alone, so the result depends on nothing but seed and number of
/// blocks. `progress` is called about ten times a second, from the calling thread. Throws what the
/// part or save throws.
state run(state from, const run_options& options, const part& what, const std::atomic<bool>& stop,
          const std::function<void(const state&)>& progress);

/// The processes that share a run: the ranks of MPI.
struct team {
    std::size_t rank = 0, size = 1;
    /// Everybody's text, by rank, on rank 0; collective, as is share.
    std::function<std::vector<std::string>(const std::string&)> gather = {};
    /// Rank 0's text, on all.
    std::function<std::string(const std::string&)> share = {};
};

/// The same for a team, with the same result and the same state on disk, which rank 0 alone writes:
/// whatever the number of ranks, a run goes on from where another one of it stopped. In rounds of a
/// few seconds, of which each rank compares every size-th block; `stop` of rank 0 counts. Where a
/// rank dies MPI ends the others, and what was saved last stays. Throws on all ranks what a part
/// throws on one. Returns the whole run's state on rank 0, its number of blocks on the others.
state run_shared(const team& who, state from, const run_options& options, const part& what,
                 const std::atomic<bool>& stop, const std::function<void(const state&)>& progress);

}  // namespace soak
