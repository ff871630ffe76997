// An expression of two arguments where the shape has three points.
#include <errbound/predicate.hpp>

constexpr auto predicate = errbound::predicate<errbound::points<0, 0, 0>>(
    [](const auto& x, const auto& y) { return x - y; });

int main() {
    return predicate(1.0, 2.0, 3.0) == errbound::sign_type::zero;
}
