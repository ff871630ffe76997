// Nearness in doubles, with static bounds on the errors. Internal.
//
// Evaluates the conditions of ccd/contact/nearness/in_integers.hpp. If those of some features hold
// with certain signs and without equality, these features are unique.
//
// Bounds: u = 2^-53. Each difference of points is a vector v^ with |v^ - v| <= u·size, and |v|,
// |v^| <= size, of sizes V, W, ... . Then, to first order in u:
//  * dot(v, w) is off by VW (2u + 3u), from both vectors and three roundings in a row.
//  * cross(v, w) is off by VW (2u + 2u).
//  * dot of two cross products with sizes G and H is off by GH (8u + 3u); dot(cross, v) by
//    HV (4u + u + 3u).
// Second-order terms, and roundings of the bounds themselves, are in the constants' last digits.
// Underflow adds less than `tiny`: sizes are below 2^150, and each operation adds at most 2^-1075.
// Divisors, and squares of lengths, are above 2^-600, so their own underflow is below 2^-170 of
// them.
#pragma once

#include <array>
#include <ccd/kind.hpp>
#include <ccd/nearness.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "ccd/contact/data/meeting.hpp"
#include "ccd/contact/nearness/weights.hpp"

namespace ccd::detail::nearness_filter {

constexpr double u = 0x1p-53, tiny = 0x1p-700, largest_size = 0x1p150, least_divisor = 0x1p-600;
/// Errors of results, relative to lengths. Larger ones are left to the integers.
constexpr double largest_error = 0x1p-26;

struct vector {
    double x, y, z;

    friend vector operator+(const vector& v, const vector& w) {
        return {v.x + w.x, v.y + w.y, v.z + w.z};
    }
    friend vector operator-(const vector& v, const vector& w) {
        return {v.x - w.x, v.y - w.y, v.z - w.z};
    }
    friend vector operator*(double f, const vector& v) { return {f * v.x, f * v.y, f * v.z}; }
    friend double dot(const vector& v, const vector& w) {
        return v.x * w.x + v.y * w.y + v.z * w.z;
    }
    friend vector cross(const vector& v, const vector& w) {
        return {v.y * w.z - v.z * w.y, v.z * w.x - v.x * w.z, v.x * w.y - v.y * w.x};
    }
    friend double sum_of_sizes(const vector& v) {
        return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
    }
};

/// A difference of two points.
struct sized_vector : vector {
    double size;

    sized_vector operator-() const { return {{-x, -y, -z}, size}; }
};

/// A number at most `error` away from the exact one.
struct bounded {
    double value, error;

    bool is_positive() const { return value > error; }
    bool is_negative() const { return value < -error; }
    bounded operator-() const { return {-value, error}; }
    friend bounded operator-(const bounded& a, const bounded& b) {
        return {a.value - b.value, a.error + b.error};
    }
};
inline bounded projection(const sized_vector& v, const sized_vector& w) {
    return {dot(v, w), 5.1 * u * (v.size * w.size) + tiny};
}

/// The points of a query at one end of the step.
template <std::size_t N>
struct resting_points {
    std::array<vector, N> at;

    sized_vector difference(std::size_t i, std::size_t j) const {
        const vector d = at[i] - at[j];
        return {d, sum_of_sizes(d)};
    }
};

/// The points at t, from differences at both ends, D0 and D1: D0 + t·(D1 - D0) is off by 5u of the
/// sum of their sizes: 2u from both, u each from D1 - D0 (of both), the product and the sum.
template <std::size_t N>
struct moving_points {
    resting_points<N> start, end;
    double t;

    sized_vector difference(std::size_t i, std::size_t j) const {
        const sized_vector d0 = start.difference(i, j), d1 = end.difference(i, j);
        return {d0 + t * (d1 - d0), 5.1 * (d0.size + d1.size)};
    }
};

/// Writes data, or returns false if they are not certain or not accurate.
class writer {
  public:
    explicit writer(nearness& into) : into_(into) {}

    bool vertices(std::uint8_t p, std::uint8_t q, const sized_vector& w) const {
        const double square = dot(w, w);
        if (!set_distance(square, std::sqrt(square), u * w.size)) return false;
        into_.features = {kind::vertex_vertex, {p, q}};
        into_.weights = {};
        into_.weights[p] = into_.weights[q] = 1;
        into_.weight_error = 0;
        return set_normal(w, into_.distance, u * w.size, 1);
    }

