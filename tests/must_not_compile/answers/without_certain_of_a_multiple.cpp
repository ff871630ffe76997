// An uncertain sign of a large multiple takes a branch: the line with certain is missing.
#include <errbound/predicate.hpp>

constexpr auto predicate =
    errbound::predicate<errbound::points<0, 0, 0>>([](const auto& x, const auto& y, const auto& z) {
        using errbound::sign_type;
        const sign_type s = sign_of(2147483647 * (x * y - z * z));
        return s == sign_type::positive ? sign_of(x - z) : sign_of(z - y);
    });

int main() {
    return predicate(1.0, 2.0, 3.0) == errbound::sign_type::zero;
}
