// Reads the table of results of the proofs' definitions, proofs/tie.txt, and compares results with
// it. The programs proofs/tie/tie_*.ml print hashes of each operation, and the table has one for
// each group of operations (proofs/ties.py). Tests enumerate the same cases in the same order.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace tie {

/// Hashes of results, by "format group".
using table = std::map<std::string, std::uint32_t>;

/// Reads paragraphs: a format, its number of cases, and an entry "group:hash" for each group.
inline table read_table() {
    std::ifstream file(ERRBOUND_TIE_TABLE);
    table read;
    std::string word, format;
    while (file >> word) {
        const auto colon = word.rfind(':');
        if (colon == std::string::npos) {
            format = word;
            file >> word;
        } else {
            read[format + " " + word.substr(0, colon)] =
                static_cast<std::uint32_t>(std::stoul(word.substr(colon + 1), nullptr, 16));
        }
    }
    return read;
}

/// FNV-1a, of 32-bit words.
class hash {
  public:
    void put(std::uint32_t word) { value_ = (value_ ^ word) * 16777619U; }
    /// Puts the upper half first.
    void put_both(std::uint64_t words) {
        put(static_cast<std::uint32_t>(words >> 32));
        put(static_cast<std::uint32_t>(words));
    }
    std::uint32_t value() const { return value_; }

  private:
    std::uint32_t value_ = 2166136261U;
};

/// A sequence of random numbers modulo 2^63; the upper bits are used.
class sequence {
  public:
    explicit sequence(std::uint64_t start = 1) : state_(start) {}
    std::uint64_t draw(std::uint64_t n) {
        state_ = (state_ * 3935559000370003845U + 2691343689449507681U) & (~std::uint64_t{0} >> 1);
        return (state_ >> 20) % n;
    }

  private:
    std::uint64_t state_;
};

/// A line of the table: the number of cases, and a function that hashes the results of a case,
/// numbered from 0.
struct line {
    std::string name;
    std::uint64_t cases;
    std::function<void(hash&, std::uint64_t)> put;
};

/// A line of `cases` cases, drawn in advance: put(results, drawn case, index).
template <class Draw, class Put>
line line_of(const std::string& name, int cases, sequence& numbers, const Draw& draw,
             const Put& put) {
    std::vector<decltype(draw(numbers))> drawn;
    for (int k = 0; k < cases; ++k) drawn.push_back(draw(numbers));
    return {name, drawn.size(),
            [drawn, put](hash& h, std::uint64_t k) { put(h, drawn[k], static_cast<int>(k)); }};
}

/// The group of a line "format operation": the name up to a '.' or '<' of the operation. Lines that
/// only differ in a number after '.' are groups of their own.
inline std::string group_of(const std::string& name) {
    const std::size_t end = std::min(name.find_first_of(".<", name.find(' ')), name.size());
    const bool is_number = name.find_first_not_of("0123456789", end + 1) == std::string::npos;
    return name[end] == '.' && is_number ? name : name.substr(0, end);
}

/// The table's hash of a group. The names of formats end in ",fma" if products are fused; groups on
/// which that has no effect have one entry.
inline std::uint32_t expected_hash(const table& expected, std::string group) {
    if (const auto found = expected.find(group); found != expected.end()) return found->second;
    if (const auto at = group.find(",fma"); at != std::string::npos) group.erase(at, 4);
    const auto found = expected.find(group);
    return found == expected.end() ? 0 : found->second;
}

/// Prints the lines of groups that differ from the table, only of the first or all, and returns the
/// number of these groups.
inline int count_differences(const std::vector<line>& lines, bool first_alone) {
    const table expected = read_table();
    std::map<std::string, std::size_t> sizes;
    for (const line& l : lines) ++sizes[group_of(l.name)];
    std::map<std::string, std::map<std::string, std::pair<std::uint64_t, hash>>> groups;
    int differences = 0;
    for (const line& l : lines) {
        const std::string group = group_of(l.name);
        auto& results = groups[group];
        auto& [cases, of_line] = results[l.name];
        for (cases = 0; cases < l.cases; ++cases) l.put(of_line, cases);
        if (results.size() < sizes[group]) continue;
        hash all;
        for (const auto& each : results) all.put(each.second.second.value());
        if (all.value() == expected_hash(expected, group)) continue;
        std::printf("%s: %08x, not in proofs/tie.txt\n", group.c_str(), unsigned{all.value()});
        for (const auto& [name, result] : results)
            std::printf("    %s %llu %08x\n", name.c_str(),
                        static_cast<unsigned long long>(result.first),
                        unsigned{result.second.value()});
        ++differences;
        if (first_alone) break;
    }
    return differences;
}

/// The exit status: 1 if lines differ. With an argument it stops at the first.
inline int compare(const std::vector<line>& lines, int arguments) {
    return count_differences(lines, arguments > 1) == 0 ? 0 : 1;
}

}  // namespace tie
