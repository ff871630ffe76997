// Neither are they compared for equality.
#include <errbound/predicate.hpp>

constexpr auto predicate = errbound::predicate<errbound::points<0, 0>>(
    [](const auto& x, const auto& y) { return x == y ? errbound::sign_type::zero : sign_of(x); });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
