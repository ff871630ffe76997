#include <errbound/elementary.hpp>

// As it is on Windows.
template <>
inline constexpr double errbound::function_error<errbound::elementary_function::sin, double> = 0;

double f(double x) {
    return sin(errbound::tracked<double>(x)).error();
}
