// Checks nearest features, points, distances and normals by whole numbers, with separate formulas:
// the distance of all pairs of features whose feet are inside, compared as fractions.
#pragma once

#include <algorithm>
#include <array>
#include <boost/multiprecision/gmp.hpp>
#include <ccd/kind.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/nearness.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/nearest_points.hpp"

namespace support::nearness_data {

namespace mp = boost::multiprecision;
using whole = mp::number<mp::gmp_int, mp::et_off>;
using rational = mp::number<mp::gmp_rational, mp::et_off>;
using real = mp::number<mp::gmp_float<60>, mp::et_off>;

/// 2^exponent
inline rational power(int exponent) {
    const whole size = whole(1) << static_cast<unsigned>(std::abs(exponent));
    return exponent < 0 ? rational(1) / rational(size) : rational(size);
}

/// The points of a query at t, times 2^-unit·`factor`.
struct positions {
    std::vector<vector<whole>> at;
    int unit = std::numeric_limits<int>::max();
    whole factor;

    template <class Query>
    positions(const Query& query, double t) {
        int n_unit;
        const auto n = static_cast<std::int64_t>(std::ldexp(std::frexp(t, &n_unit), 53));
        n_unit = t == 0 ? 0 : n_unit - 53;
        factor = whole(1) << static_cast<unsigned>(std::max(-n_unit, 0));
        const whole late = whole(n) << static_cast<unsigned>(std::max(n_unit, 0));
        const whole early = factor - late;
        ccd::for_each_coordinate(query, [&](double x) {
            int e;
            if (std::frexp(x, &e) != 0) unit = std::min(unit, e - 53);
        });
        const auto in_units = [&](double x) {
            int e;
            const auto head = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &e), 53));
            return head == 0 ? whole(0) : whole(head) << static_cast<unsigned>(e - 53 - unit);
        };
        for (const auto& p : ccd::points_of(query)) {
            const auto between = [&](double x0, double x1) {
                return late == 0 ? whole(factor * in_units(x0))
                                 : whole(early * in_units(x0) + late * in_units(x1));
            };
            at.push_back(
                {between(p.t0.x, p.t1.x), between(p.t0.y, p.t1.y), between(p.t0.z, p.t1.z)});
        }
        if (unit == std::numeric_limits<int>::max()) unit = 0;
    }
};

/// The feet with the least distance of the smallest features, the first of these.
template <ccd::kind K>
feet<whole> nearest(const std::vector<vector<whole>>& at) {
    const auto all = features_of<K>();
    feet<whole> best(all[0], at);
    for (std::size_t i = 1; i < all.size(); ++i) {
        feet<whole> next(all[i], at);
        if (next.inside() && next.square * best.divisor < best.square * next.divisor)
            best = std::move(next);
    }
    constexpr std::uint8_t first = ccd::kind_traits<K>::first_vertices;
    if (best.features.kind == ccd::kind::vertex_edge && best.features.points[0] >= first)
        best.between = whole(-1) * best.between;
    return best;
}

/// Checks nearness_of(query, t) = found, and collects the faults.
template <class Query>
class check {
    static constexpr std::size_t first = ccd::kind_traits<ccd::kind_of<Query>>::first_vertices;
    static constexpr double most = 0x1p-24;  ///< the largest error

  public:
    check(const Query& query, double t, const ccd::nearness& found)
        : found_(found), at_(query, t), exact_(nearest<ccd::kind_of<Query>>(at_.at)) {
        if (found.features != exact_.features) fault("not the nearest features");
        check_weights();
        const rational square = rational(exact_.square) /
                                rational(exact_.divisor * at_.factor * at_.factor) *
                                power(2 * at_.unit);
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
            if (std::isfinite(error) || square < power(1023)) fault("no overflow");
            return;
        }
        if (abs(rational(value) - square) > rational(error)) fault("squared distance off");
        if (!is_accurate(value, error)) fault("error of the squared distance too large");
    }
    void check_distance(const rational& square) {
        const double value = found_.distance, error = found_.distance_error;
        if (!std::isfinite(value)) {
            if (std::isfinite(error) || square < power(2046)) fault("no overflow");
            return;
        }
        const rational least = rational(value) - rational(error),
                       largest = rational(value) + rational(error);
        if ((least > 0 && least * least > square) || largest * largest < square)
            fault("distance off");
        if (!is_accurate(value, error)) fault("error of the distance too large");
    }
    void check_normal() {
        whole largest = 0;
        for (const whole& x : exact_.between) largest = std::max(largest, whole(abs(x)));
        const auto in_largest = [&](std::size_t k) {
            return real(rational(exact_.between[k]) / rational(largest));
        };
        const std::array q{in_largest(0), in_largest(1), in_largest(2)};
        const real length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]);
        const auto off = [&](double n, std::size_t k) {
            const real difference = real(n) - q[k] / length;
            return real(difference * difference);
        };
        const auto& [x, y, z] = found_.normal;
        if (off(x, 0) + off(y, 1) + off(z, 2) >
            real(found_.normal_error) * real(found_.normal_error))
            fault("normal off");
        if (!(found_.normal_error <= most)) fault("error of the normal too large");
    }

    const ccd::nearness& found_;
    positions at_;
    feet<whole> exact_;
    std::string faults_;
};

/// Returns the faults; "" if there are none.
template <class Query>
std::string faults_of(const Query& query, double t, const ccd::nearness& found) {
    return check(query, t, found).faults();
}

}  // namespace support::nearness_data
