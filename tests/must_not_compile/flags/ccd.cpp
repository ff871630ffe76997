// Compiled with -ffast-math: the headers of collision detection must refuse too.
#include <ccd/method.hpp>

int main() {
    return 0;
}
