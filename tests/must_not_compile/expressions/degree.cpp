// x to the 64th power.
#include <errbound/predicate.hpp>

constexpr auto predicate = errbound::predicate<errbound::points<0>>([](const auto& x) {
    const auto x4 = x * x * x * x, x16 = x4 * x4 * x4 * x4;
    return x16 * x16 * x16 * x16 - 1;
});

int main() {
    return predicate(1.0) == errbound::sign_type::zero;
}
