// Hilbert's curve through the cells of a cube. Neighbours along it are neighbours in space.
//
// In each cube the curve visits the octants in the order of Gray's code. The order depends on the
// cube's state: the corner where the curve enters and the axis along which it leaves. A cube passes
// a state to each octant (Hamilton and Rau-Chaplin, "Compact Hilbert indices", 2008).
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace ccd::detail {

/// The order of the octants, by state.
class hilbert_states {
  public:
    struct step {
        std::uint8_t digit, next;
    };

    constexpr hilbert_states() {
        for (unsigned corner = 0; corner < octants; ++corner)
            for (unsigned along = 0; along < axes; ++along)
                for (unsigned i = 0; i < octants; ++i) {
                    const unsigned octant = rotated(i ^ (i >> 1), along) ^ corner;
                    steps_[state(corner, along)][octant] = {
                        static_cast<std::uint8_t>(i),
                        state(corner ^ rotated(entry(i), along), along + 1 + axis(i))};
                }
    }
    constexpr step operator()(unsigned state, std::uint64_t octant) const {
        return steps_[state][octant];
    }

  private:
    static constexpr unsigned axes = 3, octants = 8;

    static constexpr std::uint8_t state(unsigned corner, unsigned axis) {
        return static_cast<std::uint8_t>(corner * axes + axis % axes);
    }
    static constexpr unsigned rotated(unsigned octant, unsigned along) {
        const unsigned by = (along + 1) % axes;
        return (octant << by | octant >> (axes - by)) & (octants - 1);
    }
    /// The corner where the curve enters the i-th octant, and the axis along which it leaves.
    static constexpr unsigned entry(unsigned i) {
        const unsigned before = i == 0 ? 0 : (i - 1) & ~1U;
        return before ^ (before >> 1);
    }
    static constexpr unsigned axis(unsigned i) {
        return i == 0 ? 0 : static_cast<unsigned>(std::countr_one(i - 1 + i % 2));
    }

    std::array<std::array<step, octants>, octants * axes> steps_{};
};

inline constexpr hilbert_states states_of_hilbert;

/// Digits of `morton`, the position along Morton's curve, are octants: `axis_bits` bits an axis.
constexpr std::uint64_t hilbert_position(std::uint64_t morton, unsigned axis_bits) {
    std::uint64_t along = 0;
    unsigned state = 0;
    for (unsigned shift = 3 * axis_bits; shift > 0;) {
        shift -= 3;
        const auto step = states_of_hilbert(state, (morton >> shift) & 7);
        along = along << 3 | step.digit;
        state = step.next;
    }
    return along;
}

}  // namespace ccd::detail
