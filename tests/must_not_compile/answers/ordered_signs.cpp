// An uncertain sign that is compared by < is the largest of all.
#include <errbound/predicate.hpp>

constexpr auto predicate =
    errbound::predicate<errbound::points<0, 0>>([](const auto& x, const auto& y) {
        if (sign_of(x - y) > errbound::sign_type::zero) return sign_of(x);
        return errbound::sign_type::negative;
    });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
