// Nearness in doubles, or packs of doubles, with static bounds on the errors. Internal; compiled by
// the rules of ccd/batch/batch_kernels.hpp.
//
// Evaluates the conditions of ccd/contact/nearness/in_integers.hpp. If those of some features hold
// with certain signs and without equality, these features are unique. There are no branches: all
// conditions are evaluated, then the vectors of the features are selected.
#pragma once

#include <ccd/kind.hpp>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "ccd/exact/simd.hpp"

namespace ccd::detail::ERRBOUND_INSTRUCTION_SET {
namespace {

/// Bounds: let u = 2^-53, or more if points move. Each difference of points is a vector v^ with
/// |v^ - v| <= u·size, and |v|, |v^| <= size, of sizes V, W, ... . Then, to first order in u:
///  * dot(v, w) is off by VW (2u + 3u), from both vectors and three roundings in a row.
///  * cross(v, w) is off by VW (2u + 2u).
///  * dot of two cross products of sizes G, H is off by GH (8u + 3u), dot(cross, v) by
///    HV (4u + u + 3u).
///
/// Second-order terms, and roundings of the bounds, are in the constants' last digits. Underflow
/// adds less than `tiny`: sizes are below 2^150, and each operation adds at most 2^-1075. Divisors,
/// and squares of lengths, are above 2^-600, so their own underflow is below 2^-170 of them.
namespace nearness_filter {

constexpr double tiny = 0x1p-700, largest_size = 0x1p150, least_divisor = 0x1p-600;
/// Larger errors are left to the integers: of lengths relative to them, of weights, of the normal.
constexpr double largest_error = 0x1p-26;

inline double select(bool condition, double a, double b) {
    return condition ? a : b;
}
inline double abs(double x) {
    return std::abs(x);
}
inline double sqrt(double x) {
    return std::sqrt(x);
}

template <class R>
using mask_of_number = std::remove_cvref_t<decltype(std::declval<R>() < std::declval<R>())>;

template <class R>
struct vector {
    R x, y, z;
};
template <class R>
vector<R> operator+(const vector<R>& v, const vector<R>& w) {
    return {v.x + w.x, v.y + w.y, v.z + w.z};
}
template <class R>
vector<R> operator-(const vector<R>& v, const vector<R>& w) {
    return {v.x - w.x, v.y - w.y, v.z - w.z};
}
template <class R>
vector<R> operator*(const R& f, const vector<R>& v) {
    return {f * v.x, f * v.y, f * v.z};
}
template <class R>
R dot(const vector<R>& v, const vector<R>& w) {
    return v.x * w.x + v.y * w.y + v.z * w.z;
}
template <class R>
vector<R> cross(const vector<R>& v, const vector<R>& w) {
    return {v.y * w.z - v.z * w.y, v.z * w.x - v.x * w.z, v.x * w.y - v.y * w.x};
}
template <class Mask, class R>
vector<R> select(const Mask& m, const vector<R>& v, const vector<R>& w) {
    return {select(m, v.x, w.x), select(m, v.y, w.y), select(m, v.z, w.z)};
}

/// A difference of two points.
template <class R>
struct difference {
    vector<R> v;
    R size;

    difference operator-() const { return {{-v.x, -v.y, -v.z}, size}; }
};
template <class Mask, class R>
difference<R> select(const Mask& m, const difference<R>& d, const difference<R>& e) {
    return {select(m, d.v, e.v), select(m, d.size, e.size)};
}

/// A number at most `error` away from the exact one.
template <class R>
struct bounded {
    R value, error;

    auto is_positive() const { return value > error; }
    auto is_negative() const { return value < -error; }
    bounded operator-() const { return {-value, error}; }
    friend bounded operator-(const bounded& a, const bounded& b) {
        return {a.value - b.value, a.error + b.error};
    }
};
template <class R>
bounded<R> projection(const difference<R>& d, const difference<R>& e, const R& u) {
    return {dot(d.v, e.v), R(5.1) * u * (d.size * e.size) + R(tiny)};
}

/// Points at rest.
template <class R, std::size_t N>
struct resting_points {
    vector<R> at[N];

