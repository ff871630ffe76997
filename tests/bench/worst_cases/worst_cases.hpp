// Public functions, each called with a row of doubles, and the search for the slowest rows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace worst_cases {

struct subject {
    std::string name;
    std::size_t numbers;  ///< read by `call`; at most those of a query of four points
    std::function<void(const double*)> call;
    int calls = 1;  ///< queries per call: a batch decides the same query many times
};

std::vector<subject> of_queries();     ///< exact, the other methods, batches, steps
std::vector<subject> of_predicates();  ///< errbound/predicates.hpp
std::vector<subject> of_roots();       ///< errbound/polynomial.hpp

struct range {
    const char* name;
    double low, high;  ///< of magnitudes; zeros are allowed, too
};
inline constexpr range ranges[] = {{"1e-3 to 1e3", 1e-3, 1e3},
                                   {"2^-100 to 2^100", 0x1p-100, 0x1p100},
                                   {"all finite", 0, 0x1.fffffffffffffp1023}};

/// The least seconds of several calls. Disturbances only add to the time.
double seconds_of(const subject& of, const std::vector<double>& numbers, int times);

/// The slowest input that hill climbing finds. It starts from `known` inputs (for other functions,
/// their first numbers). For `seconds` it tries queries of every family of
/// tests/support/query_families.hpp and small changes of the slowest input so far.
std::vector<double> slowest(const subject& of, const range& within,
                            const std::vector<std::vector<double>>& known, double seconds,
                            std::uint64_t seed);

/// The bytes of stack that `work` needs in a separate thread, beyond those of an idle thread.
/// Throws std::runtime_error if the system cannot create such a thread.
std::size_t stack_of(const std::function<void()>& work);

}  // namespace worst_cases
