// Predicates have no division.
#include <errbound/predicate.hpp>

constexpr auto slope = errbound::predicate<errbound::points<2, 2>>(
    [](const auto& a, const auto& b) { return (b[1] - a[1]) / (b[0] - a[0]); });

int main() {
    const double a[2]{}, b[2]{};
    return slope(a, b) == errbound::sign_type::zero;
}
