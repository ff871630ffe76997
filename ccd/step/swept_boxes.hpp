// Swept boxes, exact and rounded, for the search for candidates.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/contact.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "ccd/batch/rounded_positions.hpp"
#include "ccd/step/trees/box_tree.hpp"

namespace ccd::detail {

constexpr std::size_t sampling_stride(std::size_t count) {
    return 1 + count / 1024;
}

/// The motion until a time t < 1, with rounded ends.
class short_way {
  public:
    /// With `spare`, the error also covers straight ways to the rounded positions that `between`
    /// (ccd/step/advance/advancing.hpp) returns if all vertices have one fraction, at most t.
    /// Preconditions: positions are finite, 0 <= t < 1.
    [[gnu::noinline]] short_way(const vertex_rows& way, double t, bool spare = false)  // g++ warns
        : end_(way, t, spare),
          way_{way.before, end_.positions.data(), way.vertices},
          rounded_(way_) {}

    short_way(const short_way&) = delete;  // it has pointers to itself
    short_way& operator=(const short_way&) = delete;

    batch_positions positions() const { return {way_, rounded_}; }
    /// The largest error of a coordinate at the end.
    double error() const { return end_.error; }
    /// The margin w = 1.0001δ + 4ε of extents along coordinate axes, in units of the rounded
    /// positions: δ is the error in these units, ε = 2^-23. A rounded coordinate has an error of
    /// 1.01ε, and the subtraction of w one of (1.01 + w)ε. So the exact coordinate is at least the
    /// rounded one less w. For sums of two coordinates the margin is 7ε + 2w: their error is
    /// 4.04ε + 2δ, and that of the subtraction (2.02 + 7ε + 2w)ε. The largest margin exceeds all
    /// rounded coordinates, so that it separates nothing.
    /// Proof: proofs/filters/Extents.v, wide_extents_hold, until_face_separate,
    /// until_edges_separate.
    float margin() const {
        if (end_.error == 0) return 0;
        constexpr double largest = 8;  // an infinite one would also widen unused lanes
        return static_cast<float>(std::min(largest, 1.0001 * end_.error * rounded_.scale() +
                                                        4 * std::numeric_limits<float>::epsilon()));
    }

  private:
    /// (1 − t)·x + t·y has four roundings, each of at most u of |(1 − t)·x| + |t·y|, or 2^-1075.
    /// Proof: proofs/filters/Extents.v, after_near.
    /// The spare covers std::lerp and 1024 last places: 2056 times u of the size of x or of the end
    /// of the way until t, or 2^-1064. So an axis that separates a pair at both ends separates it
    /// on the way to each fraction, even after the roundings. Proof: proofs/filters/Extents.v,
    /// shorter_face_separate, shorter_edges_separate.
    struct rounded_end {
        std::vector<double> positions;
        double error = 0;

        rounded_end(const vertex_rows& way, double t, bool spare)
            : positions(way.before, way.before + 3 * way.vertices) {
            if (t == 0) return;
            double half_size = 0, most = 0;
            for (std::size_t i = 0; i < positions.size(); ++i) {
                const double x = way.before[i], y = way.after[i], a = (1 - t) * x, b = t * y;
                positions[i] = std::clamp(a + b, std::min(x, y), std::max(x, y));
                half_size = std::max(half_size, std::abs(a) / 2 + std::abs(b) / 2);
                most = std::max(most, std::abs(x));
            }
            error = 0x1p-50 * half_size + 0x1p-1072;
            if (spare) error += 0x1p-40 * half_size + 0x1p-41 * most + 0x1p-1060;
        }
    };

    rounded_end end_;
    vertex_rows way_;
    rounded_positions rounded_;
};

class swept_boxes {
  public:
    /// Coordinates at the end are off by at most `error`. Keeps a reference to `distances`.
    /// Preconditions: positions are finite, distances valid.
    swept_boxes(const batch_positions& positions, const pair_distances& distances, double error = 0)
        : positions_(positions), distances_(distances), error_(error) {}

