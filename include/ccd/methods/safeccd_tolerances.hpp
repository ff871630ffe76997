// The tolerances of SafeCCD. docs/other-methods.md, "SafeCCD", gives the purpose of each.
#pragma once

#include <algorithm>
#include <ccd/methods/transform.hpp>
#include <ccd/query.hpp>
#include <cmath>
#include <errbound/number_traits.hpp>
#include <errbound/rules/safe.hpp>
#include <errbound/tracked.hpp>

namespace ccd::safeccd {

using errbound::number_traits;

/// About x^(2/3), by operations that all machines round alike (unlike std::cbrt).
template <class T>
constexpr T two_thirds_power(const T& x) {
    using traits = number_traits<T>;
    if (!(x > 0) || !traits::is_finite(x)) return x;
    const int e = traits::exponent(x), third = (e < 0 ? e - 2 : e) / 3;  // rounded down
    const T m = traits::scale(x, -3 * third);                            // in [1/2, 4)
    T root = (2 + m) / 3;
    for (int i = 0; i < 5; ++i) root = (2 * root + m / (root * root)) / 3;  // Newton's
    return traits::scale(root * root, 2 * third);
}

/// The thresholds below which nothing is certain, from each variable's own bound.
template <class T, class Rule>
struct tolerances {
    using scalar = errbound::tracked<T, Rule>;

    template <class Query>
    explicit constexpr tolerances(const Query&) {}

    static constexpr bool usable = true;
    /// |f| up to this plus its certified error counts as a root.
    static constexpr T root = 0;
    /// Half widths w of the windows: from the first to the last, multiplied by the growth.
    static constexpr T first_window = 64 * number_traits<T>::epsilon(), last_window = T(0x1p-8),
                       window_growth = 64;
    /// The least length of the normal relative to the longest edge.
    static constexpr T normal_per_length = 0;
    /// Added to the threshold of |E × W| for touching an edge's line.
    static constexpr T off_line = 0;

    static constexpr scalar difference(const scalar& a, const scalar& b) { return a - b; }
    static constexpr scalar displacement(const scalar& a, const scalar& b) { return a - b; }

    /// The time t, or all of [t − w, t + w].
    static constexpr scalar time(T t, T w) { return scalar::within(t, w); }
    /// The largest change of the inside forms within w, beyond the interval of time(t, w).
    static constexpr T drift(T) { return 0; }

    /// ν for the bound μ of |f| and edges of at least `length`: minimises μ/ν + r.
    static constexpr T smallest_normal(T mu, T length) {
        const T for_any = two_thirds_power(mu);
        const T for_long = std::sqrt(mu * length);
        return length > 0 && mu / for_long < mu / for_any ? for_long : for_any;
    }
    /// A lower bound of the longest edge's length, if it may be used.
    static constexpr T known_length(T length) { return length; }
};

/// These thresholds, from one bound B on all coordinate differences during the step and the bound V
/// on displacements: Wang 2014 with e = ε + 2σ/B, if coordinates are known to within σ.
template <class T>
struct tolerances<T, errbound::safe> {
    using scalar = errbound::tracked<T, errbound::safe>;
    using traits = number_traits<T>;

    bool usable;
    T root, normal_per_length, off_line;
    static constexpr T first_window = T(0.001), last_window = T(0.001), window_growth = 2;

    /// B = E + 2V, where E is the largest difference of coordinates at t = 0.
    template <class Query>
    explicit constexpr tolerances(const Query& query) {
        point<T> low, high;
        bool first = true;
        T displacement = 0;
        const auto widen = [&](T& l, T& h, const scalar& x0, const scalar& x1) {
            sigma_ = (traits::max)(sigma_, (traits::max)(x0.error(), x1.error()));
            l = first ? x0.value() : (std::min)(l, x0.value());
            h = first ? x0.value() : (std::max)(h, x0.value());
            displacement = (traits::max)(displacement, traits::abs(x1.value() - x0.value()));
        };
        for (const auto& p : points_of(query)) {
            widen(low.x, high.x, p.t0.x, p.t1.x);
            widen(low.y, high.y, p.t0.y, p.t1.y);
            widen(low.z, high.z, p.t0.z, p.t1.z);
            first = false;
        }
        const T extent = (std::max)({high.x - low.x, high.y - low.y, high.z - low.z});
        // One part in a million covers the roundings here, and coordinates that underflowed when
        // the query was scaled, unless all differences are of their size.
        constexpr T enlarged = 1 + T(0x1p-20);
        v_ = (displacement + 2 * sigma_) * enlarged;
        b_ = (extent + 2 * displacement + 6 * sigma_) * enlarged;
        usable = b_ >= std::sqrt(traits::smallest_normal());
        const T root_e = std::sqrt(traits::epsilon() + 2 * sigma_ / b_),
                fourth_root_e = std::sqrt(root_e);
        root = 64 * b_ * b_ * b_ * root_e * fourth_root_e;
        normal_ = 64 * b_ * b_ * root_e;
        normal_per_length = 4 * b_ * fourth_root_e;
        off_line = 725 * b_ * b_ * root_e;
    }

    /// The error is one rounding, at most εB, plus that of the coordinates.
    constexpr scalar difference(const scalar& a, const scalar& b) const {
        return scalar::within(a.value() - b.value(), traits::epsilon() * b_ + 2 * sigma_);
    }
    constexpr scalar displacement(const scalar& a, const scalar& b) const {
        return scalar::within(a.value() - b.value(), traits::epsilon() * v_ + 2 * sigma_);
    }

    static constexpr scalar time(T t, T) { return scalar(t); }
    /// An inside form is the scalar product of two cross products of differences: 12 terms of four
    /// factors, each of size at most B and speed at most 2V.
    constexpr T drift(T w) const { return 48 * b_ * b_ * b_ * 2 * v_ * w; }

    constexpr T smallest_normal(T, T) const { return normal_; }
    static constexpr T known_length(T) { return 0; }

  private:
    T b_, v_, normal_, sigma_ = 0;
};

}  // namespace ccd::safeccd
