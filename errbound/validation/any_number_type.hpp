// All number types of validation. Internal.
#pragma once

#include <errbound/validation/boost_numbers.hpp>

namespace errbound::validation {

/// Calls f.operator()<T>() for the type. Precondition: it is among number_types.
template <class F>
decltype(auto) with_any_number_type(number_type type, const F& f) {
    return is_boost(type) ? with_boost_number_type(type, f) : with_number_type(type, f);
}

}  // namespace errbound::validation
