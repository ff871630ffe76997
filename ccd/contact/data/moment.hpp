// The points of a query at a time given by a bracket: enclosures of differences and velocities.
// Internal.
//
// Uses the rule `residual`, because plain bounds would be some ten times as wide as the bracket.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/kind.hpp>
#include <ccd/methods/forms.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <errbound/number_traits.hpp>
#include <errbound/rules/residual.hpp>
#include <errbound/sign.hpp>
#include <errbound/tracked.hpp>

namespace ccd::detail {

using enclosure = errbound::tracked<double, errbound::residual>;
using enclosed_vector = vector_form<enclosure, 0>;
using point_numbers = std::array<std::uint8_t, 4>;

inline enclosed_vector operator+(const enclosed_vector& p, const enclosed_vector& q) {
    return {p.x + q.x, p.y + q.y, p.z + q.z};
}
inline enclosed_vector operator-(const enclosed_vector& p, const enclosed_vector& q) {
    return {p.x - q.x, p.y - q.y, p.z - q.z};
}
inline enclosed_vector operator*(const enclosure& factor, const enclosed_vector& p) {
    const errbound::bernstein<enclosure, 0> f{{factor}};
    return {f * p.x, f * p.y, f * p.z};
}
inline enclosed_vector operator-(const enclosed_vector& p) {
    return {-p.x, -p.y, -p.z};
}
inline std::array<enclosure, 3> components(const enclosed_vector& p) {
    return {p.x[0], p.y[0], p.z[0]};
}
inline double size(const enclosed_vector& p) {
    double largest = 0;
    for (const enclosure& x : components(p)) largest = std::max(largest, std::abs(x.value()));
    return largest;
}
inline enclosed_vector scaled(const enclosed_vector& p, int e) {
    if (e == 0) return p;
    return {{{scale(p.x[0], e)}}, {{scale(p.y[0], e)}}, {{scale(p.z[0], e)}}};
}

inline enclosure enclosed_time(const first_time& time) {
    const double width = time.high - time.low, half = width / 2;
    return enclosure(time.low) + enclosure::within(half, width - half);  // half may underflow
}

struct relative_motion {
    enclosed_vector position, velocity;

    friend relative_motion operator-(const relative_motion& p, const relative_motion& q) {
        return {p.position - q.position, p.velocity - q.velocity};
    }
    friend relative_motion operator*(const enclosure& factor, const relative_motion& p) {
        return {factor * p.position, factor * p.velocity};
    }
};
inline bool certainly_not_zero(const enclosed_vector& p) {
    return std::ranges::any_of(components(p), [](const enclosure& x) {
        const auto sign = sign_of(x);
        return errbound::certain(sign) && sign != errbound::sign_type::zero;
    });
}

/// Returns e with 2^(e−1) <= size < 2^e, or 0 if |e| <= moderate.
inline int excess_exponent(double size, int moderate) {
    const int e = size > 0 ? errbound::number_traits<double>::exponent(size) : 0;
    return std::abs(e) > moderate ? e : 0;
}

/// The points of one query at a time given by a bracket, all scaled by one power of two.
class contact_moment {
  public:
    template <class Query>
    contact_moment(const Query& query, const first_time& time) : t_(enclosed_time(time)) {
        double largest = 0;
        for_each_coordinate(query, [&](double x) { largest = std::max(largest, std::abs(x)); });
        exponent_ = excess_exponent(largest, 32);
        const auto points = points_of(query);
        for (std::size_t i = 0; i < points.size(); ++i)
            points_[i] = {enclosed(points[i].t0), enclosed(points[i].t1)};
    }

    /// Positions and velocities are divided by 2^exponent().
    int exponent() const { return exponent_; }

    /// Subtracts first, because differences are small and exact, then interpolates in time.
    relative_motion relative(std::size_t point, std::size_t to) const {
        const auto way = difference(points_[point], points_[to]);
        const enclosed_vector start = coefficient(way, 0);
        const enclosed_vector velocity = coefficient(way, 1) - start;
        return {start + t_ * velocity, velocity};
    }

    double squared_distance(std::size_t point, std::size_t to) const {
        const double t = t_.value();
        const auto square = [t](const enclosure& p0, const enclosure& p1, const enclosure& q0,
                                const enclosure& q1) {
            const double start = p0.value() - q0.value(), end = p1.value() - q1.value();
            const double between = start + t * (end - start);
            return between * between;
        };
        const auto &p = points_[point], &q = points_[to];
        return square(p.t0.x, p.t1.x, q.t0.x, q.t1.x) + square(p.t0.y, p.t1.y, q.t0.y, q.t1.y) +
               square(p.t0.z, p.t1.z, q.t0.z, q.t1.z);
    }

  private:
    point<enclosure> enclosed(const point<double>& p) const {
        const auto in_unit = [this](double x) {
            return exponent_ == 0 ? enclosure(x) : scale(enclosure(x), -exponent_);
        };
        return {in_unit(p.x), in_unit(p.y), in_unit(p.z)};
    }

    std::array<moving_point<enclosure>, 4> points_;
    enclosure t_;
    int exponent_ = 0;
};

}  // namespace ccd::detail
