// A long run of comparisons on all cores, a sequence of blocks. Block b of a seed has the same
// questions on every machine, so that another run can continue where one stopped.
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
    };
    std::string title;  ///< heading of the rows' names
    std::vector<std::string> columns;
    bool largest = false;  ///< tables are merged by the larger counts instead of the sums
    std::vector<row> rows = {};

    /// The counts of the row of that name. Adds the row if it does not exist.
    std::vector<std::uint64_t>& operator[](std::string_view name);
};

/// A question with a wrong answer.
struct difference {
    std::string text;        ///< all that is needed to repeat it, and the answers
    std::string file = {};   ///< the file to which `lines` are appended, if there is one
    std::string lines = {};  ///< in the format of the program `ccd`
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
    /// True if the text of a difference has this fault and hexadecimal floats, for a replay.
    bool have(std::string_view fault) const;
    void stir(std::uint64_t answer) { checksum = (checksum ^ answer) * 0x100000001b3; }
};

/// The comparison that a run repeats.
struct part {
    std::string name;  ///< "symmetries"
    std::string unit;  ///< what is counted: "queries"
    /// Compares all answers of one block. Several threads call it at a time.
    std::function<findings(std::uint64_t seed, std::uint64_t block)> compare_block = {};
    /// The number of questions in the first blocks.
    std::function<std::uint64_t(std::uint64_t blocks)> count = {};

    /// The least number of blocks with at least `questions` questions.
    std::uint64_t blocks_for(std::uint64_t questions) const;
};

struct run_options {
    std::uint64_t seed = 1;
    std::uint64_t first = 0, end = 0;  ///< blocks
    unsigned threads = 0;              ///< 0: one per core
    std::filesystem::path folder = {};
};

/// Compares blocks until `end`, or until `stop` is not 0. Findings are added in the order of
/// blocks, so the result depends only on the seed and the blocks. The folder has the texts of
/// differences in differences.txt, and differing queries in the files that they name. `show` is
/// called about ten times a second, on the calling thread. Throws what the part throws, and
/// errbound::support::file_error.
findings run(const run_options& options, const part& what, const std::atomic<int>& stop,
             const std::function<void(const findings&)>& show);

}  // namespace soak
