// Coordinates of type int.
#include <errbound/predicates.hpp>

int main() {
    const int p[2]{};
    return errbound::orient2d(p, p, p) == errbound::sign_type::zero;
}