    R unit() const { return R(0x1p-53); }
    difference<R> operator()(std::size_t i, std::size_t j) const {
        const vector<R> d = at[i] - at[j];
        return {d, abs(d.x) + abs(d.y) + abs(d.z)};
    }
};

/// Points at t, from differences at both ends, D0 and D1: D0 + t·(D1 - D0) is off by 5·2^-53 of the
/// sum of their sizes: 2 from both, 1 each from D1 - D0, the product and the sum.
template <std::size_t N>
struct moving_points {
    resting_points<double, N> start, end;
    double t;

    double unit() const {
        double most = 1;
        for (std::size_t i = 1; i < N; ++i)
            for (std::size_t j = 0; j < i; ++j) {
                const double ends = start(i, j).size + end(i, j).size;
                if (ends > 0) most = std::fmax(most, 5.1 * ends / (*this)(i, j).size);
            }
        return 0x1p-53 * (most < 0x1p20 ? most : HUGE_VAL);
    }
    difference<double> operator()(std::size_t i, std::size_t j) const {
        const vector<double> d0 = start(i, j).v, d = d0 + t * (end(i, j).v - d0);
        return {d, abs(d.x) + abs(d.y) + abs(d.z)};
    }
};

/// The features of a query are numbered: its pairs of vertices, its pairs of a vertex and an edge,
/// all in the order of ccd::nearness, then the query itself.
template <class R>
struct values {
    R region;         ///< the number, or -1 if features or numbers are not certain
    R first, second;  ///< weights: of an edge's second end; of f1 and f2, or of a1 and b1
    R weight_error, square, square_error, distance, distance_error;
    vector<R> normal;
    R normal_error;
};

/// The vector between nearest points at the border is w + s·f, with s = along/f·f on an edge and 0
/// at a vertex.
template <class R>
struct border {
    R region;
    mask_of_number<R> is_vertex, is_edge;
    difference<R> w, f;
    R along;
};

/// Nearest points inside both features: N and N·N; h = the size of N; Y, negative if the first
/// feature is on the other side of N; weights times N·N.
template <class R>
struct interior {
    mask_of_number<R> holds;
    R region;
    vector<R> n;
    bounded<R> n2, y, first, second;
    R h;
};

/// On an edge, with k = F/|f|: the weight s is off by (5uWF + 5us·FF)/f·f + 2u. Since s|f| <= |w|
/// <= W, the vector is off by less than uW (1 + (5k + 5k² + 2) + k + 1 + 1) <= 17uWk². Inside:
/// weights are off by (their error + that of N·N)/N·N + 2u; the distance |Y|/|N| by (Y's error +
/// 4uh·distance)/|N|. A length from its square, a quotient by a reciprocal: 2.5u + 2u. For vectors
/// p and q, p/|p| and q/|q| are at most |p − q|/m apart, where m is the lesser length; see
/// direction_of in ccd/contact/data/normal.hpp.
template <class R>
values<R> finished(const border<R>& b, const interior<R>& i, const mask_of_number<R>& in_range,
                   const R& u) {
    using mask = mask_of_number<R>;
    const R zero(0.0), one(1.0);
    const R divisor = select(i.holds, i.n2.value, dot(b.f.v, b.f.v)), reciprocal = one / divisor;
    const R excess = b.f.size * b.f.size * reciprocal;
    const R weight = select(b.is_edge, b.along * reciprocal, zero);
    const vector<R> direction = select(i.holds, i.n, b.w.v + weight * b.f.v);
    const R length_squared = dot(direction, direction), length = sqrt(length_squared),
            per_length = one / length;
    const R off = select(i.holds, R(4.1) * u * i.h,
                         u * (b.w.size * select(b.is_edge, R(17.0) * excess, R(1.01))));

    values<R> r;
    r.distance = select(i.holds, abs(i.y.value) * per_length, length);
    r.square = select(i.holds, r.distance * r.distance, length_squared);
    const R error = select(i.holds, R(1.01) * ((i.y.error + r.distance * off) * per_length), off);
    r.distance_error = error + R(5.0) * u * r.distance;
    r.square_error = R(2.1) * (r.distance * error) + R(12.0) * u * r.square;

    r.first = select(i.holds, i.first.value * reciprocal, weight);
    r.second = i.second.value * reciprocal;
    const R of_weights = select(i.holds, i.first.error + i.second.error + R(2.0) * i.n2.error,
                                R(5.1) * u * (b.f.size * (b.w.size + b.f.size)));
    r.weight_error = select(b.is_vertex, zero, R(1.01) * (of_weights * reciprocal) + R(7.0) * u);

    r.normal = select(i.holds & (i.y.value < zero), -per_length, per_length) * direction;
    r.normal_error = R(1.01) * (off * per_length) + R(5.0) * u;

    const mask certain =
        in_range & (r.square > R(least_divisor)) & (error < R(largest_error) * r.distance) &
        (r.normal_error < R(largest_error)) & (r.weight_error < R(largest_error)) &
        (b.is_vertex | ((divisor > R(least_divisor)) & ((i.holds & (abs(i.y.value) > i.y.error)) |
                                                        (b.is_edge & (excess < R(0x1p20))))));
    r.region = select(certain, select(i.holds, i.region, b.region), R(-1.0));
    return r;
}

/// N = b × c and products of ccd/methods/forms.hpp.
template <class R>
struct bounded_forms {
    difference<R> b, c, p;
    R u;
    vector<R> n = cross(b.v, c.v);
    R h = b.size * c.size;
    bounded<R> n2{dot(n, n), error_of(h)};

