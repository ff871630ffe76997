// The last floating-point stage of `exact`, for one query: bisects the step until the signs of Y
// and the G_i decide. Internal; host and device code share it.
#pragma once

#include <array>
#include <ccd/verdict.hpp>
#include <cstddef>

#include "ccd/exact/static_filter/whole_step.hpp"

namespace ccd::static_filter {

/// Halvings for first contacts. Further halvings cost more than integers for the queries that
/// remain, most of which touch at a border.
inline constexpr std::size_t halvings_for_times = 6;

/// The interval of the step in which contact was found. There is no contact before `low`.
struct contact_interval {
    double low = 0, high = 1;
    errbound::roots::control_values<double, 3> y{};  ///< computed control values of Y there
    bool one_root = false;                           ///< Y certainly has exactly one root there

    constexpr void set(double from, double to,
                       const errbound::roots::control_values<double, 3>& values, double error) {
        *this = {from, to, values, changes_sign_once(values, error)};
    }
};

/// A stack of the intervals to visit, the earliest last.
template <class Forms>
struct waiting_parts {
    struct part {
        Forms forms;
        std::size_t depth;
        std::size_t index;  ///< it begins at index/2^depth
    };
    // Every halving replaces one part by two.
    std::array<part, max_depth + 2> parts;
    std::size_t size = 0;
};

/// `separate` and `collides` are certain. Returns `uncertain` if further halving would not help, or
/// if `deepest` halvings did not decide. Precondition: deepest <= max_depth. If the query
/// `collides`, calls found->set(low, high, y, error) for an interval of contact. There is none
/// before it, and y are the control values of Y there. Proof: proofs/filters/Subdivision.v,
/// subdivision_separate, subdivision_collides; of `found`, proofs/times/ContactPart.v, part_found,
/// first_part_right, first_root_in_part.
template <std::size_t Constraints, int YDegree, int GDegree, class Found>
constexpr outcome subdivide_forms(const part_forms<double, Constraints, YDegree, GDegree>& forms,
                                  const form_errors<double>& errors, Found* found,
                                  std::size_t deepest = max_depth) {
    waiting_parts<part_forms<double, Constraints, YDegree, GDegree>> waiting;
    waiting.parts[waiting.size++] = {forms, 0, 0};
    while (waiting.size > 0) {
        auto& part = waiting.parts[waiting.size - 1];
        const auto& [y, g] = part.forms;
        bool excluded = above(y, errors.y) || below(y, errors.y);
        bool collides = changes_sign(y, errors.y);
        for (std::size_t i = 0; i < Constraints && !excluded; ++i) {
            excluded = below(g[i], errors.g);
            collides = collides && above(g[i], errors.g);
        }
        if (excluded) {
            --waiting.size;
            continue;
        }
        if (collides) {
            if (found != nullptr) {
                const double length = 1.0 / static_cast<double>(std::size_t{1} << part.depth);
                const double low = static_cast<double>(part.index) * length;
                found->set(low, low + length, y, errors.y);
            }
            return outcome::collides;
        }
        if (part.depth == deepest || (part.depth >= patient_depth && within_error(y, errors.y)))
            return outcome::uncertain;
        auto& next = waiting.parts[waiting.size++];
        const auto [left, right] = errbound::roots::halves(y);
        part.forms.y = right, next.forms.y = left;
        for (std::size_t i = 0; i < Constraints; ++i) {
            const auto [g_left, g_right] = errbound::roots::halves(g[i]);
            part.forms.g[i] = g_right, next.forms.g[i] = g_left;
        }
        next.depth = ++part.depth;
        next.index = 2 * part.index;
        part.index = next.index + 1;
    }
    return outcome::separate;
}

template <template <class> class Forms>
constexpr outcome subdivide(const whole_step<double, Forms>& whole,
                            contact_interval* found = nullptr, std::size_t deepest = max_depth) {
    return subdivide_forms(whole.forms, whole.errors, found, deepest);
}

}  // namespace ccd::static_filter
