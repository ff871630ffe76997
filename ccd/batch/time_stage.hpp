// Brackets the first times of most colliding queries, over packs. Internal.
//
// Every contact is at a root of Y. If Y certainly has exactly one root, that root is the time. If Y
// has two, the signs of the G_i at the first root decide. The time is the first root if all G_i are
// certainly positive there, the second if one is certainly negative there. Signs on two parts of
// the step determine the number of roots. Newton's method finds the adjacent doubles around a root;
// signs of Y there, in twice double's precision with an error bound, prove them.
#pragma once

#include <ccd/kind.hpp>
#include <ccd/methods/forms.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <errbound/roots/control_values.hpp>
#include <limits>

#include "ccd/batch/filter_stages.hpp"
#include "ccd/batch/query_queue.hpp"
#include "ccd/batch/twofold.hpp"
#include "ccd/exact/static_filter/coefficient_signs.hpp"
#include "ccd/exact/static_filter/whole_step.hpp"

namespace ccd::detail::ERRBOUND_INSTRUCTION_SET {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr int newton_steps = 9;
constexpr double converged = 0x1p-28;  ///< the next Newton step is about the square of this
constexpr int neighbours_tried = 3;

template <int N>
using pack_values = errbound::roots::control_values<pack, N>;

/// Value and slope at t, by de Casteljau. The value's error exceeds that of the control values by
/// at most 16ε times the largest control value. Proof: proofs/times/TimeStage.v, value_near.
template <int N>
struct value_and_slope {
    pack value, slope;

    value_and_slope(pack_values<N> c, const pack& t) {
        for (int level = N; level > 1; --level)
            for (int i = 0; i < level; ++i) c[i] = c[i] + t * (c[i + 1] - c[i]);
        slope = pack(double(N)) * (c[1] - c[0]);
        value = c[0] + t * (c[1] - c[0]);
    }
};

/// The parts of a cubic before and after t, with a further error of at most 32ε times its largest
/// control value. Proof: proofs/times/TimeStage.v, lerp_near, parts_at.
struct parts_of_cubic {
    pack_values<3> before, after;

    parts_of_cubic(const pack_values<3>& y, const pack& t) : before(y), after(y) {
        for (int i = 1; i <= 3; ++i) {
            for (int j = 0; j <= 3 - i; ++j) after[j] = after[j] + t * (after[j + 1] - after[j]);
            before[i] = after[0];
        }
    }
};

/// Brackets of adjacent doubles, in the lanes that are `known`.
struct pack_times {
    pack low, high;
    pack_mask known;
};

/// Y of a pack of queries at any time, in twice double's precision.
template <kind K>
class twofold_y {
  public:
    twofold_y(const coordinate_columns& x, std::size_t first,
              const static_filter::difference_extents<pack>& m) {
        const auto f = forms_at(x, first);
        std::size_t i = 0;
        for (const auto* v : {&f.b, &f.c, &f.p})
            for (const auto* axis : {&v->x, &v->y, &v->z}) {
                start_[i] = (*axis)[0];
                change_[i++] = (*axis)[1] - (*axis)[0];
            }
        // Relative to the products of the extents, a difference at t has an error of at most 51u²,
        // a product of two 116u². N has 243u², and Y 1166u² < 2^-95. Proof: proofs/times/Twofold.v,
        // y_near, time_stage_sign, error_enough.
        error_ = m.x * m.y * m.z * pack(0x1p-94);
        const pack least(0x1p-150), most(0x1p150);  // prevents underflow and overflow
        usable_ = m.usable & (min(min(m.x, m.y), m.z) > least) & (max(max(m.x, m.y), m.z) < most);
    }
    const pack_mask& usable() const { return usable_; }
    const pack& error() const { return error_; }

    [[gnu::noinline, gnu::flatten]] pack at(const pack& t) const {
        const twofold time{t, pack(0.0)};
        const auto component = [&](std::size_t i) {
            return errbound::bernstein<twofold, 0>{{start_[i] + time * change_[i]}};
        };
        const auto vector = [&](std::size_t i) {
            return vector_form<twofold, 0>{component(i), component(i + 1), component(i + 2)};
        };
        return coplanarity_forms<twofold, 0>(vector(0), vector(3), vector(6)).y()[0].value;
    }

