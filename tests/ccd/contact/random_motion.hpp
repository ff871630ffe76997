// Random motion along curves and of bodies: on coarse grids, where many degenerate cases arise, or
// anywhere.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <cmath>
#include <random>
#include <string>

#include "tests/ccd/contact/by_hand.hpp"
#include "tests/support/scaled.hpp"

namespace random_motion {

using by_hand::point;
using ccd::kind;

/// The query of a kind with these points; kinds with fewer points skip the last ones.
template <kind K, class Motion>
auto query_of(const std::array<Motion, 4>& p) {
    if constexpr (K == kind::vertex_face)
        return ccd::vertex_face_of<Motion>{p[0], p[1], p[2], p[3]};
    else if constexpr (K == kind::edge_edge)
        return ccd::edge_edge_of<Motion>{p[0], p[1], p[2], p[3]};
    else if constexpr (K == kind::vertex_edge)
        return ccd::vertex_edge_of<Motion>{p[0], p[1], p[2]};
    else
        return ccd::vertex_vertex_of<Motion>{p[0], p[1]};
}

class random_source {
  public:
    explicit random_source(unsigned seed) : random_(seed) {}

    unsigned below(unsigned n) { return static_cast<unsigned>(random_() % n); }
    double whole(int most) {
        return static_cast<double>(static_cast<int>(below(static_cast<unsigned>(2 * most + 1))) -
                                   most);
    }
    /// On a coarse grid, where many degenerate cases arise, or anywhere in [−1, 1]. Some are moved
    /// off the grid by a unit in the last place.
    double number(int most) {
        if (spread == 0) return number_of_one_size(most);
        return std::ldexp(number_of_one_size(most),
                          static_cast<int>(below(2 * spread + 1)) - static_cast<int>(spread));
    }
    double number_of_one_size(int most) {
        if (!on_grid) return std::ldexp(static_cast<double>(random_()), -63) - 1;
        const double x = whole(most);
        if (!nudged || below(4) != 0) return x;
        return std::nextafter(x, below(2) == 0 ? by_hand::infinity : -by_hand::infinity);
    }
    point position(int most) {
        const auto coordinate = [&] { return std::ldexp(number(most), scale); };
        return {coordinate(), coordinate(), flat ? 0 : coordinate()};
    }
    void draw_style() {
        on_grid = below(4) != 0;
        flat = below(4) == 0;
        nudged = below(4) == 0;
        scale = below(4) == 0 ? static_cast<int>(below(1900)) - 1000 : 0;
        spread = scale == 0 && below(4) == 0 ? 60 : 0;
    }
    bool on_grid = true, flat = false, nudged = false;
    int scale = 0;        ///< of positions: a power of two
    unsigned spread = 0;  ///< the largest exponent of factors of all numbers

  private:
    std::mt19937_64 random_;
};

/// Checks `count` random queries of each kind. --gtest_random_seed=N selects another sequence, so
/// that several runs can share a long one.
template <class Random, class Check>
void for_random_queries(int count, unsigned seed, const Check& check) {
    Random random(seed + 100 * static_cast<unsigned>(GTEST_FLAG_GET(random_seed)));
    for (int i = 0; i < support::scaled(count); ++i) {
        random.draw_style();
        SCOPED_TRACE("query " + std::to_string(i));
        ccd::for_each_kind([&]<kind K>() { check.template operator()<K>(random); });
    }
}

inline ccd::separation random_distance(random_source& random) {
    return {std::ldexp(1, static_cast<int>(random.below(5)) - 3 + random.scale),
            std::ldexp(random.below(2), random.scale)};
}

}  // namespace random_motion
