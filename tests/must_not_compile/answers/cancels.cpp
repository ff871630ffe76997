// The second product is the first: the difference is zero for all points.
#include <errbound/predicate.hpp>

const double a[2]{}, b[2]{};

constexpr auto predicate = errbound::predicate<errbound::points<2, 2>>(
    [](const auto& a, const auto& b) { return a[0] * b[1] - b[1] * a[0]; });

int main() {
    return predicate(a, b) == errbound::sign_type::zero;
}
