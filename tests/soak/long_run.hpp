// A long run of comparisons on all cores. It can be stopped and resumed at any time without an
// effect on its result.
//
// A run is a sequence of blocks. Block b of a seed has the same questions on every machine. The
// state of a run is therefore the seed, the number of questions before its first block, and the
// findings.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace soak {

/// Counts under two names. Rows and columns stay in the order in which they were added.
struct count_table {
    struct row {
        std::string name;
        std::vector<std::uint64_t> counts;  ///< one for each column
        friend bool operator==(const row&, const row&) = default;
    };
    std::string title;  ///< heading of the rows' names
    std::vector<std::string> columns;
    bool largest = false;  ///< tables are merged by the larger counts instead of the sums
    std::vector<row> rows = {};

    /// The counts of the row of that name. Adds the row if it does not exist.
    std::vector<std::uint64_t>& operator[](std::string_view name);
    friend bool operator==(const count_table&, const count_table&) = default;
};

/// A question with a wrong answer.
struct difference {
    std::string text;        ///< all that is needed to repeat it, and the answers
    std::string file = {};   ///< the file to which `lines` are appended, if there is one
    std::string lines = {};  ///< in the format of the program `ccd`
    friend bool operator==(const difference&, const difference&) = default;
};

struct findings {
    /// Only the first differences are kept; all are counted.
    static constexpr std::size_t max_kept = 10000;

    std::uint64_t blocks = 0;
    std::vector<count_table> tables = {};
    std::uint64_t different = 0;  ///< questions with a wrong answer
    std::vector<difference> differences = {};
    std::uint64_t checksum = 0xcbf29ce484222325;  ///< of right answers, in their order (FNV-1a)

    void add(const findings& next);
    /// The table of that title; throws std::out_of_range if there is none.
    const count_table& table(std::string_view title) const;
    count_table& table(std::string_view title);
    /// Counts the difference and keeps it if there is room.
    void differ(difference d);
    void stir(std::uint64_t answer) { checksum = (checksum ^ answer) * 0x100000001b3; }

    friend bool operator==(const findings&, const findings&) = default;
};

/// The comparison that a run repeats.
struct part {
    std::string name;  ///< "symmetries"
    std::string unit;  ///< what is counted: "queries"
    /// version of the questions, such as names of families; states of other versions are rejected
    std::string version = {};
    /// Compares all answers of one block. Several threads call it at a time.
    std::function<findings(std::uint64_t seed, std::uint64_t block)> compare_block = {};
    /// The number of questions in the first blocks.
    std::function<std::uint64_t(std::uint64_t blocks)> count = {};

    /// The least number of blocks with at least `questions` questions.
    std::uint64_t blocks_for(std::uint64_t questions) const;
};

struct state {
    std::uint64_t seed = 1;
    std::uint64_t first = 0;  ///< the number of questions before the first block of the run
    findings found = {};
    double seconds = 0;  ///< total over all sittings
    friend bool operator==(const state&, const state&) = default;
};

/// Convert the state to JSON and back. from_json throws std::runtime_error if the text is not a
/// state, or is one of other questions.
std::string to_json(const state& s, const part& of);
state from_json(const std::string& text, const part& of);

/// The file of a run's state; files of differing queries lie next to it.
std::filesystem::path state_path(const std::filesystem::path& folder);

/// Writes the state atomically, and the files of differences if there are any; removes those of an
/// earlier run. Throws errbound::support::file_error.
void save(const state& s, const part& of, const std::filesystem::path& folder);

struct run_options {
    std::uint64_t blocks = 0;  ///< total, including resumed ones
    unsigned threads = 0;      ///< 0: one per core
    std::filesystem::path folder = {};
    double seconds_between_saves = 30;
};

/// Continues `from` until all blocks are done or `stop` is not 0; saves periodically and at the
/// end. Findings are added in the order of blocks, so the result depends only on the seed and the
/// number of blocks. `show` is called about ten times a second, on the calling thread. Throws what
/// the part or save throws.
state run(state from, const run_options& options, const part& what, const std::atomic<int>& stop,
          const std::function<void(const state&)>& show);

}  // namespace soak
