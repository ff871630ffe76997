// Compiled with -ffast-math: the headers must refuse.
#include <errbound/tracked.hpp>

int main() {
    return 0;
}
