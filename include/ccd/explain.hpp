// The stages of `exact`: what each settled, and at what cost.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace ccd {

/// In the order in which a query passes them; it leaves at the first that is certain.
enum class stage : std::uint8_t {
    axes,         ///< a fixed axis parts the features the same way at both ends of the step
    coplanarity,  ///< the coefficients of Y have one sign: the points are never coplanar
    inside,       ///< the coefficients of some G_i are negative: outside throughout
    subdivision,  ///< Y and G_i on ever smaller parts of the step, under static bounds
    integers,     ///< integers of fixed width: exact wherever the coordinates fit
    unbounded,    ///< integers of unbounded width: the reference
};
inline constexpr std::size_t stage_count = 6;

struct stage_info {
    std::string_view name;
    std::string_view how;  ///< one sentence
};
const stage_info& info(stage s);

/// What the stages did. Counters only grow, so one report can serve many calls.
struct stage_report {
    struct entry {
        std::uint64_t entered = 0;   ///< queries that the stage was asked
        std::uint64_t left_out = 0;  ///< queries that passed it by, where it settled too few
        std::uint64_t separate = 0;
        std::uint64_t collides = 0;
        double seconds = 0;  ///< of all threads together
    };
    std::array<entry, stage_count> stages{};

    entry& operator[](stage s) { return stages[static_cast<std::size_t>(s)]; }
    const entry& operator[](stage s) const { return stages[static_cast<std::size_t>(s)]; }
    stage_report& operator+=(const stage_report& other) {
        for (std::size_t i = 0; i < stage_count; ++i) {
            stages[i].entered += other.stages[i].entered;
            stages[i].left_out += other.stages[i].left_out;
            stages[i].separate += other.stages[i].separate;
            stages[i].collides += other.stages[i].collides;
            stages[i].seconds += other.stages[i].seconds;
        }
        return *this;
    }
};

}  // namespace ccd
