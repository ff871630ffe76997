// Errors of elementary functions on platforms where the library does not know them. For tests that
// only compare bounds with each other, so any errors suffice.
#pragma once

#include <errbound/functions/function_error.hpp>

#ifdef _WIN32
template <errbound::elementary_function F>
inline constexpr double errbound::function_error<F, double> = 3;
template <errbound::elementary_function F>
inline constexpr double errbound::function_error<F, float> = 3;
#endif
#ifndef __GLIBC__
template <errbound::elementary_function F>
inline constexpr double errbound::function_error<F, long double> = 3;
#endif
