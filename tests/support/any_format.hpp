// Numbers of any type to try, those of 8 and 16 bits among them, and their exact values.
#pragma once

#include <concepts>
#include <errbound/small_floats.hpp>
#include <random>

#include "tests/support/special_values.hpp"

template <class T>
rational exactly_of(T x) {
    if constexpr (std::floating_point<T>)
        return exactly(x);
    else
        return exactly(static_cast<double>(x));
}

/// Of small formats any code, infinities and NaN too.
template <class T>
T any_number(std::mt19937_64& random) {
    if constexpr (std::floating_point<T>)
        return special_value<T>(random);
    else
        return T::from_code(static_cast<int>(random() % static_cast<unsigned>(T::codes)));
}
