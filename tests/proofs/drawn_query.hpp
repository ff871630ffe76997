// Queries of a vertex and a face or of two edges in doubles. Some are of any size, have whole
// coordinates, meet or almost meet, or have gaps about the filter's margins. Others are in a plane
// or almost, have differences about the largest allowed ones, or are not finite. Each has a box
// around it.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/query.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "tests/proofs/table.hpp"

namespace tie {

/// In [0, 1).
inline double unit(sequence& s) {
    return std::ldexp(static_cast<double>(s.draw(std::uint64_t{1} << 40)), -40);
}
inline int draw(sequence& s, int n) {
    return static_cast<int>(s.draw(static_cast<std::uint64_t>(n)));
}

struct drawn_query {
    bool edges;
    std::array<double, 24> x;  ///< coordinate k of point p at end e is x[6p + 3e + k]
    std::array<double, 3> low, high;

    ccd::moving_point<double> moving(int p) const {
        const double* at = &x[static_cast<std::size_t>(6 * p)];
        return {{at[0], at[1], at[2]}, {at[3], at[4], at[5]}};
    }
    template <class Query>
    Query as() const {
        return {moving(0), moving(1), moving(2), moving(3)};
    }
};

/// Draws the coordinates of a query.
class query_maker {
  public:
    explicit query_maker(sequence& s) : s_(s) {}

    drawn_query query() {
        const int mode = draw(s_, 14);
        const int exponent = mode == 0    ? draw(s_, 500) - 400
                             : mode == 1  ? draw(s_, 300) - 100
                             : mode == 12 ? draw(s_, 40) - 1020
                                          : draw(s_, 20) - 10;
        const double size = std::ldexp(1.0, exponent);
        std::array<double, 3> base;
        for (double& b : base) b = unit(s_) * size;
        const double spread = std::ldexp(size, -draw(s_, 30));
        edges_ = draw(s_, 2) == 1;
        for (std::size_t i = 0; i < 24; ++i) x_[i] = base[i % 3] + (unit(s_) - 0.5) * spread;
        if (mode == 2)
            for (double& x : x_) x = std::floor(unit(s_) * 9) - 4;
        if (mode == 8 || mode == 9) almost_in_a_plane(std::ldexp(spread, -50 - draw(s_, 6)));
        if ((mode >= 3 && mode <= 5) || mode == 9) pass(spread, mode == 5);
        const bool coarse = mode == 13;
        if (mode == 6 || mode == 7 || coarse) small_gap(coarse);
        if (mode == 10) large();
        drawn_query q = boxed(draw(s_, 2) == 0 ? 0.0 : std::ldexp(size, -draw(s_, 30)));
        if (coarse) {
            q.low.fill(-1);
            q.high.fill(1);
        }
        if (mode == 11) {
            constexpr double infinity = std::numeric_limits<double>::infinity();
            double& x = q.x[static_cast<std::size_t>(draw(s_, 24))];
            const int kind = draw(s_, 3);
            x = kind == 0 ? infinity : kind == 1 ? -infinity : std::nan("");
        }
        return q;
    }

  private:
    double& at(int p, int e, int k) { return x_[static_cast<std::size_t>(6 * p + 3 * e + k)]; }

    void almost_in_a_plane(double tiny) {
        for (std::size_t i = 0; i < 8; ++i) x_[3 * i + 2] = (draw(s_, 3) - 1.0) * tiny;
    }

    /// Point 0 meets the face, or the edges cross, at a random time and position.
    void pass(double size, bool near) {
        const double t = unit(s_), a = unit(s_), b = (1 - a) * unit(s_);
        for (int c = 0; c < 3; ++c) {
            const auto place = [&](int p) { return (1 - t) * at(p, 0, c) + t * at(p, 1, c); };
            const double d = (unit(s_) - 0.5) * size;
            double off = near ? unit(s_) - 0.5 : 0;
            if (near) off *= std::ldexp(size, -draw(s_, 50));
            const double r = 0.2 + 0.7 * b;
            const double target =
                (edges_ ? ((1 - a) * place(0) + a * place(1) - (1 - r) * place(2)) / r
                        : (1 - a - b) * place(1) + a * place(2) + b * place(3)) +
                off;
            const int moved = edges_ ? 3 : 0;
            at(moved, 0, c) = target - t * d;
            at(moved, 1, c) = target + (1 - t) * d;
        }
    }

    /// The features' gap along an axis is about the filter's margin, or its margin in single
    /// precision if `coarse`.
    void small_gap(bool coarse) {
        for (double& x : x_)
            x = coarse ? std::ldexp(draw(s_, 1 << 19) - (1 << 18), -20) : (unit(s_) - 0.5) * 2;
        const int origin = edges_ ? 0 : 1;
        for (int i = 0; i < 6; ++i) x_[static_cast<std::size_t>(6 * origin + i)] = 0;
        const int axis = draw(s_, 9), k = axis % 3, l = (k + 1) % 3;
        const double other = axis < 3 ? 0 : axis < 6 ? 1 : -1, side = draw(s_, 2) == 0 ? 1 : -1;
        for (int e = 0; e < 2; ++e) {
            const auto along = [&](int p) { return side * (at(p, e, k) + other * at(p, e, l)); };
            const double first = edges_ ? along(1) : std::max(along(2), along(3));
            const double steps = draw(s_, 40);
            const int places = coarse ? -24 : -53 + draw(s_, 3);
            const double target = side * (std::max(first, 0.0) + std::ldexp(steps, places));
            const int p = edges_ ? 2 : 0;
            at(p, e, k) = target - other * at(p, e, l);
            if (edges_) {
                at(3, e, l) = at(2, e, l);
                at(3, e, k) = at(2, e, k) + side * (coarse ? 0.125 : unit(s_));
            }
        }
    }

    /// Differences about the largest allowed ones.
    void large() {
        const double most = std::ldexp(1.0, 200),
                     infinity = std::numeric_limits<double>::infinity();
        for (double& x : x_) x = (unit(s_) - 0.5) * most;
        std::fill_n(x_.begin(), 12, 0.0);
        double& x = x_[static_cast<std::size_t>(12 + draw(s_, 12))];
        const std::array<double, 4> sizes{most, std::nextafter(most, infinity),
                                          std::nextafter(most, 0.0), std::ldexp(1.0, 199)};
        const double size = sizes[static_cast<std::size_t>(draw(s_, 4))];
        x = draw(s_, 2) == 0 ? size : -size;
    }

    drawn_query boxed(double grow) const {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        drawn_query q{edges_, x_, {}, {}};
        q.low.fill(infinity);
        q.high.fill(-infinity);
        for (std::size_t i = 0; i < 24; ++i) {
            q.low[i % 3] = std::min(q.low[i % 3], x_[i]);
            q.high[i % 3] = std::max(q.high[i % 3], x_[i]);
        }
        for (std::size_t k = 0; k < 3; ++k) {
            q.low[k] -= grow;
            q.high[k] += grow;
        }
        return q;
    }

    sequence& s_;
    bool edges_ = false;
    std::array<double, 24> x_{};
};

}  // namespace tie
