// The answer to a query: one value, no out-parameters.
#pragma once

#include <cstdint>

namespace ccd {

enum class outcome : std::uint8_t {
    separate,   ///< certainly no contact in the closed step
    collides,   ///< certainly a contact
    uncertain,  ///< the method's arithmetic could not tell; conservative callers count it as
                ///< contact
};

/// Why an outcome is uncertain.
enum class cause : std::uint8_t {
    none,         ///< the outcome is certain
    coplanarity,  ///< whether, or how often, the four points become coplanar
    inside,       ///< whether the contact lies inside both features at that time
    range,        ///< a value overflowed, or an input is not finite
};

struct verdict {
    ccd::outcome outcome = ccd::outcome::uncertain;
    ccd::cause cause = ccd::cause::none;

    friend constexpr bool operator==(const verdict&, const verdict&) = default;
};

/// What a conservative caller reports: true unless the features are certainly separate.
constexpr bool may_collide(verdict v) {
    return v.outcome != outcome::separate;
}

}  // namespace ccd
