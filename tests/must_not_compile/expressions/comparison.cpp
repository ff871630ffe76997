// Numbers are not compared but by the sign of their difference.
#include <errbound/predicate.hpp>

constexpr auto predicate = errbound::predicate<errbound::points<0, 0>>(
    [](const auto& x, const auto& y) { return x < y ? sign_of(x) : sign_of(y); });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
