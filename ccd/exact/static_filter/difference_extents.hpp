// The size of a query's differences, and the error bounds of its forms that follow from it.
//
// S is double for one query or a pack for several (with masks instead of bools). Each lane computes
// bit for bit the scalar result.
#pragma once

#include <algorithm>
#include <ccd/methods/forms.hpp>
#include <cmath>

#include "ccd/exact/static_filter/constants.hpp"

namespace ccd::static_filter {

/// The number type of S: double for a pack of doubles.
template <class S>
struct real_of {
    using type = double;
};
template <>
struct real_of<float> {
    using type = float;
};

/// The type of a comparison: bool, or a SIMD mask.
template <class S>
using mask = decltype(S() < S());

/// m_x, m_y, m_z: the largest size of a component of b, c, p at both ends of the step, by axis.
/// Precondition: finite coordinates. (Differences that overflow are infinite. NaN results only from
/// infinite coordinates, and the maximum may skip it.)
template <class S>
struct difference_extents {
    using real = typename real_of<S>::type;
    S x, y, z;
    /// False if a difference is too large for the error bounds.
    mask<S> usable;

    explicit constexpr difference_extents(const coplanarity_forms<S>& f) {
        using std::abs, std::max;
        const auto largest = [](const auto& b, const auto& c, const auto& p) {
            S m = abs(b[0]);
            for (const S& d : {b[1], c[0], c[1], p[0], p[1]}) m = max(m, S(abs(d)));
            return m;
        };
        x = largest(f.b.x, f.c.x, f.p.x);
        y = largest(f.b.y, f.c.y, f.p.y);
        z = largest(f.b.z, f.c.z, f.p.z);
        usable = max(max(x, y), z) <= S(largest_difference<real>);
    }

    /// Bounds |ĥ − h| of the control values of Y, or of every G_i. Proved for double. Proof:
    /// proofs/filters/CcdFilter.v, error_of_y_sound, error_of_vertex_face_sound,
    /// error_of_edge_edge_sound.
    template <template <class> class Forms>
    constexpr S error_of_y() const {
        return x * y * z * S(y_constants<Forms, real>.relative) +
               S(y_constants<Forms, real>.absolute);
    }
    template <template <class> class Forms>
    constexpr S error_of_g() const {
        using std::max;
        const S area = max(max(x * y, y * z), z * x);
        return area * area * S(g_constants<Forms, real>.relative) +
               S(g_constants<Forms, real>.absolute);
    }
};

}  // namespace ccd::static_filter
