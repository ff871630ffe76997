// Rounding errors in a number format, bounded by doubles. Internal.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <errbound/validation/worst_case.hpp>
#include <limits>
#include <utility>

#include "errbound/validation/worst_case/range.hpp"

namespace errbound::validation {

using std::size_t;
inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double doubles_underflow = std::numeric_limits<double>::denorm_min();

struct number_format {
    int digits = 0, min_exponent = 0;
    double largest = 0;
    int function_digits = 0, function_min_exponent = 0;  ///< of the type that computes functions
    std::array<double, named_functions.size()> units{};  ///< function_error in that type

    template <class T>
    static number_format of(double units) {
        using wide = detail::function_type<T>;
        number_format f{number_traits<T>::digits,
                        number_traits<T>::min_exponent,
                        static_cast<double>(number_traits<T>::largest()),
                        number_traits<wide>::digits,
                        number_traits<wide>::min_exponent,
                        {}};
        if constexpr (!fits_double<T>) f.largest = std::numeric_limits<double>::max();
        [&]<size_t... I>(std::index_sequence<I...>) {
            ((f.units[I] =
                  units > 0 ? units : function_error<static_cast<elementary_function>(I), wide>),
             ...);
        }
        (std::make_index_sequence<named_functions.size()>());
        return f;
    }
    bool is_double() const { return digits == std::numeric_limits<double>::digits; }

    /// The error of rounding any |x| <= most to nearest with `d` digits. The second case: just
    /// above a power of two, which is a number of the format, the distance from it counts.
    static double half_ulp(double most, int d, int least_exponent) {
        if (!(most > 0)) return 0;
        if (!(most < infinity)) return infinity;
        int e = 0;
        const bool power = std::frexp(most, &e) == 0.5;
        const auto half = [&](int exponent) {
            return std::ldexp(1, std::max(std::max(exponent, least_exponent) - d - 1, -1074));
        };
        if (power || e <= least_exponent) return half(power ? e - 1 : e);
        return std::max(half(e - 1), std::min(half(e), most - std::ldexp(1, e - 1)));
    }
    double half_ulp(double most) const { return half_ulp(most, digits, min_exponent); }
    /// The largest distance to x of numbers that are rounded to x.
    double half_ulp_beyond(double x) const {
        int e = min_exponent;
        if (x != 0) std::frexp(x, &e);
        return std::ldexp(1, std::max(std::max(e, min_exponent) - digits - 1, -1074));
    }
    /// The least number of the format that is >= x. Precondition: 0 <= x <= largest.
    double rounded_up(double x) const {
        if (x == 0 || digits >= std::numeric_limits<double>::digits) return x;
        const int unit = std::max(std::ilogb(x) + 1, min_exponent) - digits;
        return std::ldexp(std::ceil(std::ldexp(x, -unit)), unit);
    }
    /// k units in the last place of any |x| <= most.
    double function_error_of(elementary_function f, double most) const {
        const double k = units[static_cast<size_t>(f)];
        int e = 0;
        std::frexp(most, &e);
        const double unit =
            std::ldexp(1, std::max(std::max(e, function_min_exponent) - function_digits, -1074));
        const double own = k > 0 ? k * unit * (1 + 0x1p-50) + doubles_underflow : infinity;
        return digits == function_digits ? own : own + half_ulp((most + own) * (1 + 0x1p-50));
    }
    /// The number of the format nearest to x; x if the format has at least a double's digits.
    double nearest(double x) const {
        if (digits >= std::numeric_limits<double>::digits || x == 0 || !std::isfinite(x)) return x;
        const int unit = std::max(std::ilogb(x) + 1, min_exponent) - digits;
        return std::ldexp(std::nearbyint(std::ldexp(x, -unit)), unit);
    }
    /// g such that all numbers of the format in x are multiples of 2^g.
    int grid_of(const range& x) const {
        int e = min_exponent;
        if (x.least() > 0) std::frexp(x.least(), &e);
        return std::max(e, min_exponent) - digits;
    }
};

inline bool is_power_of_two(double x) {
    int e = 0;
    return std::isfinite(x) && std::abs(std::frexp(x, &e)) == 0.5;
}

}  // namespace errbound::validation
