// Public functions, each called with a row of doubles, and the search for the rows for which they
// take the longest.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace worst_cases {

struct subject {
    std::string name;
    std::size_t numbers;  ///< that `call` reads; at most those of a query of four points
    std::function<void(const double*)> call;
    int calls = 1;  ///< counted for a call: a batch decides the same query many times
};

std::vector<subject> of_queries();     ///< exact, the other methods, batches, steps
std::vector<subject> of_predicates();  ///< errbound/predicates.hpp
std::vector<subject> of_roots();       ///< errbound/polynomial.hpp

/// A range of coordinates.
struct range {
    const char* name;
    double low, high;  ///< of magnitudes other than zero
};
inline constexpr range ranges[] = {{"1e-3 to 1e3", 1e-3, 1e3},
                                   {"2^-100 to 2^100", 0x1p-100, 0x1p100},
                                   {"all finite", 0, 0x1.fffffffffffffp1023}};

/// Seconds of a call: the least of several, since a disturbance only adds to it.
double seconds_of(const subject& of, const std::vector<double>& numbers, int times);

/// The slowest input found by hill climbing: among `known` ones (of other functions, too: their
/// first numbers), and, for that many seconds, among queries of every family of
/// tests/support/query_families.hpp and small changes of the slowest so far.
std::vector<double> slowest(const subject& of, const range& within,
                            const std::vector<std::vector<double>>& known, double seconds,
                            std::uint64_t seed);

/// Bytes of stack that `work` needs on a thread of its own, above those of an idle thread. Throws
/// std::runtime_error if the system has no such thread.
std::size_t stack_of(const std::function<void()>& work);

}  // namespace worst_cases
