// Nearness in exact integers. Internal.
//
// A point x of a convex set is nearest to the origin if and only if (c − x)·x >= 0 for its corners
// c. Here the set consists of the differences of the features' points. nearest_features tests this
// for vertices, then edges. Nearest points are else inside both features, and N ≠ 0: if N = 0, all
// weights times N·N are 0, so that an edge or a vertex has passed.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/kind.hpp>
#include <ccd/methods/forms.hpp>
#include <ccd/nearness.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <errbound/integers/fixed_integer.hpp>
#include <limits>

#include "ccd/contact/data/meeting.hpp"
#include "ccd/contact/nearness/nearness.hpp"
#include "ccd/exact/unbounded_integers.hpp"

namespace ccd::detail {

template <int Words>
int bit_length(const errbound::integers::fixed_integer<Words>& x) {
    return x.bit_length();
}
inline int bit_length(const integer& x) {
    return x == 0 ? 0 : floor_log2(abs(x)) + 1;
}
template <int Words>
std::int64_t word_from_bit(const errbound::integers::fixed_integer<Words>& x, int bit) {
    return x.word_from_bit(bit);
}
inline std::int64_t word_from_bit(const integer& x, int bit) {
    const auto word = static_cast<std::int64_t>(abs(x) >> bit);
    return x < 0 ? -word : word;
}

/// x/2^exponent, off by less than 1.01u of it (u = 2^-53), except for underflow: bits are cut off
/// after the first 62. Precondition: exponent >= bit_length(x).
template <class Integer>
double in_units(const Integer& x, int exponent) {
    const int cut = std::max(bit_length(x) - 62, 0);
    return std::ldexp(static_cast<double>(word_from_bit(x, cut)), cut - exponent);
}

/// value·2^exponent
struct scaled_double {
    double value;
    int exponent;

    template <class Integer>
    static scaled_double from(const Integer& x) {
        const int e = bit_length(x);
        return {in_units(x, e), e};
    }
    friend scaled_double operator/(const scaled_double& a, const scaled_double& b) {
        return {a.value / b.value, a.exponent - b.exponent};
    }
    double rounded() const { return std::ldexp(value, exponent); }
};

/// The data at positions in units of 2^unit on all axes. If differences of coordinates are below
/// 2^(64·W − 3) in S of W words, all products fit: along() in 2W words, the vector between nearest
/// points times E·E in 3W, weights times N·N in 4W.
template <kind K, class S>
class nearness_in_integers {
    using traits = kind_traits<K>;
    static constexpr std::uint8_t first = traits::first_vertices,
                                  count = first + traits::second_vertices;
    using vector = vector_form<S, 0>;

  public:
    nearness_in_integers(const std::array<vector, count>& points, int unit)
        : points_(points), unit_(unit) {}

    nearness data() const {
        nearness found;
        if constexpr (is_cubic(K)) {
            const auto forms = forms_of_points();
            const auto weights = weights_of(forms);
            found.features = features([&](std::uint8_t i) { return weights[i] <= 0; });
            if (found.features.kind == K)
                set_inside(forms, weights, found);
            else
                set_border(found);
        } else {
            found.features = features([](std::uint8_t) { return false; });
            set_border(found);
        }
        return found;
    }

  private:
    vector difference(std::size_t i, std::size_t j) const {
        const vector &p = points_[i], &q = points_[j];
        return {p.x - q.x, p.y - q.y, p.z - q.z};
    }
    /// (p − q)·(r − q)
    auto along(std::size_t p, std::size_t q, std::size_t r) const {
        return dot(difference(p, q), difference(r, q))[0];
    }

    /// True if q is nearest to p among the points from `begin` to `end`, and their hull.
    bool is_nearest(std::uint8_t q, std::uint8_t p, std::uint8_t begin, std::uint8_t end) const {
        for (std::uint8_t r = begin; r < end; ++r)
            if (r != q && along(p, q, r) > 0) return false;
        return true;
    }
    /// Vertices p, q attain the distance if each is nearest to the other in its feature. Otherwise,
    /// a vertex p and an edge qr do under two conditions. The foot x of p is inside the edge, and
    /// the remaining point s is not nearer: (s − x)·(p − x) <= 0. Let E = r − q, S = s − q, W = p −
    /// q. The product is (E × S)·(E × W)/E·E, the weight of s times N·N/E·E. For two edges, S is
    /// from the other end s of p's edge to p.
    template <class IsOutside>
    meeting_features features(const IsOutside& is_outside) const {
        for (std::uint8_t p = 0; p < first; ++p)
            for (std::uint8_t q = first; q < count; ++q)
                if (is_nearest(p, q, 0, first) && is_nearest(q, p, first, count))
                    return {kind::vertex_vertex, {p, q}};
        if constexpr (is_cubic(K))
            for (const auto& [i, without] : smaller_pairs<K>())
                if (is_outside(without) && along(i[0], i[1], i[2]) > 0 &&
                    along(i[0], i[2], i[1]) > 0)
                    return {kind::vertex_edge, i};
        return whole_query<K>();
    }

