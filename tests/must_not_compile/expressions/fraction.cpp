// 0.5 is no whole number; as an int it would be 0.
#include <errbound/predicate.hpp>

constexpr auto half = errbound::predicate<errbound::points<0, 0>>(
    [](const auto& x, const auto& y) { return 0.5 * x - y; });

int main() {
    return half(1.0, 2.0) == errbound::sign_type::zero;
}
