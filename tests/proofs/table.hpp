// Reads the table of results of the proofs' definitions, proofs/tie.txt, and compares results with
// it. The programs proofs/tie/tie_*.ml write the table. Tests enumerate the same cases in the same
// order.
#pragma once

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace tie {

/// Hashes of results, by "format operation".
using table = std::map<std::string, std::uint32_t>;

/// Reads paragraphs: a format, its number of cases, and an entry "operation:hash" for each
/// operation.
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

/// Prints the lines that differ from the table, only the first or all, and returns their number.
inline int count_differences(const std::vector<line>& lines, bool first_alone) {
    const table expected = read_table();
    int differences = 0;
    for (const line& l : lines) {
        hash results;
        for (std::uint64_t i = 0; i < l.cases; ++i) l.put(results, i);
        const auto found = expected.find(l.name);
        if (found != expected.end() && found->second == results.value()) continue;
        const auto cases = static_cast<unsigned long long>(l.cases);
        std::printf("%s: %llu %08x, not in proofs/tie.txt\n", l.name.c_str(), cases,
                    static_cast<unsigned>(results.value()));
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
