// The stages of `exact`: the test, the decisions and the time of each.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace ccd {

/// The stages in the order in which a query passes them, until an answer is certain.
enum class stage : std::uint8_t { axes, coplanarity, inside, subdivision, integers, unbounded };
inline constexpr std::size_t stage_count = 6;

struct stage_info {
    ccd::stage stage;
    std::string_view name, question, arithmetic;
};

/// The stages in order; Y and the G_i have Bernstein coefficients (ccd/methods/forms.hpp). A single
/// query tests the axes x, y, z first, and the others after Y.
inline constexpr std::array<stage_info, stage_count> exact_stages{{
    {stage::axes, "axes",
     "is one feature entirely below the other along x, y, z, x ± y, y ± z or z ± x, the same one "
     "at both ends?",
     "double, or float in batches, with a margin"},
    {stage::coplanarity, "coplanarity",
     "do the four coefficients of Y have the same sign, so that the points are never coplanar?",
     "double, one error bound per query"},
    {stage::inside, "inside",
     "are all five coefficients of some G_i negative, so that no contact is possible?",
     "double, one error bound per query"},
    {stage::subdivision, "subdivision",
     "on shorter and shorter intervals: do the last two tests exclude contact, or does Y change "
     "its sign while all G_i are positive?",
     "double, the same bounds, up to 12 halvings"},
    {stage::integers, "integers",
     "are all G_i positive at a root of Y, or does a vertex touch an edge?",
     "integers of bounded width, with a unit for each axis"},
    {stage::unbounded, "unbounded",
     "is there a contact, with roots isolated by Descartes' rule of signs?",
     "integers of unbounded width"},
}};

/// Returns the entry of exact_stages; for any other value an entry named "unknown".
constexpr stage_info info(stage s) {
    const auto i = static_cast<std::size_t>(s);
    return i < stage_count ? exact_stages[i] : stage_info{s, "unknown", "", ""};
}

/// Counts and times of the stages. Calls add to it, so one report can collect many calls.
struct stage_report {
    struct entry {
        std::uint64_t entered = 0;  ///< queries that the stage tested
        std::uint64_t skipped = 0;  ///< queries that skipped it, after it decided too few
        std::uint64_t separate = 0;
        std::uint64_t collides = 0;
        double seconds = 0;  ///< the sum over threads
    };
    std::array<entry, stage_count> stages{};

    entry& operator[](stage s) { return stages[static_cast<std::size_t>(s)]; }
    const entry& operator[](stage s) const { return stages[static_cast<std::size_t>(s)]; }
    stage_report& operator+=(const stage_report& other) {
        for (std::size_t i = 0; i < stage_count; ++i) {
            stages[i].entered += other.stages[i].entered;
            stages[i].skipped += other.stages[i].skipped;
            stages[i].separate += other.stages[i].separate;
            stages[i].collides += other.stages[i].collides;
            stages[i].seconds += other.stages[i].seconds;
        }
        return *this;
    }
};

}  // namespace ccd
