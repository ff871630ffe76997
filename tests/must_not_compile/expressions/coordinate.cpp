// An expression that asks for a third coordinate of points that have two.
#include <errbound/predicate.hpp>

constexpr auto above = errbound::predicate<errbound::points<2, 2>>(
    [](const auto& a, const auto& b) { return b[2] - a[2]; });

int main() {
    const double a[3]{}, b[3]{};
    return above(a, b) == errbound::sign_type::zero;
}
