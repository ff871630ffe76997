// Where contact is first found in floating point: where Y certainly has but one root, by the G_i
// near it; else on parts of the step. Internal; host and device code share it.
#pragma once

#include <algorithm>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <errbound/number_traits.hpp>
#include <errbound/roots/control_values.hpp>

#include "ccd/exact/cubic_roots.hpp"
#include "ccd/exact/static_filter/coefficient_signs.hpp"
#include "ccd/exact/static_filter/subdivision.hpp"
#include "ccd/exact/static_filter/whole_step.hpp"

namespace ccd::detail {

/// The value at t, off by 16ε of the largest control value more than those are (de Casteljau).
template <int N>
constexpr double value_at(errbound::roots::control_values<double, N> c, double t) {
    for (int level = N; level > 0; --level)
        for (int i = 0; i < level; ++i) c[i] += t * (c[i + 1] - c[i]);
    return c[0];
}

/// `collides`, with the whole step as the part that was found, or `separate`, where Y certainly has
/// one root: its place is bracketed by certain signs of Y, and within the bracket no G_i changes by
/// more than 2N = 8 of its largest control value's size times the bracket's width. Else
/// `uncertain`.
template <template <class> class Forms>
constexpr outcome decide_at_single_root(const static_filter::whole_step<double, Forms>& whole,
                                        static_filter::contact_part& found) {
    using namespace static_filter;
    constexpr double epsilon = errbound::number_traits<double>::epsilon();
    constexpr double reach = 0x1p-28;
    const auto& [y, g] = whole.forms;
    const auto& errors = whole.errors;
    if (!changes_sign_once(y, errors.y)) return outcome::uncertain;
    const double t = estimated_root({y[0], 3 * y[1], 3 * y[2], y[3]});
    const double y_error = errors.y + 16 * epsilon * size_of(y);
    const double before = value_at(y, std::max(t - reach, 0.0));
    const double after = value_at(y, std::min(t + reach, 1.0));
    const bool bracketed =
        y[0] > 0 ? before > y_error && after < -y_error : before < -y_error && after > y_error;
    if (!bracketed) return outcome::uncertain;
    auto answer = outcome::collides;
    for (const auto& form : g) {
        const double error = errors.g + (16 * epsilon + 8 * reach) * size_of(form);
        const double value = value_at(form, t);
        if (value < -error) return outcome::separate;
        if (!(value > error)) answer = outcome::uncertain;
    }
    found = {0, 1, y, true};
    return answer;
}

/// subdivide, but first at a single root, which halving takes longer to find.
template <template <class> class Forms>
constexpr outcome find_contact(const static_filter::whole_step<double, Forms>& whole,
                               static_filter::contact_part& found, std::size_t deepest) {
    const outcome at_root = decide_at_single_root(whole, found);
    return at_root != outcome::uncertain ? at_root
                                         : static_filter::subdivide(whole, &found, deepest);
}

/// What floating point does not tell of a first contact after so many halvings costs integers less
/// than more of them.
inline constexpr std::size_t halvings_for_times = 2;

}  // namespace ccd::detail
