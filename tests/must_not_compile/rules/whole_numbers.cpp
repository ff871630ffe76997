// Whole numbers have no rounding error to track.
#include <errbound/tracked.hpp>

int main() {
    const errbound::tracked<int> x = 1;
    return x.value();
}
