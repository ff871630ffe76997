// Makes an expression that shows a violation smaller, as long as it still shows one. Internal.
#pragma once

#include <errbound/validation/expression.hpp>
#include <functional>
#include <optional>

namespace errbound::validation {

/// Which value of the expression violates a promise, if one does.
using violation_search = std::function<std::optional<std::size_t>(const expression&)>;

/// The smallest that dropping operations, replacing them by their results and simplifying operands
/// finds; its last value violates. Precondition: e has a violation.
expression minimised(const expression& e, number_type type, const violation_search& search);

}  // namespace errbound::validation
