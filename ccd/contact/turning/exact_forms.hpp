// Y of two bodies' features with integer coefficients. Internal.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/bodies/motion.hpp>
#include <ccd/kind.hpp>
#include <cstddef>
#include <errbound/bernstein.hpp>
#include <errbound/integers/binary_double.hpp>
#include <errbound/integers/fixed_integer.hpp>
#include <optional>
#include <span>

#include "ccd/contact/moving_points.hpp"
#include "ccd/contact/time_bracket.hpp"
#include "ccd/contact/time_polynomial.hpp"
#include "ccd/contact/turning/body_filter.hpp"
#include "ccd/contact/turning/rigid_forms.hpp"
#include "ccd/contact/weighted_paths.hpp"

namespace ccd::detail {

/// Polynomials with integers of any size.
struct growing_integers {
    using number = integer;
    using constant_form = time_polynomial;
    using linear_form = time_polynomial;

    static number in_unit(double x, int unit) {
        return errbound::dyadic<integer>::from(x).in_units(unit);
    }
    static constant_form constant(const number& x) { return constant_form({x}); }
    static linear_form linear(const number& start, const number& end) {
        return linear_form({start, end - start});
    }
};

/// Forms with integers of two words. Y has 14 words: numbers of at most `max_bits` bits give it at
/// most 7·max_bits + 20 bits.
struct fixed_integers {
    using number = errbound::integers::fixed_integer<2>;
    using constant_form = errbound::bernstein<number, 0>;
    using linear_form = errbound::bernstein<number, 1>;
    static constexpr int max_bits = 110;

    static number in_unit(double x, int unit) {
        const errbound::integers::binary_double d(x);
        if (d.magnitude == 0) return 0;
        const std::int64_t odd = d.odd_part();
        const auto size =
            number::shifted(static_cast<std::uint64_t>(odd < 0 ? -odd : odd), d.last_bit() - unit);
        return odd < 0 ? -size : size;
    }
    static constant_form constant(const number& x) { return {{x}}; }
    static linear_form linear(const number& start, const number& end) { return {{start, end}}; }
};

/// A query of two rigid bodies in units in which its numbers are integers.
template <kind K>
class exact_rigid_query {
  public:
    exact_rigid_query(std::span<const body_point> points,
                      const std::array<rigid_motion, 2>& motions)
        : points_(points), motions_(motions), unit_(common_units(points)[0]) {
        for (const std::size_t body : {0, 1})
            q_unit_[body] =
                std::min(common_exponent(motions[body].q0), common_exponent(motions[body].q1));
    }

    /// The largest number of bits of a difference of positions or of a quaternion's coordinate.
    int bits() const {
        int most = 0;
        const auto include = [&](std::initializer_list<double> numbers, int unit) {
            for (const double x : numbers)
                if (x != 0)
                    most = std::max(most, errbound::integers::binary_double(x).end_bit() - unit);
        };
        const auto include_position = [&](const point<double>& p) {
            include({p.x, p.y, p.z}, unit_ - 1);
        };
        for (const body_point& p : points_) include_position(p.rest);
        for (const std::size_t body : {0, 1}) {
            const rigid_motion& m = motions_[body];
            include_position(m.p0);
            include_position(m.p1);
            include_position(m.centre);
            include({m.q0.w, m.q0.x, m.q0.y, m.q0.z, m.q1.w, m.q1.x, m.q1.y, m.q1.z},
                    q_unit_[body]);
        }
        return most;
    }

    /// Y in integers of the type `Integers`, divided by all weights that both bodies have.
    template <class Integers>
    auto y() const {
        using constant = typename Integers::constant_form;
        using linear = typename Integers::linear_form;
        rigid_query<constant, linear> query;
        const auto ends = [](double from, double to, int unit) {
            return Integers::linear(Integers::in_unit(from, unit), Integers::in_unit(to, unit));
        };
        for (const std::size_t body : {0, 1}) {
            const rigid_motion& m = motions_[body];
            const int unit = q_unit_[body];
            query.q[body] = {ends(m.q0.w, m.q1.w, unit), ends(m.q0.x, m.q1.x, unit),
                             ends(m.q0.y, m.q1.y, unit), ends(m.q0.z, m.q1.z, unit)};
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto in_units = [&](const point<double>& p) {
                return Integers::in_unit(p.*coordinate_axes[axis], unit_);
            };
            const auto difference = [&](const point<double>& to, const point<double>& from) {
                return in_units(to) - in_units(from);
            };
            const auto rest = [&](std::size_t i) -> const point<double>& {
                return points_[i].rest;
            };
            query.d[axis] = Integers::linear(difference(motions_[0].p0, motions_[1].p0),
                                             difference(motions_[0].p1, motions_[1].p1));
            query.x[axis] = Integers::constant(difference(rest(0), motions_[0].centre));
            query.y[axis] = Integers::constant(difference(rest(first), motions_[1].centre));
            query.e[axis] = Integers::constant(difference(rest(face ? 2 : 1), rest(face ? 1 : 0)));
            query.f[axis] = Integers::constant(difference(rest(3), rest(face ? 1 : 2)));
        }
        return rigid_forms<K, constant, linear>(query).y();
    }

  private:
    static constexpr bool face = K == kind::vertex_face;
    static constexpr std::size_t first = kind_traits<K>::first_vertices;

    std::span<const body_point> points_;
    std::array<rigid_motion, 2> motions_;
    int unit_;
    std::array<int, 2> q_unit_;
};

/// A polynomial with the roots of Y in [0, 1] and their multiplicities. Precondition:
/// has_two_bodies.
template <kind K>
time_polynomial y_of_bodies(std::span<const body_point> points) {
    const auto a = as_rigid(*points.front().motion), b = as_rigid(*points.back().motion);
    if (a && b) return exact_rigid_query<K>(points, {*a, *b}).template y<growing_integers>();
    const weighted_paths<K, integer_ring> exact(points, integer_ring(common_units(points)));
    return forms_of(exact.q).y()[0];
}

/// The sign of Y at t = 0. Precondition: has_two_bodies.
template <kind K>
errbound::sign_type exact_sign_at_start(std::span<const body_point> points) {
    const time_polynomial y = y_of_bodies<K>(points);
    return y.is_zero() ? errbound::sign_type::zero : sign_of(y.coefficients().front());
}

/// The bracket of the contact in a touching interval, if fixed width suffices.
template <kind K>
std::optional<time_bracket> bracket_in_fixed_width(std::span<const body_point> points,
                                                   const touching_interval& part) {
    const auto a = as_rigid(*points.front().motion), b = as_rigid(*points.back().motion);
    if (!part.one_root || !a || !b) return {};
    const exact_rigid_query<K> query(points, {*a, *b});
    if (query.bits() > fixed_integers::max_bits) return {};
    const auto y = query.template y<fixed_integers>();
    const root_search search(y);
    // Newton steps in floating point cost less than exact signs.
    const errbound::bernstein<double, std::decay_t<decltype(y)>::degree> rounded{search.floating()};
    const auto slope = derivative(rounded);
    double estimate = part.estimate;
    for (int i = 0; i < 4; ++i) {
        const double next =
            estimate - errbound::value_at(rounded, estimate) / errbound::value_at(slope, estimate);
        if (next > part.low && next < part.high) estimate = next;
    }
    return search.between(part.low, part.high, part.before, estimate);
}

}  // namespace ccd::detail