    auto forms_of_points() const {
        if constexpr (K == kind::vertex_face)
            return vertex_face_forms<S, 0>(difference(2, 1), difference(3, 1), difference(0, 1));
        else
            return edge_edge_forms<S, 0>(difference(1, 0), difference(3, 2), difference(2, 0));
    }
    /// The weight of each point, times N·N. A vertex's is not used.
    template <class Forms>
    static auto weights_of(const Forms& forms) {
        const auto g = forms.inside();
        if constexpr (K == kind::vertex_face)
            return std::array{g[0][0], g[2][0], g[1][0], g[0][0]};
        else
            return std::array{g[1][0], g[0][0], g[3][0], g[2][0]};
    }

    /// Each weight is off by at most 4u of it, the first of a feature by these and two roundings.
    static constexpr double weight_error = 0x1p-50;

    template <class Forms, class Weights>
    void set_inside(const Forms& forms, const Weights& weights, nearness& into) const {
        const auto n2 = scaled_double::from(forms.normal_squared()[0]);
        set_weights<K>(
            into.features.points,
            [&](std::size_t i) { return (scaled_double::from(weights[i]) / n2).rounded(); }, into);
        into.weight_error = weight_error;
        const auto y = forms.y()[0];
        const bool towards_p = (y > 0) == (K == kind::vertex_face);
        const scaled_double height = scaled_double::from(y);
        set_distance(forms.n, {std::abs(height.value), height.exponent}, true, towards_p, into);
    }
    /// Two vertices, or a vertex and an edge with E·E > 0.
    void set_border(nearness& into) const {
        const auto& i = into.features.points;
        const bool towards_p = i[0] < first;
        const vector w = difference(i[0], i[1]);
        if (into.features.kind == kind::vertex_vertex) {
            into.weights[i[0]] = into.weights[i[1]] = 1;
            into.weight_error = 0;
            return set_distance(w, {1, 0}, false, towards_p, into);
        }
        const vector e = difference(i[2], i[1]);
        const auto ee = dot(e, e), we = dot(w, e);
        const scaled_double divisor = scaled_double::from(ee[0]);
        const double weight = (scaled_double::from(we[0]) / divisor).rounded();
        set_weights<kind::vertex_edge>(
            i, [&](std::size_t) { return weight; }, into);
        into.weight_error = weight_error;
        const vector_form<decltype(ee[0] * w.x[0]), 0> r{ee * w.x - we * e.x, ee * w.y - we * e.y,
                                                         ee * w.z - we * e.z};
        set_distance(r, divisor, false, towards_p, into);
    }

    /// The distance is |n|/other, or other/|n| if n is not the vector between nearest points but
    /// only its direction. |n| is off by 4u of it, so normal and distance are off by 6u.
    template <class Vector>
    void set_distance(const Vector& n, const scaled_double& other, bool is_direction,
                      bool towards_first, nearness& into) const {
        const int e = std::max({bit_length(n.x[0]), bit_length(n.y[0]), bit_length(n.z[0])});
        const double x = in_units(n.x[0], e), y = in_units(n.y[0], e), z = in_units(n.z[0], e);
        const scaled_double length{std::sqrt(x * x + y * y + z * z), e};
        if (length.value == 0 || other.value == 0) {
            into.squared_distance_error = into.distance_error = 0;
            return;
        }
        scaled_double d = is_direction ? other / length : length / other;
        d.exponent += unit_;
        set({d.value * d.value, 2 * d.exponent}, 0x1p-49, into.squared_distance,
            into.squared_distance_error);
        set(d, 0x1p-50, into.distance, into.distance_error);
        const double side = towards_first ? length.value : -length.value;
        into.normal = {x / side, y / side, z / side};
        into.normal_error = 0x1p-50;
    }
    static void set(const scaled_double& x, double relative_error, double& value, double& error) {
        value = x.rounded();
        error = std::isfinite(value)
                    ? relative_error * value + std::numeric_limits<double>::denorm_min()
                    : nearness::unknown;
    }

    std::array<vector, count> points_;
    int unit_;
};

}  // namespace ccd::detail
