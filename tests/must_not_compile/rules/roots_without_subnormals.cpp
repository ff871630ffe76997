// The square root's bound needs gradual underflow.
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <errbound/functions.hpp>

int main() {
    const errbound::tracked<boost::multiprecision::cpp_bin_float_50> a = 2;
    return sqrt(a).value() > 0;
}
