// A floating-point filter for "the features come within a distance d". Internal.
//
// Bisects the step. The direction between the nearest points at the middle of a part is an axis. If
// it separates the features by more than d at both ends of the part, it does so throughout. If the
// two points are certainly nearer than d, the query collides. Errors of the nearest points do not
// affect certainty. Proof that the ends suffice: proofs/times/Separation.v, face_apart,
// edges_apart.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/kind.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>
#include <cmath>
#include <cstddef>
#include <limits>

namespace ccd::detail::separation_filter {

using vector = point<double>;

constexpr vector operator+(const vector& a, const vector& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr vector operator-(const vector& a, const vector& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr vector operator*(double s, const vector& a) {
    return {s * a.x, s * a.y, s * a.z};
}
constexpr double dot(const vector& a, const vector& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Returns s/t clamped to [0, 1]; 0 if t is 0.
inline double part_of(double s, double t) {
    return s > 0 ? (s < t ? s / t : 1) : 0;
}

/// Approximates the point nearest to the origin on the segment p + s·e, 0 <= s <= 1.
inline vector from_segment(const vector& p, const vector& e) {
    return p + part_of(-dot(p, e), dot(e, e)) * e;
}

/// Returns the difference of a point of the second feature and one of the first. They may miss the
/// nearest points, but lie on the features up to rounding. x is in the order of points_of.
inline vector nearest(const std::array<vector, 2>& x) {
    return x[1] - x[0];
}
inline vector nearest(const std::array<vector, 3>& x) {
    return from_segment(x[1] - x[0], x[2] - x[1]);
}
template <kind K>
vector nearest(const std::array<vector, 4>& x) {
    if constexpr (K == kind::vertex_face) {
        // Inside the face, if the weights show it; else on an edge (Ericson 2005, 5.1.5).
        const vector p = x[1] - x[0], b = x[2] - x[1], c = x[3] - x[1];
        const double bb = dot(b, b), bc = dot(b, c), cc = dot(c, c), pb = -dot(p, b),
                     pc = -dot(p, c);
        const double whole = bb * cc - bc * bc, v = cc * pb - bc * pc, w = bb * pc - bc * pb;
        if (v > 0 && w > 0 && v + w < whole) {
            const double s = v / whole, t = w / whole;
            if (s + t < 1) return p + (s * b + t * c);
        }
        const vector candidates[] = {from_segment(p, b), from_segment(p, c),
                                     from_segment(p + b, c - b)};
        return *std::min_element(
            std::begin(candidates), std::end(candidates),
            [](const vector& g, const vector& h) { return dot(g, g) < dot(h, h); });
    } else {
        // Ericson 2005, 5.1.9.
        const vector a = x[1] - x[0], b = x[3] - x[2], p = x[2] - x[0];
        const double aa = dot(a, a), bb = dot(b, b), ab = dot(a, b), ap = dot(a, p), bp = dot(b, p);
        double s = part_of(ap * bb - ab * bp, aa * bb - ab * ab);
        const double on_b = s * ab - bp;
        const double u = part_of(on_b, bb);
        if (on_b <= 0 || on_b >= bb) s = part_of(u * ab + ap, aa);
        return p + (u * b - s * a);
    }
}

template <class Query>
class features {
    static constexpr kind K = kind_of<Query>;
    static constexpr std::size_t first = kind_traits<K>::first_vertices;
    static constexpr std::size_t count = first + kind_traits<K>::second_vertices;
    static constexpr double epsilon = std::numeric_limits<double>::epsilon();

  public:
    /// Preconditions: coordinates are finite and thicknesses >= 0.
    features(const Query& query, separation d) {
        const auto points = points_of(query);
        const vector origin = points[0].t0;
        vector largest{};
        for (std::size_t i = 0; i < count; ++i) {
            start_[i] = points[i].t0 - origin;
            end_[i] = points[i].t1 - origin;
            for (const vector& x : {start_[i], end_[i]})
                largest = {std::max(largest.x, std::abs(x.x)), std::max(largest.y, std::abs(x.y)),
                           std::max(largest.z, std::abs(x.z))};
        }
        const double unscaled = largest.x + largest.y + largest.z;
        if (!(unscaled > 0 && std::isfinite(unscaled))) return;
        // A power of two is exact, except for underflow far below `tiny`. It keeps products of four
        // factors in range.
        const bool in_range = unscaled > 0x1p-100 && unscaled < 0x1p100;
        const double scale =
            in_range ? 1 : std::ldexp(1, std::clamp(-std::ilogb(unscaled), -1000, 1000));
        for (std::size_t i = 0; i < count; ++i) {
            start_[i] = scale * start_[i];
            end_[i] = scale * end_[i];
        }
        size_ = scale * unscaled;
        const double sum = scale * (d.first + d.second);
        // Rounded away from d, and widened by the errors of the comparisons below.
        above_ = sum * (1 + 24 * epsilon) + 10 * epsilon * size_ + tiny;
        below_ = sum * (1 - 24 * epsilon) - 40 * epsilon * size_ - tiny;
    }

    /// `collides` if they certainly come within d, `separate` if they certainly do not.
    outcome decide() const {
        if (!(above_ < largest_distance)) return outcome::uncertain;
        struct part {
            double low, high;
            int depth;
        };
        std::array<part, max_depth + 2> waiting;
        std::size_t size = 0;
        waiting[size++] = {0, 1, 0};
        while (size > 0) {
            const part now = waiting[--size];
            const double middle = (now.low + now.high) / 2;
            const vector between = nearest_at(middle);
            const double distance = std::sqrt(dot(between, between));
            if (distance < below_) return outcome::collides;
            if (distance > tiny && separated((1 / distance) * between, now.low, now.high)) continue;
            if (comes_near(middle, between, now.low, now.high)) return outcome::collides;
            if (now.depth == max_depth) return outcome::uncertain;
            waiting[size++] = {middle, now.high, now.depth + 1};
            waiting[size++] = {now.low, middle, now.depth + 1};
        }
        return outcome::separate;
    }

    /// True if axes certainly keep the features farther apart than d. Halves the step at most
    /// `halvings` times.
    bool stay_apart(int halvings) const {
        return above_ < largest_distance && stay_apart(0, 1, halvings);
    }

  private:
    static constexpr int max_depth = 10;
    static constexpr double largest_distance = 0x1p300;  ///< in scaled lengths
    static constexpr double tiny = 0x1p-500;  ///< above the square root of a product's underflow

    bool stay_apart(double low, double high, int halvings) const {
        const double middle = (low + high) / 2;
        const vector between = nearest_at(middle);
        const double distance = std::sqrt(dot(between, between));
        if (!(distance > tiny) || distance < below_) return false;
        return separated((1 / distance) * between, low, high) ||
               (halvings > 0 && stay_apart(low, middle, halvings - 1) &&
                stay_apart(middle, high, halvings - 1));
    }

    /// True if two points are certainly nearer than d at one of two estimated times. Each moves t
    /// to where `between` would be shortest if it changed linearly. Precondition: between is
    /// nearest_at(t).
    bool comes_near(double t, vector between, double low, double high) const {
        for (double step = (high - low) / 64; step > (high - low) / 1e6; step /= 1024) {
            const vector change = (1 / step) * (nearest_at(t + step) - between);
            t -= dot(between, change) / dot(change, change);
            if (!(t >= low && t <= high)) return false;
            between = nearest_at(t);
            if (std::sqrt(dot(between, between)) < below_) return true;
        }
        return false;
    }

    /// The error is at most 40ε·size_ in length. Let m be a coordinate's largest size. Positions
    /// are off by 2εm, their differences by 5εm, and these times a number in [0, 1] by 6εm. So
    /// `nearest` is off by at most 30εm, for the edge from p + b along c − b. The factor 1 − 24ε of
    /// below_ covers the rounding of the distance.
    vector nearest_at(double t) const {
        std::array<vector, count> x;
        for (std::size_t i = 0; i < count; ++i) x[i] = (1 - t) * start_[i] + t * end_[i];
        if constexpr (count == 4)
            return nearest<K>(x);
        else
            return nearest(x);
    }

    /// True if the axis, longer than 1 by at most 4ε, separates the features by more than d in the
    /// same order at `low` and `high`. A projection is off by 2.1ε·size_, between the ends of the
    /// step by 3.1ε·size_, a difference of two by 7.3ε·size_. Proof:
    /// proofs/times/SeparationFilter.v, projection_near, separated_right, separated_part,
    /// axis_length, distance_rounded, size_rounded.
    bool separated(const vector& axis, double low, double high) const {
        std::array<double, count> start, end;
        for (std::size_t i = 0; i < count; ++i) {
            start[i] = dot(axis, start_[i]);
            end[i] = dot(axis, end_[i]);
        }
        const auto gap = [&](double t) {
            const auto at = [&](std::size_t i) { return (1 - t) * start[i] + t * end[i]; };
            double greatest = at(0), least = at(first);
            for (std::size_t i = 1; i < first; ++i) greatest = std::max(greatest, at(i));
            for (std::size_t i = first + 1; i < count; ++i) least = std::min(least, at(i));
            return least - greatest;
        };
        return gap(low) > above_ && gap(high) > above_;
    }

    std::array<vector, count> start_, end_;  ///< relative to a point of the first feature, scaled
    double size_ = 0;                        ///< the sum of the largest coordinates' sizes
    double above_ = std::numeric_limits<double>::infinity(), below_ = 0;
};

}  // namespace ccd::detail::separation_filter
