#include <ccd/explain.hpp>

namespace ccd {

const stage_info& info(stage s) {
    static constexpr std::array<stage_info, stage_count> table{{
        {"axes", "a fixed axis parts the features the same way at both ends of the step"},
        {"coplanarity", "the four coefficients of Y have one sign: never coplanar"},
        {"inside", "the five coefficients of some G_i are negative: outside throughout"},
        {"subdivision", "Y and G_i on ever smaller parts of the step, under static bounds"},
        {"integers", "integers of fixed width: exact wherever the coordinates fit"},
        {"unbounded", "integers of unbounded size: slow, but always decides"},
    }};
    return table[static_cast<std::size_t>(s)];
}

}  // namespace ccd