    bounded<R> y() const { return {dot(n, p.v), R(8.2) * u * (h * p.size) + R(tiny)}; }
    bounded<R> weight(const difference<R>& v, const difference<R>& w) const {
        return {dot(cross(v.v, w.v), n), error_of(v.size * w.size)};
    }
    auto in_range() const { return b.size + c.size + p.size < R(largest_size); }

  private:
    /// Sums of up to three such terms are rounded twice more.
    R error_of(const R& size) const { return R(13.2) * u * (size * h) + R(tiny); }
};

/// Selects in turn: set(mask, value) replaces the value where the mask holds.
template <class Mask, class T>
void set(T& value, const Mask& where, const T& other) {
    value = select(where, other, value);
}

template <class R, class D>
values<R> face_values(const D& d) {
    using mask = mask_of_number<R>;
    const R u = d.unit();
    const bounded_forms<R> form{d(2, 1), d(3, 1), d(0, 1), u};
    const auto &b = form.b, &c = form.c, &p = form.p;
    const auto w2 = form.weight(b, p), w1 = form.weight(p, c), w0 = form.n2 - w1 - w2;
    const mask inside = w0.is_positive() & w1.is_positive() & w2.is_positive();
    // Named by the corners from which, and to which they go.
    const auto e = d(3, 2), q = d(0, 2), r = d(0, 3);
    const auto s01 = projection(p, b, u), s02 = projection(p, c, u), s10 = -projection(q, b, u),
               s12 = projection(q, e, u), s20 = -projection(r, c, u), s21 = -projection(r, e, u);
    const mask f1 = s10.is_negative() & s12.is_negative(),
               f2 = s20.is_negative() & s21.is_negative(),
               f0 = s01.is_negative() & s02.is_negative();
    const mask f01 = w2.is_negative() & s01.is_positive() & s10.is_positive(),
               f12 = w0.is_negative() & s12.is_positive() & s21.is_positive(),
               f20 = w1.is_negative() & s20.is_positive() & s02.is_positive();
    border<R> at{R(0.0), mask(f0 | f1 | f2), mask(f01 | f12 | f20), p, -b, s01.value};
    const mask from_f1 = f1 | f12, from_f2 = f2 | f20;
    set(at.w, from_f1, q);
    set(at.w, from_f2, r);
    set(at.f, from_f1, -e);
    set(at.f, from_f2, c);
    set(at.along, from_f1, s12.value);
    set(at.along, from_f2, s20.value);
    set(at.region, from_f1, R(1.0));
    set(at.region, from_f2, R(2.0));
    set(at.region, at.is_edge, at.region + R(3.0));
    return finished(at, interior<R>{inside, R(6.0), form.n, form.n2, form.y(), w1, w2, form.h},
                    mask(form.in_range()), u);
}

template <class R, class D>
values<R> edges_values(const D& d) {
    using mask = mask_of_number<R>;
    const R u = d.unit();
    const bounded_forms<R> form{d(1, 0), d(3, 2), d(2, 0), u};
    const auto &a = form.b, &b = form.c, &p = form.p;
    const auto a1 = form.weight(p, b), b1 = form.weight(p, a), a0 = form.n2 - a1, b0 = form.n2 - b1;
    const mask inside = a0.is_positive() & a1.is_positive() & b0.is_positive() & b1.is_positive();
    // wij: from b_j to a_i. aij: position of b_j on edge a from a_i. bij: of a_i on b from b_j.
    const auto w00 = -p, w01 = d(0, 3), w10 = d(1, 2), w11 = d(1, 3);
    const auto a00 = -projection(w00, a, u), a01 = -projection(w01, a, u),
               a10 = projection(w10, a, u), a11 = projection(w11, a, u),
               b00 = projection(w00, b, u), b01 = -projection(w01, b, u),
               b10 = projection(w10, b, u), b11 = -projection(w11, b, u);
    const mask c00 = a00.is_negative() & b00.is_negative(),
               c01 = a01.is_negative() & b01.is_negative(),
               c10 = a10.is_negative() & b10.is_negative(),
               c11 = a11.is_negative() & b11.is_negative();
    const mask a0_b = a1.is_negative() & b00.is_positive() & b01.is_positive(),
               a1_b = a0.is_negative() & b10.is_positive() & b11.is_positive(),
               b0_a = b1.is_negative() & a00.is_positive() & a10.is_positive(),
               b1_a = b0.is_negative() & a01.is_positive() & a11.is_positive();
    border<R> at{R(0.0),   mask(c00 | c01 | c10 | c11), mask(a0_b | a1_b | b0_a | b1_a), w00, -b,
                 b00.value};
    const mask from_01 = c01 | b1_a, from_10 = c10 | a1_b, on_a = b0_a | b1_a;
    set(at.w, from_01, w01);
    set(at.w, from_10, w10);
    set(at.w, c11, w11);
    set(at.f, on_a, a);
    set(at.along, a1_b, b10.value);
    set(at.along, b0_a, a00.value);
    set(at.along, b1_a, a01.value);
    set(at.region, c01, R(1.0));
    set(at.region, c10, R(2.0));
    set(at.region, c11, R(3.0));
    set(at.region, a0_b, R(4.0));
    set(at.region, a1_b, R(5.0));
    set(at.region, b0_a, R(6.0));
    set(at.region, b1_a, R(7.0));
    return finished(at, interior<R>{inside, R(8.0), form.n, form.n2, -form.y(), a1, b1, form.h},
                    mask(form.in_range()), u);
}

/// The nearest features of kind K. d(i, j) is the difference of its points i and j.
template <kind K, class R, class D>
values<R> values_of(const D& d) {
    if constexpr (K == kind::vertex_face) {
        return face_values<R>(d);
    } else if constexpr (K == kind::edge_edge) {
        return edges_values<R>(d);
    } else {
        using mask = mask_of_number<R>;
        const R u = d.unit();
        const difference<R> w = d(0, 1);
        const mask in_range = w.size < R(largest_size);
        const mask never(false);
        const interior<R> none{never,
                               w.size,
                               w.v,
                               {w.size, w.size},
                               {w.size, w.size},
                               {w.size, w.size},
                               {w.size, w.size},
                               w.size};
        if constexpr (K == kind::vertex_vertex) {
            return finished(border<R>{R(0.0), !never, never, w, w, w.size}, none, in_range, u);
        } else {
            const auto e = d(2, 1), q = d(0, 2);
            const auto s0 = projection(w, e, u), s1 = -projection(q, e, u);
            const mask to_e0 = s0.is_negative(), to_e1 = s1.is_negative(),
                       to_edge = s0.is_positive() & s1.is_positive();
            border<R> at{R(0.0), mask(to_e0 | to_e1), to_edge, w, -e, s0.value};
            set(at.w, to_e1, q);
            set(at.region, to_e1, R(1.0));
            set(at.region, to_edge, R(2.0));
            return finished(at, none, mask(in_range & (e.size < R(largest_size))), u);
        }
    }
}

}  // namespace nearness_filter
}  // namespace
}  // namespace ccd::detail::ERRBOUND_INSTRUCTION_SET
