// A constant of type std::size_t.
#include <errbound/predicate.hpp>

constexpr auto predicate = errbound::predicate<errbound::points<0, 0>>(
    [](const auto& x, const auto& y) { return std::size_t(2) * x - y; });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