    /// A vertex and an edge; w is from the edge's first end to the vertex, `along` = w·e > 0 and
    /// less than e·e. With k = E/|e|, the weight s = w·e/e·e is off by (5uWE + 5us·EE)/e·e + u.
    /// Since s|e| <= |w| <= W, r = w − s·e is off by less than uW (1 + (5k + 5k² + 1) + k + 1 + 1)
    /// <= 16 u W k².
    bool edge(const point_numbers& points, const sized_vector& w, const sized_vector& e,
              const bounded& along, int side) const {
        const double ee = dot(e, e), excess = e.size * e.size / ee;
        if (!(ee > least_divisor) || !(excess < 0x1p20)) return false;
        const double weight = along.value / ee;
        const vector r = w - weight * e;
        const double square = dot(r, r), error = 16 * u * (w.size * excess);
        if (!set_distance(square, std::sqrt(square), error)) return false;
        into_.features = {kind::vertex_edge, points};
        into_.weights = {};
        set_weights<kind::vertex_edge>(
            points, [&](std::size_t) { return weight; }, into_);
        into_.weight_error = 5.1 * u * (e.size * (w.size + e.size)) / ee + 2 * u;
        return into_.weight_error < largest_error && set_normal(r, into_.distance, error, side);
    }

    /// Inside both features: n and n·n, with the size h of n; y = n·p; the weights times n·n. A
    /// weight is off by (its error + that of n·n)/n·n + u, the distance |y|/|n| by (y's error +
    /// 4u·h·distance)/|n| + 4u·distance.
    template <kind K>
    bool inside(const vector& n, const bounded& n2, double h, const bounded& y,
                const std::array<bounded, 4>& weights) const {
        if (!(n2.value > least_divisor) || !(y.is_positive() || y.is_negative())) return false;
        const double length = std::sqrt(n2.value), distance = std::abs(y.value) / length;
        const double off = 4.1 * u * h, error = 1.01 * (y.error + distance * off) / length;
        if (!set_distance(distance * distance, distance, error)) return false;
        into_.features = whole_query<K>();
        set_weights<K>(
            into_.features.points, [&](std::size_t i) { return weights[i].value / n2.value; },
            into_);
        double sum = 0;
        for (const bounded& w : weights) sum += w.error;
        into_.weight_error = 1.01 * (sum + 2 * n2.error) / n2.value + 5 * u;
        const bool towards_p = y.is_positive() == (K == kind::vertex_face);
        return into_.weight_error < largest_error && set_normal(n, length, off, towards_p ? 1 : -1);
    }

  private:
    /// The error of a length before its last roundings, at most 4u of it.
    bool set_distance(double square, double distance, double error) const {
        if (!(square > least_divisor) || !(error < largest_error * distance)) return false;
        into_.squared_distance = square;
        into_.squared_distance_error = 2.1 * distance * error + 10 * u * square;
        into_.distance = distance;
        into_.distance_error = error + 4 * u * distance;
        return true;
    }
    /// For vectors p and q, p/|p| and q/|q| are at most |p − q|/m apart, where m is the lesser
    /// length; see direction_of in ccd/contact/data/normal.hpp.
    bool set_normal(const vector& n, double length, double error, int side) const {
        into_.normal = {side * n.x / length, side * n.y / length, side * n.z / length};
        into_.normal_error = 1.01 * error / length + 4 * u;
        return into_.normal_error < largest_error;
    }

    nearness& into_;
};

/// N = b × c and the products of ccd/methods/forms.hpp with their bounds.
struct bounded_forms {
    sized_vector b, c, p;
    vector n = cross(b, c);
    double h = b.size * c.size;
    bounded n2{dot(n, n), error_of(h)};

    bounded y() const { return {dot(n, p), 8.2 * u * (h * p.size) + tiny}; }
    bounded weight(const sized_vector& v, const sized_vector& w) const {
        return {dot(cross(v, w), n), error_of(v.size * w.size)};
    }

