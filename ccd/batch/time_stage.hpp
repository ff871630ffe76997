// First times of queries that are known to collide, over packs: the brackets of most. Internal.
//
// Every contact is at a root of Y. So where Y certainly has but one root, that is the time; where
// it has two, contact is at the first if the G_i certainly are positive there, and at the second if
// one certainly is negative. The neighbouring doubles between which a root lies are found by
// Newton's method, and proved by Y's signs there, in twice double's precision with an error bound.
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
constexpr int neighbours_tried = 3;

template <int N>
using pack_values = errbound::roots::control_values<pack, N>;

/// The value and the slope at t of the polynomial that has these control values.
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

/// The parts of a cubic before and after t, off by another 32ε of its largest control value.
struct parts_of_cubic {
    pack_values<3> before, after;

    parts_of_cubic(const pack_values<3>& y, const pack& t) : before(y), after(y) {
        for (int i = 1; i <= 3; ++i) {
            for (int j = 0; j <= 3 - i; ++j) after[j] = after[j] + t * (after[j + 1] - after[j]);
            before[i] = after[0];
        }
    }
};

/// Times as brackets of neighbouring doubles, in the lanes that are `told`.
struct pack_times {
    pack low, high;
    pack_mask told;
};

/// Y of a pack of queries at any time, in twice the precision.
template <kind K>
class twofold_y {
  public:
    /// From coordinates as coordinate_columns have them.
    twofold_y(const coordinate_columns& x, std::size_t first,
              const static_filter::difference_extents<pack>& m) {
        const auto f = forms_at(x, first);
        std::size_t i = 0;
        for (const auto* v : {&f.b, &f.c, &f.p})
            for (const auto* axis : {&v->x, &v->y, &v->z}) {
                start_[i] = (*axis)[0];
                change_[i++] = (*axis)[1] - (*axis)[0];
            }
        // A difference at t is off by 7·8u² of its largest size, a product of two by 15·8u² of
        // theirs, N by 32, Y by 160: 1280u² < 2^-95, of the extents' product.
        error_ = m.x * m.y * m.z * pack(0x1p-94);
        const pack least(0x1p-150), most(0x1p150);  // so that nothing is lost to underflow
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

/// The double after t > 0, or before it.
inline pack neighbour(const pack& t, const pack_mask& after) {
    using integers = xsimd::batch<std::int64_t, xsimd::default_arch>;
    const integers bits = xsimd::bitwise_cast<integers>(t);
    return select(after, xsimd::bitwise_cast<pack>(bits + integers(1)),
                  xsimd::bitwise_cast<pack>(bits - integers(1)));
}

/// The only root of a part from `from` to `to`, where `before` (1 or -1) is Y's sign before it; y
/// are Y's control values on the whole step.
template <kind K>
pack_times bracket_of_root(const twofold_y<K>& exact, const pack_values<3>& y, const pack& from,
                           const pack& to, const pack& before) {
    const pack at_from = value_and_slope<3>(y, from).value, at_to = value_and_slope<3>(y, to).value;
    pack low = from, high = to, t = from + (to - from) * (at_from / (at_from - at_to)), slope;
    for (int i = 0; i < newton_steps; ++i) {
        const value_and_slope<3> there(y, t);
        const pack_mask earlier = there.value * before > pack(0.0);
        low = select(earlier, t, low);
        high = select(earlier, high, t);
        slope = there.slope;
        const pack next = t - there.value / slope;
        t = select((next >= low) & (next <= high), next, (low + high) * pack(0.5));
    }
    // Control values are 3 times what Y's are.
    constexpr double scale = errbound::roots::multiple(3);
    t = min(max(t - pack(scale) * exact.at(t) / slope, from), to);
    pack value = before * exact.at(t);
    pack_times found{t, t, pack_mask(false)};
    for (int i = 0; i < neighbours_tried; ++i) {
        const pack_mask earlier = value > exact.error(), later = value < -exact.error();
        const pack other = neighbour(t, earlier);
        const pack value_there = before * exact.at(other);
        const pack_mask opposite =
            (earlier & (value_there < -exact.error())) | (later & (value_there > exact.error()));
        const pack_mask now = opposite & !found.told;
        found.low = select(now, min(t, other), found.low);
        found.high = select(now, max(t, other), found.high);
        found.told = found.told | now;
        if (all(found.told)) break;
        t = other;
        value = value_there;
    }
    found.told = found.told & (found.low >= from) & (found.high <= to) & (found.low > pack(0.0));
    return found;
}

/// The times of a pack of queries that collide.
template <kind K>
class time_stage {
    template <class S>
    using forms = linear_forms<K, S>;

  public:
    /// Writes brackets to low and high, NaN where it cannot tell. Of size queries.
    [[gnu::flatten]] static void run(const coordinate_columns& coordinates, std::size_t size,
                                     double* low, double* high) {
        for (std::size_t at = 0; at < size; at += width) {
            const pack_times found = times_of(coordinates, at);
            alignas(64) double lows[width], highs[width];
            const pack nan(std::numeric_limits<double>::quiet_NaN());
            select(found.told, found.low, nan).store_aligned(lows);
            select(found.told, found.high, nan).store_aligned(highs);
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

        const pack_mask single = exact.usable() & static_filter::changes_sign_once(y, error);
        const pack turn = turning_point(y, before);
        const parts_of_cubic parts(y, turn);
        const pack of_parts = error + pack(32 * epsilon) * static_filter::size_of(y);
        const pack_mask two = exact.usable() & (turn > zero) & (turn < one) &
                              static_filter::changes_sign_once(parts.before, of_parts) &
                              static_filter::changes_sign_once(parts.after, of_parts);
        pack_times found = bracket_of_root(exact, y, zero, select(single, one, turn), before);
        found.told = found.told & (single | two);
        if (none(two)) return found;

        // Which of the two roots it is.
        const static_filter::whole_step<pack, forms_of_kind<K>::template type> whole(f, extents);
        pack_mask inside(true), outside(false);
        for (const auto& g : whole.forms.g) {
            // At the root, which is less than ε away: its slope is at most 8 control values.
            const pack value = value_and_slope<4>(g, found.low).value;
            const pack g_error = whole.errors.g + pack(64 * epsilon) * static_filter::size_of(g);
            inside = inside & (value > g_error);
            outside = outside | (value < -g_error);
        }
        const pack_mask second = two & found.told & outside;
        found.told = found.told & (single | inside);
        if (none(second)) return found;
        const pack_times later = bracket_of_root(exact, y, turn, one, -before);
        found.low = select(second, later.low, found.low);
        found.high = select(second, later.high, found.high);
        found.told = select_mask(second, later.told, found.told);
        return found;
    }

    /// Where y, with that sign at 0, is extreme on the other side; anything if it is nowhere.
    static pack turning_point(const pack_values<3>& y, const pack& sign) {
        const pack d0 = y[1] - y[0], d1 = y[2] - y[1], d2 = y[3] - y[2];
        const pack root = sign * sqrt(max(d1 * d1 - d0 * d2, pack(0.0)));
        // (d0 − d1 ± root)/(d0 − 2d1 + d2), whose two numerators' product is d0·(d0 − 2d1 + d2):
        // that without cancellation.
        const pack q = (d0 - d1) + root, other = (d0 - d1) - root;
        return select(abs(q) >= abs(other), q / ((d0 - d1) - (d1 - d2)), d0 / other);
    }
    static pack_mask select_mask(const pack_mask& which, const pack_mask& a, const pack_mask& b) {
        return (which & a) | (!which & b);
    }
};

}  // namespace
}  // namespace ccd::detail::ERRBOUND_INSTRUCTION_SET
