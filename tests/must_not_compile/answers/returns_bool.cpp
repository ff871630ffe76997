// An answer of type bool cannot say that it is uncertain.
#include <errbound/predicate.hpp>

constexpr auto predicate = errbound::predicate<errbound::points<0, 0>>(
    [](const auto& x, const auto& y) { return sign_of(x - y) == errbound::sign_type::positive; });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
