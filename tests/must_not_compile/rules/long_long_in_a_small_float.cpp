// A whole number of 64 bits would be rounded twice, by way of double.
#include <errbound/small_floats.hpp>

int main() {
    const errbound::float16 x(1LL << 60);
    return x > 0;
}
