// The answer to a query: one value, no out-parameters.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

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
    undecided,    ///< nothing has decided the query yet
};

/// As tables and files write them; "unknown" for any other value.
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

/// `cause` is `none` exactly if `outcome` is certain. By default nothing is decided.
struct verdict {
    ccd::outcome outcome = ccd::outcome::uncertain;
    ccd::cause cause = ccd::cause::undecided;

    friend constexpr bool operator==(const verdict&, const verdict&) = default;
};

/// What a conservative caller reports: true unless the features are certainly separate.
constexpr bool may_collide(verdict v) {
    return v.outcome != outcome::separate;
}

}  // namespace ccd