  private:
    static linear_forms<K, twofold> forms_at(const coordinate_columns& x, std::size_t first) {
        const auto number = [&](std::size_t c) {
            return twofold{pack::load_aligned(&x.at[c][first]), pack(0.0)};
        };
        const auto point_at = [&](std::size_t c) {
            return point<twofold>{number(c), number(c + 1), number(c + 2)};
        };
        const auto moving = [&](std::size_t c) {
            return moving_point<twofold>{point_at(c), point_at(c + 3)};
        };
        using query = typename kind_traits<K>::template query<twofold>;
        return linear_forms<K, twofold>(query{moving(0), moving(6), moving(12), moving(18)});
    }

    twofold start_[9], change_[9];  ///< of b, c and p, axis by axis
    pack error_;
    pack_mask usable_;
};

/// An interval of the step with certainly one root of Y. `before` is the sign of Y before that
/// root.
struct pack_parts {
    pack from, to, before;
};

/// An estimate of the root of Y in an interval, from the control values y, and the slope of Y near
/// it.
struct pack_roots {
    pack t, slope;

    pack_roots(const pack_values<3>& y, const pack_parts& part, const pack_mask& wanted) {
        const pack at_from = value_and_slope<3>(y, part.from).value;
        const pack at_to = value_and_slope<3>(y, part.to).value;
        pack low = part.from, high = part.to;
        t = low + (high - low) * (at_from / (at_from - at_to));
        for (int i = 0; i < newton_steps; ++i) {
            const value_and_slope<3> there(y, t);
            const pack_mask earlier = there.value * part.before > pack(0.0);
            low = select(earlier, t, low);
            high = select(earlier, high, t);
            slope = there.slope;
            const pack newton = t - there.value / slope;
            const pack next =
                select((newton >= low) & (newton <= high), newton, (low + high) * pack(0.5));
            const pack_mask moving = wanted & (abs(next - t) > pack(converged));
            t = next;
            if (none(moving)) break;
        }
    }
};

/// Brackets a root from its estimate. Proof: proofs/times/TimeStage.v, bracket_around.
template <kind K>
pack_times bracket_of_root(const twofold_y<K>& exact, const pack_roots& root,
                           const pack_parts& part, const pack_mask& wanted) {
    // The control values behind root.slope are 3 times those of Y.
    constexpr double scale = errbound::roots::multiple(3);
    pack t = root.t - pack(scale) * exact.at(root.t) / root.slope;
    t = min(max(t, part.from), part.to);
    pack value = part.before * exact.at(t);
    pack_times found{t, t, pack_mask(false)};
    for (int i = 0; i < neighbours_tried; ++i) {
        const pack_mask earlier = value > exact.error(), later = value < -exact.error();
        const pack other = neighbour(t, earlier);
        const pack value_there = part.before * exact.at(other);
        const pack_mask opposite =
            (earlier & (value_there < -exact.error())) | (later & (value_there > exact.error()));
        const pack_mask now = opposite & !found.known;
        found.low = select(now, min(t, other), found.low);
        found.high = select(now, max(t, other), found.high);
        found.known = found.known | now;
        if (all(found.known | !wanted)) break;
        t = other;
        value = value_there;
    }
    found.known = wanted & found.known & (found.low >= part.from) & (found.high <= part.to) &
                  (found.low > pack(0.0));
    return found;
}

/// True if at the first root of Y, near t, all G_i are certainly positive (`inside`) or one is
/// certainly negative (`outside`). Certain signs of Y bracket the root. Within the bracket, no G_i
/// changes by more than 8 times its largest control value times the width. Proof:
/// proofs/times/TimeStage.v, root_reached, quartic_slope.
template <kind K>
struct signs_at_root {
    pack_mask inside = pack_mask(true), outside = pack_mask(false);

    /// y_error bounds the error of Y at any time. Y has the sign `before` before its first root.
    signs_at_root(const static_filter::whole_step<pack, forms_of_kind<K>::template type>& whole,
                  const pack& y_error, const pack& t, const pack& before) {
        constexpr double reach = 0x1p-28;
        const auto y_at = [&](const pack& time) {
            return before * value_and_slope<3>(whole.forms.y, time).value;
        };
        const pack_mask bracketed = (y_at(max(t - pack(reach), pack(0.0))) > y_error) &
                                    (y_at(min(t + pack(reach), pack(1.0))) < -y_error);
        for (const auto& g : whole.forms.g) {
            const pack value = value_and_slope<4>(g, t).value;
            const pack error =
                whole.errors.g + pack(16 * epsilon + 8 * reach) * static_filter::size_of(g);
            inside = inside & (value > error);
            outside = outside | (value < -error);
        }
        inside = inside & bracketed;
        outside = outside & bracketed;
    }
};

/// Proof: proofs/times/TimeStage.v, only_root_first, first_of_two, second_of_two.
template <kind K>
class time_stage {
    template <class S>
    using forms = linear_forms<K, S>;

