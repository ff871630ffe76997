// Two points for a predicate of three.
#include <errbound/predicates.hpp>

int main() {
    const double p[2]{};
    return errbound::orient2d(p, p) == errbound::sign_type::zero;
}
