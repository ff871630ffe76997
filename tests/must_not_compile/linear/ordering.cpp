// Eigen's pivots go by value, but tracked numbers still have no operator<.
#include <errbound/eigen.hpp>

int main() {
    const errbound::tracked<double> a = 1.0, b = 3.0;
    return a < b;
}
