// Points of two coordinates where three are asked for.
#include <errbound/predicates.hpp>

struct point {
    double x, y;
};

int main() {
    const point p{};
    return errbound::orient3d(p, p, p, p) == errbound::sign_type::zero;
}
