// The stages of a predicate, and the number of inputs that each decided.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace errbound {

/// In order of execution, which ends at the first stage with a certain sign.
enum class predicate_stage : std::uint8_t {
    semi_static_filter,
    static_filter,
    tracked,
    exact_doubles,   ///< if coordinates are so short that results take at most 53 bits
    short_integers,  ///< if they are so short that results take at most 127 bits and a sign
    word_integers,
    two_word_integers,  ///< skipped if the expression branches
    long_integers,      ///< any finite coordinates; or the options' exact type
};
inline constexpr std::size_t predicate_stage_count = 8;

/// Inputs decided by each stage; `undecided` had coordinates that were not finite.
struct predicate_report {
    std::array<std::uint64_t, predicate_stage_count> decided{};
    std::uint64_t undecided = 0;

    std::uint64_t operator[](predicate_stage s) const {
        return decided[static_cast<std::size_t>(s)];
    }
    constexpr void count(predicate_stage s) { ++decided[static_cast<std::size_t>(s)]; }
};

}  // namespace errbound
