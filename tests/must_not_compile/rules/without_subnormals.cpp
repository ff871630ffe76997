// Boost's binary floats have no subnormal numbers: of the rules only `tight` counts sums that
// underflow.
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <errbound/tracked.hpp>

int main() {
    using number = boost::multiprecision::cpp_bin_float_50;
    const errbound::tracked<number, errbound::sharp> a = number(1);
    return (a + a).value() > 0;
}
