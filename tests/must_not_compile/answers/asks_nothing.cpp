// A sign that no number was asked for.
#include <errbound/predicate.hpp>

constexpr auto predicate =
    errbound::predicate<errbound::points<0, 0>>([](const auto& x, const auto& y) {
        (void)(x - y);
        return errbound::sign_type::positive;
    });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
