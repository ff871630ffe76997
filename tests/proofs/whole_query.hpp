// Queries of a vertex and a face or of two edges in integers.
// They are small or large, almost in a plane, or meet or almost meet inside or at a border. Some
// have equal points, are almost rigid, or move out and back. Some have a Y with close roots, some
// axes with other units, slightly changed.
#pragma once

#include <array>
#include <ccd/query.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "tests/proofs/drawn_query.hpp"
#include "tests/proofs/table.hpp"

namespace tie {

/// Calls visit with the query of all four points.
template <class Visit>
void with_query(const drawn_query& q, const Visit& visit) {
    if (q.edges)
        visit(q.as<ccd::edge_edge<double>>());
    else
        visit(q.as<ccd::vertex_face<double>>());
}
/// Calls visit with the queries of the first three and of the first two points.
template <class Visit>
void with_smaller_queries(const drawn_query& q, const Visit& visit) {
    visit(ccd::vertex_edge<double>{q.moving(0), q.moving(1), q.moving(2)});
    visit(ccd::vertex_vertex<double>{q.moving(0), q.moving(1)});
}

class whole_query_maker {
  public:
    explicit whole_query_maker(sequence& s) : s_(s) {}

    drawn_query query() {
        mode_ = draw(s_, 16);
        edges_ = draw(s_, 2) == 1;
        draw_numbers();
        if (mode_ == 4)
            for (std::size_t i = 0; i < 8; ++i) c_[3 * i + 2] = draw(s_, 4) == 0 ? pick(1) : 0;
        if (mode_ == 5) meet(true, false);
        if (mode_ == 6) coincide();
        if (mode_ == 7) move_rigidly();
        if (mode_ == 8) move_out_and_back();
        if (mode_ >= 9 && mode_ <= 12) meet(false, draw(s_, 2) == 0);
        if (mode_ == 15) near_roots();
        return in_doubles();
    }

    /// Some coordinates are so large that integers of 1, 2 or 4 words just hold them, or do not;
    /// some are not finite.
    drawn_query wide_query() {
        drawn_query q = query();
        const int kind = draw(s_, 8);
        constexpr std::array<int, 6> bits{60, 61, 124, 125, 252, 253};
        const int exponent =
            kind == 6 ? 120 + draw(s_, 904) : bits[static_cast<std::size_t>(kind % 6)];
        const bool along = draw(s_, 2) == 0;
        const int axis = draw(s_, 3);
        for (std::size_t i = 0; i < 24; ++i)
            if (draw(s_, 4) == 0 && (!along || static_cast<int>(i % 3) == axis)) {
                const int size = draw(s_, 3);
                q.x[i] = std::ldexp(size, exponent - draw(s_, 2));
            }
        if (kind == 7 && draw(s_, 2) == 0) {
            constexpr double infinity = std::numeric_limits<double>::infinity();
            const int which = draw(s_, 3);
            q.x[static_cast<std::size_t>(draw(s_, 24))] = which == 0   ? infinity
                                                          : which == 1 ? -infinity
                                                                       : std::nan("");
        }
        return q;
    }

  private:
    using whole = std::int64_t;

    whole pick(whole size) {
        return static_cast<whole>(s_.draw(static_cast<std::uint64_t>(2 * size + 1))) - size;
    }
    whole& at(int p, int e, int x) { return c_[static_cast<std::size_t>(6 * p + 3 * e + x)]; }

    void draw_numbers() {
        constexpr std::array<whole, 9> sizes{1, 2, 3, 5, 9, 30, 1000, 1 << 20, whole{1} << 40};
        const auto drawn = [&](int first, int count) {
            return sizes[static_cast<std::size_t>(first + draw(s_, count))];
        };
        size_ = mode_ < 3    ? drawn(0, 4)
                : mode_ == 3 ? drawn(0, 9)
                : mode_ < 9  ? drawn(3, 6)
                             : 1 + draw(s_, 8);
        for (whole& c : c_) c = mode_ >= 9 && draw(s_, 2) == 0 ? 0 : pick(size_);
    }

