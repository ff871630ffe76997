// Roots of doubles, without the integer type to decide in.
#include <errbound/polynomial.hpp>

int main() {
    return errbound::count_roots(errbound::polynomial{-2.0, 0.0, 1.0}, 0, 2) == 1;
}
