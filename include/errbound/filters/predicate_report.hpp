// The stages of a predicate, and how many inputs each decided.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace errbound {

/// In the order in which an input passes them; it leaves at the first that is certain.
enum class predicate_stage : std::uint8_t {
    semi_static_filter,
    static_filter,
    tracked,
    exact_doubles,   ///< coordinates so short that no result takes more than 53 bits
    short_integers,  ///< so short that none takes more than 128
    word_integers,
    two_word_integers,  ///< expressions that branch do not have this stage
    long_integers,      ///< any finite coordinates; or the options' exact type
};
inline constexpr std::size_t predicate_stage_count = 8;

/// How many inputs each stage decided; `undecided` had coordinates that were not finite.
struct predicate_report {
    std::array<std::uint64_t, predicate_stage_count> decided{};
    std::uint64_t undecided = 0;

    std::uint64_t operator[](predicate_stage s) const {
        return decided[static_cast<std::size_t>(s)];
    }
    constexpr void count(predicate_stage s) { ++decided[static_cast<std::size_t>(s)]; }
};

}  // namespace errbound
