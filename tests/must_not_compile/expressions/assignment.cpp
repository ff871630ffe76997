// A sum that grows: every result has a type of its own.
#include <errbound/predicate.hpp>

constexpr auto predicate =
    errbound::predicate<errbound::points<0, 0>>([](const auto& x, const auto& y) {
        auto sum = x * x;
        sum += y * y;
        return sum;
    });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
