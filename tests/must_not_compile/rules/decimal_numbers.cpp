// Rules are for binary numbers.
#include <boost/multiprecision/cpp_dec_float.hpp>
#include <errbound/tracked.hpp>

int main() {
    const errbound::tracked<boost::multiprecision::cpp_dec_float_50> a = 2;
    return (a + a).value() > 0;
}
