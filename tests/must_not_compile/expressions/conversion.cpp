// A number that is taken out of the expression.
#include <errbound/predicate.hpp>

constexpr auto predicate = errbound::predicate<errbound::points<0, 0>>(
    [](const auto& x, const auto& y) { return y - static_cast<int>(x); });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
