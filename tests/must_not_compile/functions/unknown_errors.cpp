// A function of which it is not known how far it is off, as on Windows: the message must say so.
#include <errbound/elementary.hpp>

template <>
inline constexpr double errbound::function_error<errbound::elementary_function::sin, double> = 0;

double f(double x) {
    return sin(errbound::tracked<double>(x)).error();
}
