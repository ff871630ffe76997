// The comparison that `./run soak --predicates` repeats: every predicate against its oracle, and
// every bound of the static filter against exact arithmetic, on seeded inputs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <errbound/predicate.hpp>
#include <functional>
#include <string>
#include <string_view>

namespace soak {

struct predicate_run {
    std::uint64_t inputs = 10'000'000;  ///< per predicate and number type, of each of the two parts
    std::uint64_t seed = 1;
    unsigned threads = 0;   ///< 0: one per core
    std::string predicate;  ///< only those whose name holds this
};

struct sign_findings {
    std::string_view predicate, number_type;
    std::uint64_t inputs = 0;
    std::uint64_t zero = 0;             ///< by the oracle
    std::uint64_t wrong = 0;            ///< in any way of asking
    std::uint64_t uncertain = 0;        ///< all stages together
    errbound::predicate_report stages;  ///< of one input in eight
    double seconds = 0;
};
/// Signs against an oracle; of one input in eight also by batches and by every stage alone. The
/// first wrong ones are written to the standard error stream as hexadecimal floats.
void compare_signs(const predicate_run& run, const std::function<void(const sign_findings&)>& show);

struct bound_findings {
    std::string_view predicate, number_type;
    double constant = 0;           ///< in units of u
    int constant_of_shewchuk = 0;  ///< 0: none
    std::uint64_t attempts = 0;
    std::uint64_t violations = 0;  ///< of a bound, and certain signs that are wrong
    /// The largest error of a value whose sign was asked, but for its last rounding, over its
    /// bound.
    double used = 0;
    double seconds = 0;
};
/// |value − exact| against the static filter's bound, for every value whose sign a predicate asks:
/// inputs of all families, and from each a climb to larger errors over changes in last places.
void attack_bounds(const predicate_run& run,
                   const std::function<void(const bound_findings&)>& show);

}  // namespace soak