  private:
    /// Sums of up to three such terms are rounded twice more.
    double error_of(double size) const { return 13.2 * u * (size * h) + tiny; }
};

template <kind K, class Points>
bool find(const Points& x, nearness& into) {
    const writer write(into);
    const auto d = [&](std::size_t i, std::size_t j) { return x.difference(i, j); };
    if constexpr (K == kind::vertex_vertex) {
        const auto w = d(0, 1);
        return w.size < largest_size && write.vertices(0, 1, w);
    } else if constexpr (K == kind::vertex_edge) {
        const auto w = d(0, 1), e = d(2, 1), q = d(0, 2);
        if (!(w.size + e.size < largest_size)) return false;
        const bounded from_first = projection(w, e), from_second = -projection(q, e);
        if (from_first.is_negative()) return write.vertices(0, 1, w);
        if (from_second.is_negative()) return write.vertices(0, 2, q);
        return from_first.is_positive() && from_second.is_positive() &&
               write.edge({0, 1, 2}, w, e, from_first, 1);
    } else if constexpr (K == kind::vertex_face) {
        const bounded_forms f{d(2, 1), d(3, 1), d(0, 1)};
        const auto &b = f.b, &c = f.c, &p = f.p;
        if (!(b.size + c.size + p.size < largest_size)) return false;
        const bounded w2 = f.weight(b, p), w1 = f.weight(p, c), w0 = f.n2 - w1 - w2;
        if (w0.is_positive() && w1.is_positive() && w2.is_positive())
            return write.template inside<K>(f.n, f.n2, f.h, f.y(), {bounded{}, bounded{}, w1, w2});
        // Named by the corner from which, then the corner to which they go.
        const auto e = d(3, 2), q = d(0, 2), r = d(0, 3);
        const bounded s01 = projection(p, b), s02 = projection(p, c), s10 = -projection(q, b),
                      s12 = projection(q, e), s20 = -projection(r, c), s21 = -projection(r, e);
        if (s01.is_negative() && s02.is_negative()) return write.vertices(0, 1, p);
        if (s10.is_negative() && s12.is_negative()) return write.vertices(0, 2, q);
        if (s20.is_negative() && s21.is_negative()) return write.vertices(0, 3, r);
        if (w2.is_negative() && s01.is_positive() && s10.is_positive())
            return write.edge({0, 1, 2}, p, b, s01, 1);
        if (w0.is_negative() && s12.is_positive() && s21.is_positive())
            return write.edge({0, 2, 3}, q, e, s12, 1);
        return w1.is_negative() && s20.is_positive() && s02.is_positive() &&
               write.edge({0, 3, 1}, r, -c, s20, 1);
    } else {
        const bounded_forms f{d(1, 0), d(3, 2), d(2, 0)};
        const auto &a = f.b, &b = f.c, &p = f.p;
        if (!(a.size + b.size + p.size < largest_size)) return false;
        const bounded a1 = f.weight(p, b), b1 = f.weight(p, a), a0 = f.n2 - a1, b0 = f.n2 - b1;
        if (a0.is_positive() && a1.is_positive() && b0.is_positive() && b1.is_positive())
            return write.template inside<K>(f.n, f.n2, f.h, f.y(), {bounded{}, a1, bounded{}, b1});
        // w[i][j]: from b_j to a_i; on_a[i][j]: of b_j on edge a, from a_i; on_b as well.
        const std::array w{std::array{-p, d(0, 3)}, std::array{d(1, 2), d(1, 3)}};
        bounded on_a[2][2], on_b[2][2];
        for (std::uint8_t i = 0; i < 2; ++i)
            for (std::uint8_t j = 0; j < 2; ++j) {
                const bounded along_a = projection(w[i][j], a), along_b = projection(w[i][j], b);
                on_a[i][j] = i == 0 ? -along_a : along_a;
                on_b[i][j] = j == 0 ? along_b : -along_b;
            }
        for (std::uint8_t i = 0; i < 2; ++i)
            for (std::uint8_t j = 0; j < 2; ++j)
                if (on_a[i][j].is_negative() && on_b[i][j].is_negative())
                    return write.vertices(i, static_cast<std::uint8_t>(2 + j), w[i][j]);
        for (std::uint8_t i = 0; i < 2; ++i) {
            if ((i == 0 ? a1 : a0).is_negative() && on_b[i][0].is_positive() &&
                on_b[i][1].is_positive())
                return write.edge({i, 2, 3}, w[i][0], b, on_b[i][0], 1);
            if ((i == 0 ? b1 : b0).is_negative() && on_a[0][i].is_positive() &&
                on_a[1][i].is_positive())
                return write.edge({static_cast<std::uint8_t>(2 + i), 0, 1}, -w[0][i], a, on_a[0][i],
                                  -1);
        }
        return false;
    }
}

}  // namespace ccd::detail::nearness_filter
