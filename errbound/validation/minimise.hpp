// Smaller expressions with a violation. Internal.
#pragma once

#include <errbound/validation/expression.hpp>
#include <functional>
#include <optional>

namespace errbound::validation {

/// The index of a violating value, if any.
using violation_search = std::function<std::optional<std::size_t>(const expression&)>;

/// The smallest expression found by dropping operations, replacing them by their results and
/// simplifying operands; its last value violates. Precondition: e has a violation.
expression minimised(const expression& e, number_type type, const violation_search& search);

}  // namespace errbound::validation
