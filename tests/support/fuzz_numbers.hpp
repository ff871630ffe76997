// A fuzzer's bytes as numbers: mostly small, copies of earlier ones, or next to them, so that
// degenerate input is frequent.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace fuzz {

class numbers {
  public:
    /// The first byte selects the scale of numbers; one in eight mixes all scales.
    numbers(const std::uint8_t* data, std::size_t size) : rest_(data, size) {
        const int first = byte();
        all_scales_ = first % 8 == 7;
        if (first >= 192) scale_ = (first - 224) * 30;
    }

    /// The next byte, or 0 at the end.
    std::uint8_t byte() {
        if (rest_.empty()) return 0;
        const std::uint8_t b = rest_.front();
        rest_ = rest_.subspan(1);
        return b;
    }
    /// An index from 0 to end − 1.
    std::size_t below(std::size_t end) { return byte() % end; }
    bool empty() const { return rest_.empty(); }

    double next() {
        const double x = made(byte());
        seen_.push_back(std::isfinite(x) ? x : 0);
        return seen_.back();
    }

  private:
    double made(unsigned op) {
        const unsigned low = op % 32;
        switch (op / 32) {
            case 0:
                return std::ldexp(static_cast<int>(op % 7) - 3, scale_);
            case 1:
                return std::ldexp(static_cast<int>(low) - 16, scale_);
            case 2:
                return low < 16 ? earlier() : -earlier();
            case 3:
                return neighbour(earlier(), static_cast<int>(low % 7) - 3);
            case 4:
                return earlier() + earlier() - earlier();
            case 5:
                return std::ldexp(static_cast<int>(low) - 16, scale_ + byte() / 4 - 32);
            case 6:
                return std::ldexp(static_cast<double>(seven_bytes()),
                                  scale_ + static_cast<int>(low) - 72);
            default:
                return special(low);
        }
    }
    double earlier() { return seen_.empty() ? 0 : seen_[below(seen_.size())]; }
    /// A zero moves by 2^-53 of the scale, since its neighbours have another scale.
    double neighbour(double x, int units) const {
        if (x == 0 && !all_scales_) return std::ldexp(units, scale_ - 53);
        for (int n = std::abs(units); n > 0; --n)
            x = std::nextafter(x, units * std::numeric_limits<double>::infinity());
        return x;
    }
    std::int64_t seven_bytes() {
        std::uint64_t bits = 0;
        for (int i = 0; i < 7; ++i) bits = bits << 8 | byte();
        return static_cast<std::int64_t>(bits << 8) >> 11;
    }
    double special(unsigned which) {
        using limits = std::numeric_limits<double>;
        constexpr double some[] = {0,       -0.0,     1.0 / 3,  0.1,       1 + limits::epsilon(),
                                   1e-3,    0.5,      -0x1p-52, 0x1p26,    0x1.fffffffffffffp0,
                                   0x1p-26, 1e6 + .1, -0x1p52,  0x1p53 - 1};
        constexpr double wild[] = {limits::denorm_min(),
                                   limits::min(),
                                   limits::max(),
                                   limits::lowest(),
                                   0x1p511,
                                   0x1p-511,
                                   0x1p-537,
                                   0x1p341,
                                   -0x1p-358};
        if (which < std::size(some)) return std::ldexp(some[which], scale_);
        if (!all_scales_) return std::ldexp(1, scale_ + static_cast<int>(which) - 24);
        return wild[which % std::size(wild)];
    }

    std::span<const std::uint8_t> rest_;
    std::vector<double> seen_;
    int scale_ = 0;
    bool all_scales_ = false;
};

/// Ends the program, so that the fuzzer stores its bytes.
[[noreturn]] inline void fail(const std::string& what) {
    std::fprintf(stderr, "%s\n", what.c_str());
    std::abort();
}

/// The points of a query, axis by axis, so that copies of earlier numbers stay on one axis.
template <class Points>
Points points_from(numbers& from) {
    Points all{};
    using point = decltype(all[0].t0);
    for (const auto axis : {&point::x, &point::y, &point::z})
        for (auto& m : all) {
            m.t0.*axis = from.next();
            m.t1.*axis = from.next();
        }
    return all;
}

}  // namespace fuzz
