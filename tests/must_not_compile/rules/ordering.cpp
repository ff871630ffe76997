// A tracked number has no operator<: it would have to guess.
#include <errbound/tracked.hpp>

int main() {
    const errbound::tracked<double> a = 1.0, b = 3.0;
    return a < b;
}
