// Proximity of a moving vertex and a moving edge: certainly never within a distance `reach`, or
// uncertain.
//
// The vertex/edge and vertex/vertex tests of SafeCCD (Wang 2014), with thresholds for any reach.
// Derivation: docs/other-methods.md, "Proximity of a vertex and an edge".
#pragma once

#include <array>
#include <ccd/methods/forms.hpp>
#include <ccd/methods/least_distance.hpp>
#include <cmath>
#include <cstddef>
#include <errbound/number_traits.hpp>
#include <errbound/roots/floating_roots.hpp>

namespace ccd::safeccd {

/// A polynomial in power form, with a bound on the errors of its values on [0, 1].
template <class T, int N>
struct plain_form {
    errbound::bernstein<T, N> p;
    T error = 0;  ///< bound for any value on [0, 1]
    T size = 0;   ///< the sum of the coefficients' sizes

    template <class Scalar>
    explicit constexpr plain_form(const errbound::bernstein<Scalar, N>& form) {
        using traits = errbound::number_traits<T>;
        for (int i = 0; i <= N; ++i) {
            p[i] = form[i].value();
            size += traits::abs(p[i]);
            error += form[i].error();
        }
        error += 8 * traits::epsilon() * size;
    }
    constexpr T at(T t) const {
        T value = p[N];
        for (int i = N - 1; i >= 0; --i) value = value * t + p[i];
        return value;
    }
};

/// Finds times at which the vertex may touch the edge's line with its foot on the edge. E is the
/// edge's vector, and W the vertex relative to its first end, both in power form.
template <class Scalar>
class line_proximity {
  public:
    using T = typename Scalar::value_type;

    constexpr line_proximity(const vector_form<Scalar, 1>& e, const vector_form<Scalar, 1>& w,
                             T reach, T off_line)
        : line_proximity(e, w, cross(e, w), reach, off_line) {}

    constexpr bool usable() const { return traits::is_finite(tau_); }

    /// D: if no candidate touches, the vertex is within reach only if it is within this distance of
    /// an end.
    constexpr T end_distance(T reach) const {
        const T line_distance = slope_ + (tau_ > 0 ? tau_ / std::sqrt(lambda_squared_) : T(0));
        return std::sqrt(line_distance * line_distance + lambda_squared_ * T(0.3125)) *
                   (1 + T(0x1p-10)) +
               reach;
    }

    constexpr bool touches() const {
        if (touches_at(T(0)) || touches_at(T(1))) return true;
        for (const quadratic& f : q_)
            for (const T t : errbound::roots::quadratic_roots(f.p[0], f.p[1], f.p[2]))
                if (touches_at(t)) return true;
        // Signed sums: the signs of q_y and q_z relative to q_x, and which ±E_j is subtracted.
        for (int signs = 0; signs < 4; ++signs) {
            const T sy = signs & 1 ? -1 : 1, sz = signs & 2 ? -1 : 1;
            const T c1 = q_[0].p[1] + sy * q_[1].p[1] + sz * q_[2].p[1];
            const T c2 = q_[0].p[2] + sy * q_[1].p[2] + sz * q_[2].p[2];
            for (const linear& l : edge_)
                for (const T change : {slope_ * l.p[1], -slope_ * l.p[1]})
                    if (touches_at(-(c1 + change) / (2 * c2))) return true;
        }
        return false;
    }

  private:
    using traits = errbound::number_traits<T>;
    using quadratic = plain_form<T, 2>;
    using linear = plain_form<T, 1>;

    constexpr line_proximity(const vector_form<Scalar, 1>& e, const vector_form<Scalar, 1>& w,
                             const vector_form<Scalar, 2>& product, T reach, T off_line)
        : q_{quadratic(product.x), quadratic(product.y), quadratic(product.z)},
          edge_{linear(e.x), linear(e.y), linear(e.z)},
          place_{linear(w.x), linear(w.y), linear(w.z)},
          slope_(3 * reach) {
        T error = 0, sizes = 0, edge_error = 0, edge_size = 0, place_error = 0, place_size = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            error += q_[i].error, sizes += q_[i].size;
            edge_error += edge_[i].error, edge_size += edge_[i].size;
            place_error += place_[i].error, place_size += place_[i].size;
        }
        tau_ = (traits::max)(off_line, error + slope_ * edge_error +
                                           512 * traits::epsilon() * (sizes + slope_ * edge_size));
        doubt_ = 8 * (edge_error * (edge_size + place_size) + place_error * edge_size) +
                 16 * traits::epsilon() * edge_size * (edge_size + place_size);
        lambda_squared_ = (traits::max)(3 * tau_, 4 * doubt_);
    }

    constexpr bool touches_at(T t) const {
        if (!(t >= 0 && t <= 1)) return false;
        std::array<T, 3> at_e, at_w;
        T off = 0, longest = 0, length_squared = 0, foot = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            off += traits::abs(q_[i].at(t));
            at_e[i] = edge_[i].at(t), at_w[i] = place_[i].at(t);
            longest = (traits::max)(longest, traits::abs(at_e[i]));
            length_squared += at_e[i] * at_e[i];
            foot += at_e[i] * at_w[i];
        }
        if (off > slope_ * longest + tau_) return false;
        return length_squared > lambda_squared_ && foot >= -doubt_ &&
               foot <= length_squared + doubt_;
    }

    std::array<quadratic, 3> q_;  ///< E × W
    std::array<linear, 3> edge_, place_;
    T slope_;                ///< 3·reach
    T tau_ = 0, doubt_ = 0;  ///< error bounds of |E × W| and of the foot's comparison
    T lambda_squared_ = 0;   ///< the foot is tested for edges of at least this squared length
};

/// False only if the vertex is never within `reach` of the edge. Power forms: `e` goes from the
/// edge's first end to its second, `w0` and `w1` from each end to the vertex. `off_line` raises τ.
template <class Scalar, class T = typename Scalar::value_type>
constexpr bool proximity(const vector_form<Scalar, 1>& e, const vector_form<Scalar, 1>& w0,
                         const vector_form<Scalar, 1>& w1, T reach, T off_line) {
    const line_proximity<Scalar> line(e, w0, reach, off_line);
    if (!line.usable()) return true;
    const T end_distance = line.end_distance(reach);
    if (!(least_distance(w0).low > end_distance && least_distance(w1).low > end_distance))
        return true;
    return line.touches();
}

}  // namespace ccd::safeccd