  public:
    /// Writes brackets of `size` queries to low and high, NaN if undecided.
    [[gnu::flatten]] static void run(const coordinate_columns& coordinates, std::size_t size,
                                     double* low, double* high) {
        for (std::size_t at = 0; at < size; at += width) {
            const pack_times found = times_of(coordinates, at);
            alignas(64) double lows[width], highs[width];
            const pack nan(std::numeric_limits<double>::quiet_NaN());
            select(found.known, found.low, nan).store_aligned(lows);
            select(found.known, found.high, nan).store_aligned(highs);
            for (std::size_t i = 0; i < lesser(size - at, width); ++i) {
                low[at + i] = lows[i];
                high[at + i] = highs[i];
            }
        }
    }

  private:
    static pack_times times_of(const coordinate_columns& coordinates, std::size_t first) {
        const auto f = coordinates.forms_at<K>(first);
        const static_filter::difference_extents<pack> extents(f);
        const auto y = errbound::roots::control_values_of(f.y());
        const pack error = extents.template error_of_y<forms_of_kind<K>::template type>();
        const twofold_y<K> exact(coordinates, first, extents);
        const pack zero(0.0), one(1.0);
        const pack before = select(y[0] > zero, one, -one);

        // Assume one root if the number is odd, else two.
        const pack_mask odd = y[0] * y[3] < zero;
        const pack split = select(odd, pack(0.5), turning_point(y, before));
        const parts_of_cubic parts(y, split);
        const pack of_parts = error + pack(32 * epsilon) * static_filter::size_of(y);
        const auto has_one = [&](const pack_values<3>& c) {
            return static_filter::changes_sign_once(c, of_parts);
        };
        const auto has_none = [&](const pack_values<3>& c) {
            return static_filter::above(c, of_parts) | static_filter::below(c, of_parts);
        };
        const pack_mask usable = exact.usable() & (split > zero) & (split < one);
        const pack_mask one_before = has_one(parts.before), one_after = has_one(parts.after);
        const pack_mask early = usable & one_before & has_none(parts.after);
        const pack_mask late = usable & has_none(parts.before) & one_after;
        const pack_mask two = usable & one_before & one_after;
        pack_parts part{select(late, split, zero), select(late, one, split), before};
        pack_mask certain = early | late | two;
        if (none(certain)) return {zero, zero, certain};
        pack_roots root(y, part, certain);
        if (any(two)) {
            const static_filter::whole_step<pack, forms_of_kind<K>::template type> whole(f,
                                                                                         extents);
            const signs_at_root<K> signs(whole, of_parts, root.t, before);
            certain = early | late | (two & (signs.inside | signs.outside));
            const pack_mask second = two & signs.outside;
            part = {select(second, split, part.from), select(second, one, part.to),
                    select(second, -before, before)};
            if (any(second)) root = pack_roots(y, part, certain);
        }
        return bracket_of_root(exact, root, part, certain);
    }

    /// The time of the extremum at which y has the sign −`sign`, where `sign` is that of y at 0;
    /// any value if there is none.
    static pack turning_point(const pack_values<3>& y, const pack& sign) {
        const pack d0 = y[1] - y[0], d1 = y[2] - y[1], d2 = y[3] - y[2];
        const pack root = sign * sqrt(max(d1 * d1 - d0 * d2, pack(0.0)));
        // It is one of (d0 − d1 ± root)/(d0 − 2d1 + d2). The two numerators have the product d0·(d0
        // − 2d1 + d2), so that the one without cancellation suffices.
        const pack q = (d0 - d1) + root, other = (d0 - d1) - root;
        return select(abs(q) >= abs(other), q / ((d0 - d1) - (d1 - d2)), d0 / other);
    }
};

}  // namespace
}  // namespace ccd::detail::ERRBOUND_INSTRUCTION_SET
