// It asks again until it is certain.
#include <errbound/predicate.hpp>

constexpr auto predicate =
    errbound::predicate<errbound::points<0, 0>>([](const auto& x, const auto& y) {
        errbound::sign_type s = sign_of(x - y);
        while (!certain(s)) s = sign_of(x - y);
        return s;
    });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
