// MinGW-w64's fma of long doubles rounds twice, whatever the processor has.
#include <errbound/functions.hpp>

long double f(long double x) {
    const errbound::tracked<long double> y = x;
    return fma(y, y, y).error();
}
