// Comparison of one value with its reference. Internal.
#pragma once

#include <errbound/validation/ball.hpp>
#include <errbound/validation/distribution.hpp>
#include <errbound/validation/expression.hpp>
#include <string>
#include <string_view>

namespace errbound::validation {

enum class finding {
    holds,
    bound_broken,  ///< |value − exact value| > error()
    sign_wrong,    ///< a certain sign that is not the exact one
    baseless,      ///< a certain sign, or a finite bound, without a finite value
    undetermined,  ///< the enclosure is too wide
};

constexpr bool is_violation(finding f) {
    return f != finding::holds && f != finding::undetermined;
}

/// Compares a claim with x; `off` must be the claim's deviation from x wherever both are finite.
inline finding compare(const claim& c, const ball& x, const deviation& off) {
    if (!certain(c.sign) && !c.error.is_finite()) return finding::holds;  // no claim
    if (!c.value.is_finite() || !x.is_defined()) return finding::baseless;
    if (x.is_unknown()) return finding::undetermined;
    if (certain(c.sign)) {
        const sign_type exact = x.sign();
        if (!certain(exact)) return finding::undetermined;
        if (exact != c.sign) return finding::sign_wrong;
    }
    if (!c.error.is_finite()) return finding::holds;
    if (c.error.leading < 0) return finding::bound_broken;
    switch (off.at_most(c.error)) {
        case judgement::holds:
            return finding::holds;
        case judgement::violated:
            return finding::bound_broken;
        default:
            return finding::undetermined;
    }
}

/// The measure for a rule: "bound/error", "estimate/error" or "error/value".
std::string_view measure_of(error_meaning meaning);
/// Adds the log10 of the measure. `off` is the same as for compare.
void add_ratio(distribution& to, error_meaning meaning, const claim& c, const ball& x,
               const deviation& off);

/// A sentence about the violation. Precondition: is_violation(f).
std::string sentence(finding f, const claim& c, const ball& x, const deviation& off);

}  // namespace errbound::validation
