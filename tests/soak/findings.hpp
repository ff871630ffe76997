// What a soak has found so far: counts by name, differences, and a checksum of all right answers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace soak {

/// Counts under two names. Rows and columns stay in the order in which they were added.
struct count_table {
    struct row {
        std::string name;
        std::vector<std::uint64_t> counts;  ///< one for each column
        friend bool operator==(const row&, const row&) = default;
    };
    std::string title;  ///< over the rows' names
    std::vector<std::string> columns;
    std::vector<row> rows = {};

    /// The counts of the row of that name, which is added if there is none.
    std::vector<std::uint64_t>& operator[](std::string_view name);
    friend bool operator==(const count_table&, const count_table&) = default;
};

/// A question with a wrong answer.
struct difference {
    std::string text;        ///< all that is needed to ask again, and who said what
    std::string file = {};   ///< the name of the file to which `lines` are added, if there is one
    std::string lines = {};  ///< as the program `ccd` reads them
    friend bool operator==(const difference&, const difference&) = default;
};

struct findings {
    /// So many differences are kept; those beyond are only counted.
    static constexpr std::size_t max_kept = 10000;

    std::uint64_t blocks = 0;
    std::vector<count_table> tables = {};
    std::uint64_t different = 0;  ///< questions with a wrong answer
    std::vector<difference> differences = {};
    std::uint64_t checksum = 0xcbf29ce484222325;  ///< of right answers, in their order (FNV-1a)

    /// What the blocks that follow have found.
    void add(const findings& next);
    /// The table of that title; throws std::out_of_range if there is none.
    const count_table& table(std::string_view title) const;
    count_table& table(std::string_view title);
    /// Counts the difference and keeps it if there is room.
    void differ(difference d);
    /// Stirs an answer into the checksum.
    void stir(std::uint64_t answer) { checksum = (checksum ^ answer) * 0x100000001b3; }

    friend bool operator==(const findings&, const findings&) = default;
};

/// Findings of blocks, added up in the blocks' order as they come in.
class collector {
  public:
    explicit collector(findings from) : sum_(std::move(from)) {}

    void add(std::uint64_t block, findings found);
    /// Of all blocks before the first that is missing.
    const findings& sum() const { return sum_; }

  private:
    findings sum_;
    std::map<std::uint64_t, findings> waiting_;
};

}  // namespace soak
