// A degenerate case is no uncertain one.
#include <errbound/predicate.hpp>

constexpr auto predicate =
    errbound::predicate<errbound::points<0, 0>>([](const auto& x, const auto& y) {
        using errbound::sign_type;
        const sign_type s = sign_of(x - y);
        return s == sign_type::zero ? sign_type::uncertain : s;
    });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
