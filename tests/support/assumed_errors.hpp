// For tests that compare bounds with bounds, of any elementary functions: how far these are off
// where the library does not know.
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
