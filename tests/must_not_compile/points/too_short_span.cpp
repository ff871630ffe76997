// A span of two numbers as a point of three.
#include <errbound/predicates.hpp>
#include <span>

int main() {
    const double x[2]{};
    const std::span<const double, 2> p(x);
    return errbound::orient3d(p, p, p, p) == errbound::sign_type::zero;
}