    /// Point 0 is at a position of the face, or the edges cross there, at t = k/8; or they miss it
    /// slightly.
    void meet(bool sometimes_off, bool on_border) {
        const whole k = draw(s_, 9), a = on_border ? 0 : draw(s_, 5);
        const whole b = edges_ ? 1 + draw(s_, 4) : draw(s_, static_cast<int>(5 - a));
        const auto off = [&] { return sometimes_off && draw(s_, 8) == 0 ? pick(1) : 0; };
        const int moved = edges_ ? 3 : 0;
        for (int x = 0; x < 3; ++x) {
            const auto place = [&](int p) { return (8 - k) * at(p, 0, x) + k * at(p, 1, x); };
            const whole target = edges_ ? (4 - a) * place(0) + a * place(1) - (4 - b) * place(2)
                                        : (4 - a - b) * place(1) + a * place(2) + b * place(3);
            const whole factor = edges_ ? 8 * b : 32;
            for (int p = 0; p < 4; ++p)
                for (int e = 0; e < 2; ++e)
                    if (p != moved) at(p, e, x) *= factor;
            const whole m = pick(size_);
            at(moved, 0, x) = target + k * m + off();
            at(moved, 1, x) = target - (8 - k) * m + off();
        }
    }

    void coincide() {
        const int p = draw(s_, 4), q = draw(s_, 4);
        for (int i = 0; i < 6; ++i) at(p, 0, i) = at(q, 0, i) + (draw(s_, 3) == 0 ? pick(1) : 0);
    }

    void move_rigidly() {
        std::array<whole, 3> d;
        for (whole& x : d) x = pick(size_);
        for (int p = 0; p < 4; ++p)
            for (int x = 0; x < 3; ++x)
                at(p, 1, x) = at(p, 0, x) + d[static_cast<std::size_t>(x)] + pick(2);
    }

    void move_out_and_back() {
        for (int p = 0; p < 4; ++p)
            for (int x = 0; x < 3; ++x) {
                const whole sign = draw(s_, 2) == 0 ? 1 : -1;
                at(p, 1, x) = sign * at(p, 0, x) + (draw(s_, 4) == 0 ? pick(1) : 0);
            }
    }

    /// Y is almost the product of three linear forms of the rows P, B and C, with roots close to
    /// k/8. Other entries of the rows are small.
    void near_roots() {
        const whole k = draw(s_, 9), large = whole{1} << draw(s_, 31);
        std::array<std::array<std::array<whole, 2>, 3>, 3> rows;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t x = 0; x < 3; ++x)
                for (int e = 0; e < 2; ++e) {
                    const whole little = draw(s_, 2) == 0 ? 0 : pick(2);
                    rows[i][x][static_cast<std::size_t>(e)] =
                        little + (i == x ? large * (k - 8 * e) : 0);
                }
        const auto place = [&](int p, int from, std::size_t row) {
            for (int x = 0; x < 3; ++x)
                for (int e = 0; e < 2; ++e)
                    at(p, e, x) =
                        at(from, e, x) +
                        rows[row][static_cast<std::size_t>(x)][static_cast<std::size_t>(e)];
        };
        if (edges_) {
            place(1, 0, 1);
            place(2, 0, 0);
            place(3, 2, 2);
        } else {
            place(0, 1, 0);
            place(2, 1, 1);
            place(3, 1, 2);
        }
    }

    drawn_query in_doubles() {
        drawn_query q{edges_, {}, {}, {}};
        for (std::size_t i = 0; i < 24; ++i) q.x[i] = static_cast<double>(c_[i]);
        if (mode_ < 10 || mode_ == 15) return q;
        constexpr double infinity = std::numeric_limits<double>::infinity();
        std::array<int, 3> exponents;
        for (int& e : exponents) e = draw(s_, 110);
        const bool same = draw(s_, 2) == 0;
        const int seldom = draw(s_, 6) + 2;
        for (std::size_t i = 0; i < 24; ++i) {
            double& x = q.x[i];
            x = std::ldexp(x, exponents[same ? 0 : i % 3]);
            if (draw(s_, seldom) != 0) continue;
            if (x == 0) {
                x = static_cast<double>(pick(1));
                x = std::ldexp(x, draw(s_, 3) > 0 ? 0 : draw(s_, 40));
            } else if (draw(s_, 4) == 0) {
                x = std::nextafter(x, draw(s_, 2) == 0 ? infinity : -infinity);
            }
        }
        return q;
    }

    sequence& s_;
    int mode_ = 0;
    bool edges_ = false;
    whole size_ = 1;
    std::array<whole, 24> c_{};
};

}  // namespace tie
