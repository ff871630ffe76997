// Roots decided in an integer type that overflows.
#include <errbound/polynomial.hpp>

int main() {
    return errbound::count_roots<int>(errbound::polynomial{-2.0, 0.0, 1.0}, 0, 2) == 1;
}
