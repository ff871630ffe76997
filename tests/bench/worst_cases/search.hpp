// Hill climbing on time: the row of doubles for which a function takes the longest.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/bench/worst_cases/subjects.hpp"

namespace worst_cases {

/// Which coordinates are tried.
struct range {
    const char* name;
    double low, high;  ///< of magnitudes other than zero
};
inline constexpr range ranges[] = {{"1e-3 to 1e3", 1e-3, 1e3},
                                   {"2^-100 to 2^100", 0x1p-100, 0x1p100},
                                   {"all finite", 0, 0x1.fffffffffffffp1023}};

bool holds(const range& within, const std::vector<double>& numbers);

/// Seconds of a call: the least of some, since what disturbs a call only adds to it.
double seconds_of(const subject& asked, const std::vector<double>& numbers, int times);

/// The slowest input that was met: among `known` ones (of other functions, too: their first
/// numbers), and in so many seconds among queries of every family of
/// tests/support/query_families.hpp, and what small changes make of the slowest so far.
std::vector<double> slowest(const subject& asked, const range& within,
                            const std::vector<std::vector<double>>& known, double seconds,
                            std::uint64_t seed);

}  // namespace worst_cases
