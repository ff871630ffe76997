// Answers to a query: a verdict, or a first time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace ccd {

/// `separate` is certain if the method never loses a collision. `collides` is certain for every
/// method except `float` and `provot` (ccd/method.hpp).
enum class outcome : std::uint8_t {
    separate,   ///< no contact in the closed step
    collides,   ///< a contact
    uncertain,  ///< not decided by the method's arithmetic; conservative callers count a contact
};

/// The reason why an outcome is uncertain.
enum class cause : std::uint8_t {
    none,         ///< the outcome is not `uncertain`
    coplanarity,  ///< whether, or how often, the four points become coplanar
    inside,       ///< whether the contact lies inside both features at that time
    range,        ///< a value overflowed, or an input is not finite
    undecided,    ///< no method has run yet
};

/// The names in tables and files; "unknown" for any other value.
constexpr std::string_view name(outcome o) {
    constexpr std::array<std::string_view, 3> names{"separate", "collides", "uncertain"};
    const auto i = static_cast<std::size_t>(o);
    return i < names.size() ? names[i] : "unknown";
}
constexpr std::string_view name(cause c) {
    constexpr std::array<std::string_view, 5> names{"none", "coplanarity", "inside", "range",
                                                    "undecided"};
    const auto i = static_cast<std::size_t>(c);
    return i < names.size() ? names[i] : "unknown";
}

/// `cause` is `none` exactly if `outcome` is not `uncertain`.
struct verdict {
    ccd::outcome outcome = ccd::outcome::uncertain;
    ccd::cause cause = ccd::cause::undecided;

    friend constexpr bool operator==(const verdict&, const verdict&) = default;
};

/// True unless the features are certainly separate.
constexpr bool may_collide(verdict v) {
    return v.outcome != outcome::separate;
}

/// The first time in [0, t_max] of contact, or within a distance.
struct first_time {
    /// `separate`: there is none. `uncertain`: a coordinate, t_max or a part of the distance is not
    /// finite; a part of it is negative; or a curve has no control point or invalid weights.
    ccd::outcome outcome = ccd::outcome::uncertain;
    /// The first time if low == high; else the adjacent doubles around it. There is no contact in
    /// [0, low), nor at `low` if low < high.
    double low = 0, high = 0;

    /// True if the features touch at t = 0. (Times below the least positive double have high > 0.)
    constexpr bool at_start() const { return outcome == ccd::outcome::collides && high == 0; }

    friend constexpr bool operator==(const first_time&, const first_time&) = default;
};

}  // namespace ccd
