// Checks nearest features, points, distances and normals by rationals, with separate formulas: the
// distance of all pairs of features whose feet are inside, compared as fractions.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/kind.hpp>
#include <ccd/nearness.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/nearest_points.hpp"

namespace support::nearness_data {

/// The feet with the least distance of the smallest features, the first of these.
template <ccd::kind K>
feet<rational> nearest(const std::vector<vector<rational>>& at) {
    const auto all = features_of<K>();
    feet<rational> best(all[0], at);
    for (std::size_t i = 1; i < all.size(); ++i) {
        feet<rational> next(all[i], at);
        if (next.inside() && next.square * best.divisor < best.square * next.divisor)
            best = std::move(next);
    }
    constexpr std::uint8_t first = ccd::kind_traits<K>::first_vertices;
    if (best.features.kind == ccd::kind::vertex_edge && best.features.points[0] >= first)
        best.between = rational(-1) * best.between;
    return best;
}

/// Checks nearness_of(query, t) = found, and collects the faults.
template <class Query>
class check {
    static constexpr std::size_t first = ccd::kind_traits<ccd::kind_of<Query>>::first_vertices;
    static constexpr double most = 0x1p-24;  ///< the largest error

  public:
    check(const Query& query, double t, const ccd::nearness& found)
        : found_(found), exact_(nearest<ccd::kind_of<Query>>(moment(query, rational(t)).at)) {
        if (found.features != exact_.features) fault("not the nearest features");
        check_weights();
        const rational square = exact_.square / exact_.divisor;
        check_square(square);
        check_distance(square);
        if (found.touches() != (exact_.square == 0)) fault("touches wrongly");
        if (exact_.square != 0)
            check_normal();
        else if (found.normal != ccd::point<double>{} || std::isfinite(found.normal_error))
            fault("a normal without distance");
    }
    const std::string& faults() const { return faults_; }

  private:
    void fault(const std::string& text) { faults_ += text + "; "; }

    void check_weights() {
        faults_ += faults_of_weights(found_.weights, first);
        for (std::size_t i = 0; i < 4; ++i) {
            const rational off = rational(found_.weights[i]) * exact_.divisor - exact_.weights[i];
            if (abs(off) > rational(found_.weight_error) * exact_.divisor) fault("weight off");
        }
        if (!(found_.weight_error <= most)) fault("weight error too large");
    }

    static bool is_accurate(double value, double error) {
        return error <= most * value || (value < 0x1p-1000 && error <= 0x1p-1024);
    }
    void check_square(const rational& square) {
        const double value = found_.squared_distance, error = found_.squared_distance_error;
        if (!std::isfinite(value)) {
            if (std::isfinite(error) || square < power_of(2, 1023)) fault("no overflow");
            return;
        }
        if (abs(rational(value) - square) > rational(error)) fault("squared distance off");
        if (!is_accurate(value, error)) fault("error of the squared distance too large");
    }
    void check_distance(const rational& square) {
        const double value = found_.distance, error = found_.distance_error;
        if (!std::isfinite(value)) {
            if (std::isfinite(error) || square < power_of(2, 2046)) fault("no overflow");
            return;
        }
        const rational least = rational(value) - rational(error),
                       largest = rational(value) + rational(error);
        if ((least > 0 && least * least > square) || largest * largest < square)
            fault("distance off");
        if (!is_accurate(value, error)) fault("error of the distance too large");
    }
    void check_normal() {
        const auto off = of<real>(found_.normal) - unit(exact_.between);
        if (dot(off, off) > real(found_.normal_error) * real(found_.normal_error))
            fault("normal off");
        if (!(found_.normal_error <= most)) fault("error of the normal too large");
    }

    const ccd::nearness& found_;
    feet<rational> exact_;
    std::string faults_;
};

/// Returns the faults; "" if there are none.
template <class Query>
std::string faults_of(const Query& query, double t, const ccd::nearness& found) {
    return check(query, t, found).faults();
}

}  // namespace support::nearness_data