    /// The swept box of 1, 2 or 3 vertices. In doubles it is exact. If pairs have a distance, it is
    /// widened by the element's share, rounded outwards: boxes of elements that come within their
    /// distance touch. It is widened by the error, too. Floats serve only without distances and
    /// error, and give the box of rounded positions. Rounding is monotone, so boxes that touch
    /// still do. If rounded boxes touch and no bound of one equals the opposite bound of the other,
    /// the exact boxes touch; if such bounds are equal, use touch(). Proof:
    /// proofs/filters/RoundedAxes.v, swept_rounded_first, swept_face_separate,
    /// swept_edges_separate, swept_boxes_touch.
    template <class Real, std::size_t N>
    box<Real> swept_box(const std::array<vertex_index, N>& element) const {
        box<Real> all;
        const Real* first = row<Real>(element[0], 0);
        for (std::size_t k = 0; k < 3; ++k) all.low[k] = all.high[k] = first[k];
        for (std::size_t i = 0; i < N; ++i)
            for (std::size_t end = i == 0 ? 1 : 0; end < 2; ++end) {
                const Real* x = row<Real>(element[i], end);
                for (std::size_t k = 0; k < 3; ++k) {
                    all.low[k] = std::min(all.low[k], x[k]);
                    all.high[k] = std::max(all.high[k], x[k]);
                }
            }
        if constexpr (std::is_same_v<Real, double>) {
            if (!distances_.is_contact()) widen(all, part_of_distance(element));
            if (error_ > 0) widen(all, error_);
        }
        return all;
    }

    /// True if the closed exact boxes that two elements sweep touch.
    template <std::size_t A, std::size_t B>
    bool touch(const std::array<vertex_index, A>& a, const std::array<vertex_index, B>& b) const {
        const box<double> x = swept_box<double>(a), y = swept_box<double>(b);
        for (std::size_t k = 0; k < 3; ++k)
            if (x.low[k] > y.high[k] || y.low[k] > x.high[k]) return false;
        return true;
    }

    /// True if boxes in floats do not suffice: they have to be widened, which floats do not round
    /// outwards.
    bool need_widening() const { return !distances_.is_contact() || error_ > 0; }
    /// True if floats do not suffice for rounded positions: there are distances; or in a sample,
    /// rounding makes more than one box in sixteen flat on an axis (boxes without the error). The
    /// latter happens for small parts that are very far apart.
    template <std::size_t N>
    bool need_doubles(std::span<const std::array<vertex_index, N>> elements) const {
        if (!distances_.is_contact()) return true;
        const swept_boxes unwidened(positions_, distances_);
        std::size_t confused = 0, samples = 0;
        for (std::size_t i = 0; i < elements.size();
             i += sampling_stride(elements.size()), ++samples) {
            const box<double> exact = unwidened.swept_box<double>(elements[i]);
            const box<float> rounded = swept_box<float>(elements[i]);
            bool merged = false;
            for (std::size_t k = 0; k < 3; ++k)
                merged |= exact.low[k] != exact.high[k] && rounded.low[k] == rounded.high[k];
            confused += merged;
        }
        return confused > samples / 16;
    }

    /// True if in a sample the sizes of the rounded boxes at the start are most of those of the
    /// swept ones. Then the latter suffice to separate elements.
    template <std::size_t N>
    bool nearly_rest(std::span<const std::array<vertex_index, N>> elements) const {
        double swept = 0, at_start = 0;
        for (std::size_t i = 0; i < elements.size(); i += sampling_stride(elements.size())) {
            const box<float> all = swept_box<float>(elements[i]);
            for (std::size_t k = 0; k < 3; ++k) {
                float low = row<float>(elements[i][0], 0)[k], high = low;
                for (const vertex_index v : elements[i]) {
                    low = std::min(low, row<float>(v, 0)[k]);
                    high = std::max(high, row<float>(v, 0)[k]);
                }
                swept += double(all.high[k]) - double(all.low[k]);
                at_start += double(high) - double(low);
            }
        }
        return swept <= 1.03125 * at_start;
    }

  private:
    template <std::size_t N>
    double part_of_distance(const std::array<vertex_index, N>& element) const {
        if (!distances_.thickness.empty()) return distances_.thickness_of(element);
        return above(distances_.all / 2);
    }
    /// At least any real number that rounds to x in some direction; at most the largest double.
    static double above(double x) {
        constexpr double most = std::numeric_limits<double>::max();
        return std::min(std::nextafter(x, std::numeric_limits<double>::infinity()), most);
    }
    /// Proof: proofs/filters/Extents.v, widened_holds, until_boxes_face_separate,
    /// until_boxes_edges_separate.
    static void widen(box<double>& b, double by) {
        for (std::size_t k = 0; k < 3; ++k) {
            b.low[k] = -above(by - b.low[k]);
            b.high[k] = above(b.high[k] + by);
        }
    }

    template <class Real>
    const Real* row(vertex_index v, std::size_t end) const {
        if constexpr (std::is_same_v<Real, double>)
            return (end == 0 ? positions_.exact.before : positions_.exact.after) +
                   3 * std::size_t(v);
        else
            return positions_.rounded + rounded_positions::row * std::size_t(v) + 4 * end;
    }

    batch_positions positions_;
    const pair_distances& distances_;
    double error_;
};

}  // namespace ccd::detail
