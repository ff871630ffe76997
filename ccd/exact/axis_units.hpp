// Converts coordinates to integers, with a power of two as unit for each axis. So integers need few
// bits even if one axis is much smaller than the others. Units scale all equations of a contact by
// positive factors, so contact does not depend on them. Proof: proofs/contact/AxisUnits.v,
// face_units, edges_units, vertex_edge_units.
#pragma once

#include <algorithm>
#include <ccd/methods/transform.hpp>
#include <errbound/integers/binary_double.hpp>
#include <errbound/integers/fixed_integer.hpp>
#include <limits>

namespace ccd::detail {

struct axis_extent {
    int unit = 0;  ///< 2^unit divides every coordinate
    int bits = 0;  ///< coordinates at one end of the step differ by less than 2^bits units
    bool finite = true;

    template <class Points>
    constexpr axis_extent(const Points& points, double point<double>::*axis) {
        int last = std::numeric_limits<int>::max();
        double low0 = points[0].t0.*axis, high0 = low0, low1 = points[0].t1.*axis, high1 = low1;
        for (const auto& p : points) {
            const double x0 = p.t0.*axis, x1 = p.t1.*axis;
            const errbound::integers::binary_double d0(x0), d1(x1);
            last = std::min({last, d0.last_bit(), d1.last_bit()});
            finite = finite && d0.exponent != errbound::integers::binary_double::not_finite &&
                     d1.exponent != errbound::integers::binary_double::not_finite;
            low0 = std::min(low0, x0), high0 = std::max(high0, x0);
            low1 = std::min(low1, x1), high1 = std::max(high1, x1);
        }
        // Rounding is monotone, so an exact difference is below every power of two that exceeds the
        // rounded one. If it overflows, it is below 2^1025, and end_bit() is 1025. Proof:
        // proofs/integers/IntegerUnits.v, extent_bits_enough.
        const errbound::integers::binary_double extent(std::max(high0 - low0, high1 - low1));
        if (last == std::numeric_limits<int>::max()) return;  // all coordinates are zero
        unit = last;
        bits = std::max(0, extent.end_bit() - unit);
    }
};

struct integer_units {
    axis_extent x, y, z;

    template <class Query>
    explicit constexpr integer_units(const Query& query) : integer_units(points_of(query), 0) {}

    constexpr bool finite() const { return x.finite && y.finite && z.finite; }
    /// Coordinates of an axis at one end of the step differ by less than 2^bits() units.
    constexpr int bits() const { return std::max({x.bits, y.bits, z.bits}); }

    /// Returns these with one unit for all axes, as distances need.
    constexpr integer_units with_common_unit() const {
        integer_units common = *this;
        const int unit = std::min({x.unit, y.unit, z.unit});
        for (axis_extent* axis : {&common.x, &common.y, &common.z}) {
            if (axis->bits > 0) axis->bits += axis->unit - unit;
            axis->unit = unit;
        }
        return common;
    }

    /// Replaces every coordinate x by convert(x, unit), that is x/2^unit.
    template <class Query, class Convert>
    constexpr auto converted(const Query& query, const Convert& convert) const {
        return transformed_points(query, [&](const point<double>& p) {
            return point<decltype(convert(p.x, x.unit))>{convert(p.x, x.unit), convert(p.y, y.unit),
                                                         convert(p.z, z.unit)};
        });
    }
    /// Converts to integers of Words words, modulo their width. Differences at one end of the step
    /// are exact if bits() < 64·Words. Proof: proofs/integers/IntegerUnits.v,
    /// difference_in_units_exact.
    template <int Words, class Query>
    constexpr auto converted(const Query& query) const {
        return converted(query, [](double x, int unit) { return in_units<Words>(x, unit); });
    }

  private:
    template <class Points>
    constexpr integer_units(const Points& points, int)
        : x(points, &point<double>::x),
          y(points, &point<double>::y),
          z(points, &point<double>::z) {}

    template <int Words>
    static constexpr errbound::integers::fixed_integer<Words> in_units(double coordinate,
                                                                       int unit) {
        const errbound::integers::binary_double d(coordinate);
        const int shift = d.exponent - unit;  // negative: the bits shifted out are zeros
        const auto size = errbound::integers::fixed_integer<Words>::shifted(
            d.magnitude >> std::clamp(-shift, 0, 63), std::max(shift, 0));
        return d.negative ? -size : size;
    }
};

}  // namespace ccd::detail
